"""Figures 3.10 and 3.11: maps to the plane, by boundaries and weights; flattenings that fail.

python examples/maps.py FOLDER

Above, the images in the plane, with the distortion in colour: the decimal logarithm of the
symmetric Dirichlet energy, 0 where lengths are kept; its mean is in the captions of figure 3.10.
Below, what a checkerboard in the plane is on the surface.
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

import beltrami as bt

MAPS = {
    "circle, combinatorial": {"method": "tutte", "weights": "combinatorial"},
    "circle, distance": {"method": "tutte", "weights": "distance"},
    "circle, mean value": {"method": "tutte", "weights": "mean_value"},
    "square, cotangent": {"method": "tutte", "weights": "cotangent", "boundary": "square"},
    "square, mean value": {"method": "tutte", "weights": "mean_value", "boundary": "square"},
    "triangle, mean value": {"method": "tutte", "weights": "mean_value", "boundary": 3},
    "circle, relaxed": {},
    "free boundary": {"method": "free"},
}


SIZE = (320, 270)
HEIGHTS = (0.4, 1.5, 3.0)


def sheet(height, center=(0.0, 0.0), rings=14):
    """Make a disk with a bump as high as that."""
    flat = bt.shapes.disk(rings)
    z = height * np.exp(-6 * ((flat.vertices - center) ** 2).sum(axis=1))
    return bt.Mesh(np.column_stack([flat.vertices, z]), flat.faces)


def stretch(psi):
    """Return the logarithm of the energy, in the mean over the faces around each vertex."""
    values = np.log10(psi.distortion.energy.clip(1, 1e9))
    around = psi.mesh.topology.vertex_faces
    return (around @ (psi.distortion.areas * values)) / (around @ psi.distortion.areas)


def draw(maps, names, path, columns, worst):
    """Draw the images of the surface, and below each the surface with a checkerboard."""
    rows = []
    for first in range(0, len(maps), columns):
        some = slice(first, first + columns)
        images = bt.render(
            [psi.flat for psi in maps[some]], [stretch(psi) for psi in maps[some]],
            caption=names[some], limits=(0, worst), level_set=None, wireframe=True, line_width=0.9,
            size=SIZE,
        )  # fmt: skip
        boards = bt.render(
            [psi.textured for psi in maps[some]], texture="checkerboard", size=SIZE,
            up="z", view=(20, 35),
        )  # fmt: skip
        rows += [images, boards]
    Image.fromarray(np.concatenate(rows)).save(path)


def parameterizations(mesh):
    """Return the maps of figure 3.10.

    Chapter items: F3.10.
    """
    return [bt.parameterize(mesh, bulge=bulge_of(options), **options) for options in MAPS.values()]


def bulge_of(options):
    """Bend straight sides a little, so that no edge of the mesh divides one."""
    return 0.02 if "boundary" in options else 0.0


def flattenings():
    """Return those of figure 3.11: a low bump, a higher one, one that is too high.

    Chapter items: F3.11.
    """
    return [bt.flatten(sheet(height, (0.35, 0.15))) for height in HEIGHTS]


def main(folder):
    """Draw both figures; return the numbers of flipped faces."""
    place = Path(folder)
    maps = parameterizations(sheet(2.0))
    names = [
        f"{name}: {psi.distortion.symmetric_dirichlet:.2f}"
        for name, psi in zip(MAPS, maps, strict=True)
    ]
    draw(maps, names, place / "parameterizations.png", 4, 1.2)
    flat = flattenings()
    titles = [
        f"height {height}: {len(psi.flipped)} of {psi.mesh.n_faces} faces flipped"
        for height, psi in zip(HEIGHTS, flat, strict=True)
    ]
    draw(flat, titles, place / "flattenings.png", 3, 2)
    return [len(psi.flipped) for psi in maps], [len(psi.flipped) for psi in flat]


if __name__ == "__main__":
    print("flipped faces:", *main(sys.argv[1]))
