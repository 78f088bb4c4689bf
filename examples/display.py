"""Figure 3.1: a mesh displayed, whole and from so close that its faces are seen.

python examples/display.py FOLDER
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

import beltrami as bt

SIZE = (460, 380)


def front(mesh):
    """Return the middle of the foremost part, to look at closely."""
    x = mesh.vertices
    return x[x[:, 0] >= np.quantile(x[:, 0], 0.93)].mean(axis=0)


def display(mesh, path, **view):
    """Draw the mesh whole, its faces close by, each in one shade, and with light interpolated.

    Chapter items: F3.1.
    """
    near = {"zoom": 5.0, "focus": front(mesh)} | view
    far = {"zoom": 1.15} | view
    panels = [
        bt.render(mesh, size=SIZE, caption="a mesh", **far),
        bt.render(
            mesh, size=SIZE, caption="its faces, one shade each", shading="flat", wireframe=True,
            line_width=1.6, **near,
        ),
        bt.render(mesh, size=SIZE, caption="light interpolated", **near),
    ]  # fmt: skip
    picture = np.concatenate(panels, axis=1)
    Image.fromarray(picture).save(path)
    return picture


def shades(mesh, **view):
    """Return the colours seen in flat and in interpolated light: few, and many."""
    near = {"zoom": 5.0, "focus": front(mesh), "size": SIZE, "antialias": 1} | view
    return [
        len(np.unique(bt.render(mesh, shading=shading, **near).reshape(-1, 3), axis=0))
        for shading in ("flat", "gouraud")
    ]


def main(folder):
    """Draw the figure; return how many shades each way of lighting shows."""
    mesh = bt.shapes.blob(6000)
    display(mesh, Path(folder) / "display.png", up="z", view=(25, 20))
    return shades(mesh, up="z", view=(25, 20))


if __name__ == "__main__":
    print("shades, flat and interpolated:", *main(sys.argv[1]))
