"""Figure 3.7: eigenvectors of the Laplacian, with the lines where they are zero.

python examples/eigenfunctions.py FOLDER
"""

import sys
from pathlib import Path

import beltrami as bt

MODES = (1, 2, 3, 5, 10, 20, 50, 100)


def eigenfunctions(mesh, path, **view):
    """Draw some modes; return for each its number and how many regions of one sign it has.

    Chapter items: F3.7.
    """
    basis = bt.fourier_basis(bt.laplacian(mesh), max(MODES) + 1)
    bt.render(
        mesh, [basis.eigenvectors[:, i] for i in MODES], path,
        caption=[f"mode {i}" for i in MODES], columns=4,
        colormap="diverging", colorbar=False, **({"size": (330, 250)} | view),
    )  # fmt: skip
    return {i: bt.nodal_domains(mesh, basis.eigenvectors[:, i]).count for i in MODES}


def main(folder):
    """Draw the modes of a sphere and of a creature; return their regions."""
    place = Path(folder)
    sphere, creature = bt.shapes.icosphere(5), bt.shapes.blob(12_000)
    return (
        eigenfunctions(sphere, place / "modes_sphere.png"),
        eigenfunctions(
            creature,
            place / "modes_creature.png",
            up="z",
            view=(25, 20),
            zoom=1.95,
            focus=(-0.06, -0.05, 0.06),
            size=(400, 200),
        ),
    )


if __name__ == "__main__":
    for found in main(sys.argv[1]):
        print("regions:", *(f"mode {i}: {count};" for i, count in found.items()))
