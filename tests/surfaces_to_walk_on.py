"""Surfaces whose distances are known, or hard: boxes, tubes, mazes."""

from __future__ import annotations

import numpy as np
from scipy.spatial import Delaunay

from beltrami.mesh.mesh import Mesh


def maze(height: float = 0.0) -> Mesh:
    """The unit square with a wall from below and a round hole: paths turn at their corners."""
    rng = np.random.default_rng(3)
    x = rng.uniform(size=(400, 2))
    faces = Delaunay(x).simplices
    middle = x[faces].mean(axis=1)
    wall = (np.abs(middle[:, 0] - 0.5) < 0.05) & (middle[:, 1] < 0.8)
    hole = np.linalg.norm(middle - [0.8, 0.5], axis=1) < 0.1
    used, faces = np.unique(faces[~wall & ~hole], return_inverse=True)
    lifted = np.column_stack([x[used], height * rng.normal(size=len(used))])
    return Mesh(lifted, faces.reshape(-1, 3))


def slit() -> Mesh:
    """The square [-1, 1]² cut along the x-axis from 0 to 1: the path around turns at 0."""
    k = 10
    i, j = np.meshgrid(np.arange(-k, k + 1), np.arange(-k, k + 1))
    x = np.column_stack([i.ravel(), j.ravel()]) / k
    at = ((j + k) * (2 * k + 1) + i + k)[:-1, :-1].ravel()
    n = 2 * k + 1
    faces = np.concatenate(
        [np.stack([at, at + 1, at + n + 1], 1), np.stack([at, at + n + 1, at + n], 1)]
    )
    above = x[faces].mean(axis=1)[:, 1] > 0
    cut = np.flatnonzero((x[:, 1] == 0) & (x[:, 0] > 0))
    copy = np.arange(len(x))
    copy[cut] = len(x) + np.arange(len(cut))
    faces[above] = copy[faces[above]]
    return Mesh(np.concatenate([x, x[cut]]), faces)


def shuffled(mesh: Mesh, seed: int) -> Mesh:
    """The same surface; corners, faces and directions in another order."""
    rng = np.random.default_rng(seed)
    faces = mesh.faces[rng.permutation(mesh.n_faces)]
    faces = np.take_along_axis(faces, (rng.integers(3, size=(len(faces), 1)) + np.arange(3)) % 3, 1)
    turned = rng.random((len(faces), 1)) < 0.5
    return Mesh(mesh.vertices, np.where(turned, faces[:, ::-1], faces))
