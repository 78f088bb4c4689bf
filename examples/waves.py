"""Figure 3.6: waves on meshes that begin with positive and negative Gaussians.

python examples/waves.py FOLDER
"""

import sys
from pathlib import Path

import numpy as np

import beltrami as bt

TIMES = (0.0, 0.1, 0.2, 0.4)  # beside the root of the area


def swing(mesh, vertices, heights):
    """Return the frames, and how far the conserved energy strays from its mean.

    Chapter items: F3.6.
    """
    pair = bt.laplacian(mesh)
    unit = mesh.area**0.5
    f = bt.gaussian_bumps(mesh, vertices, 0.05 * unit, heights, balance=pair)
    step = 0.01 * unit
    frames, energies, before = [], [], f
    chosen = np.round(np.array(TIMES) * unit / step).astype(int)
    times = step * np.arange(chosen[-1] + 1)
    for k, (_, frame) in enumerate(bt.wave(pair, f, None, times, "implicit", step=step)):
        middle, speed = (frame + before) / 2, (frame - before) / step
        if k:
            energies.append(pair.norm(speed) ** 2 + pair.dirichlet_energy(middle))
        if k in chosen:
            frames.append(frame)
        before = frame
    return frames, np.ptp(energies) / np.mean(energies)


def corners(mesh, directions):
    """Return the vertices that lie farthest along some directions."""
    return [int((mesh.vertices @ np.array(direction)).argmax()) for direction in directions]


def draw(mesh, frames, path, **view):
    """Draw the frames side by side, each with its own colours, symmetric around zero."""
    names = [f"t = {time * mesh.area**0.5:.2f}" for time in TIMES]
    return bt.render(
        mesh, frames, path, caption=names, colormap="diverging",
        level_set=None, colorbar=False, **({"size": (320, 260)} | view),
    )  # fmt: skip


def main(folder):
    """Draw the waves of a sphere and of a creature; return how well energies are kept."""
    place = Path(folder)
    sphere, creature = bt.shapes.icosphere(5), bt.shapes.blob(12_000)
    strays = []
    beside = {
        "up": "z", "view": (25, 20), "zoom": 1.85, "focus": (-0.06, -0.05, 0.06), "size": (460, 245)
    }  # fmt: skip
    for name, mesh, directions, view in (
        ("sphere", sphere, [(0.3, 0.4, 1), (0.8, -0.2, 0.5)], {}),
        ("creature", creature, [(-1, 0, 0), (0.2, 0, 1)], beside),
    ):
        frames, stray = swing(mesh, corners(mesh, directions), [1, -1])
        draw(mesh, frames, place / f"wave_{name}.png", **view)
        strays.append(stray)
    return strays


if __name__ == "__main__":
    print("energy strays by", *(f"{stray:.1e}" for stray in main(sys.argv[1])))
