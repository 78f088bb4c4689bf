"""The picture of the README: a shape, its mean curvature, heat from its tail, and its smoothing.

python examples/readme_picture.py docs/images/blob.png
"""

import sys

import numpy as np

import beltrami as bt


def main(path: str) -> float:
    """Draw the picture; return the part of the volume that smoothing keeps."""
    mesh = bt.shapes.blob(60_000)
    pair = bt.laplacian(mesh)
    bend = np.einsum("nc,nc->n", pair.apply(mesh.vertices), mesh.vertex_normals) / 2
    limit = float(np.quantile(np.abs(bend), 0.9))
    tail = int(mesh.vertices[:, 0].argmin())
    point = np.zeros(mesh.n_vertices)
    point[tail] = 1 / pair.masses[tail]
    heat = np.log10(bt.heat(pair, point, time=0.3).clip(1e-6))
    smooth = bt.smooth_mesh(mesh, "implicit", time=2e-3, steps=4)
    bt.render(
        [mesh, mesh, mesh, smooth],
        [None, bend.clip(-limit, limit), heat - heat.min(), None],
        path,
        caption=["a mesh", "its mean curvature", "heat from the tail, log scale", "smoothed"],
        up="z",
        view=(25, 20),
        size=(620, 300),
        zoom=1.95,
        columns=2,
        level_set=None,
        colorbar=False,
    )
    return smooth.volume / mesh.volume


if __name__ == "__main__":
    print(f"volume kept: {main(sys.argv[1]):.3f}")
