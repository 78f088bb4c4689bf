"""Figures 3.8 and 3.9: spectra of a smooth and a rough function; a mesh of more and more terms.

python examples/approximation.py FOLDER
"""

import sys
from pathlib import Path

import numpy as np

import beltrami as bt

TERMS = (2, 8, 32, 128)
MODES = 150  # of the basis that functions are expanded in


def two_functions(mesh):
    """Return a smooth function, and one that jumps."""
    x, y, z = (mesh.vertices - mesh.vertices.mean(axis=0)).T / mesh.vertices.std()
    return {"smooth": np.exp(0.3 * x + 0.2 * y), "with a jump": np.sign(x + 0.3 * y - 0.5 * z)}


def spectra(mesh, path):
    """Draw figure 3.8; return the errors of few terms, in parts of the function.

    For each function the error of the first 40 terms, and that of the 40 largest.

    Chapter items: F3.8, P66.
    """
    basis = bt.fourier_basis(bt.laplacian(mesh, "combinatorial"), MODES)
    functions = two_functions(mesh)
    bt.plot_spectrum(basis, functions, path)
    errors = {}
    for name, f in functions.items():
        decays = [basis.error_decay(f), basis.error_decay(f, largest=True)]
        errors[name] = [float(decay[40] / decay[0]) for decay in decays]
    return errors


def approximations(mesh, terms=TERMS):
    """Return (files, meshes, errors) of more and more terms of each block, and of all.

    The error is the root mean square distance, in parts of the diagonal of the bounding box.

    Chapter items: F3.9.
    """
    order = bt.vertex_order(mesh)
    files = [bt.compress(mesh, mode="spectral", bits=9, terms=m) for m in terms]
    files.append(bt.compress(mesh, mode="spectral", bits=9))
    meshes = [bt.decompress(data) for data in files]
    away = [np.linalg.norm(found.vertices - mesh.vertices[order], axis=1) for found in meshes]
    diagonal = np.linalg.norm(np.ptp(mesh.vertices, axis=0))
    return files, meshes, [float(np.sqrt((one**2).mean()) / diagonal) for one in away]


def draw_approximations(mesh, files, meshes, errors, path):
    """Draw figure 3.9: the meshes, with the bytes and the errors."""
    names = [f"{m} terms" for m in TERMS] + ["all terms"]
    captions = [
        f"{name}: {len(data)} bytes, error {error:.1e}"
        for name, data, error in zip(names, files, errors, strict=True)
    ]
    return bt.render(
        [mesh, *meshes], None, path, caption=[f"the mesh: {mesh.n_vertices} vertices", *captions],
        up="z", view=(25, 20), zoom=2.05, focus=(-0.06, -0.05, 0.06), camera="common",
        size=(520, 250), columns=3,
    )  # fmt: skip


def main(folder, n_vertices=1900):
    """Draw both figures; return the errors of few terms, the bytes and the errors of the meshes."""
    place, mesh = Path(folder), bt.shapes.blob(n_vertices)
    few = spectra(mesh, place / "spectra.png")
    found = approximations(mesh)
    draw_approximations(mesh, *found, place / "approximations.png")
    return few, [len(data) for data in found[0]], found[2]


if __name__ == "__main__":
    few, sizes, errors = main(sys.argv[1])
    for name, (first, largest) in few.items():
        print(f"{name}: error of the first 40 terms {first:.3f}, of the 40 largest {largest:.3f}")
    print("bytes", *sizes)
    print("errors", *(f"{error:.1e}" for error in errors))
