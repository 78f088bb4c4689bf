"""Facts about a mesh, counted here with numpy only, so that the library does not judge itself."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest

from beltrami.mesh.mesh import Mesh


class Survey(NamedTuple):
    euler: int
    boundary_edges: int
    is_manifold: bool  # at most two faces at an edge, in opposite directions; one fan at a vertex
    components: int
    area: float
    volume: float
    min_angles: np.ndarray


def _survey(mesh: Mesh) -> Survey:
    faces, n = mesh.faces, mesh.n_vertices
    sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    directed = sides[:, 0] * n + sides[:, 1]
    edges, count = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)
    # one fan at v: the link of v (an edge for each face at v) is connected: one path or cycle
    link = np.roll(faces, -1, axis=1).ravel(), np.roll(faces, -2, axis=1).ravel()
    apex = faces.ravel()
    corners, ids = np.unique(
        np.concatenate([apex * n + link[0], apex * n + link[1]]), return_inverse=True
    )
    links = _components(len(corners), np.stack(np.split(ids, 2), axis=1))
    fans = np.unique(np.stack([corners // n, links], axis=1), axis=0)
    p = mesh.vertices[faces]
    if p.shape[2] == 2:
        p = np.concatenate([p, np.zeros_like(p[:, :, :1])], axis=2)
    across = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    angles = []
    for k in range(3):
        u, v = p[:, (k + 1) % 3] - p[:, k], p[:, (k + 2) % 3] - p[:, k]
        norms = np.linalg.norm(u, axis=1) * np.linalg.norm(v, axis=1)
        angles.append(np.degrees(np.arccos(np.clip((u * v).sum(axis=1) / norms, -1, 1))))
    return Survey(
        euler=n - len(edges) + len(faces),
        boundary_edges=int((count == 1).sum()),
        is_manifold=bool(
            (count <= 2).all() and len(np.unique(directed)) == len(directed) and len(fans) == n
        ),
        components=len(np.unique(_components(n, edges))),
        area=float(np.linalg.norm(across, axis=1).sum() / 2),
        volume=float((p[:, 0] * across).sum() / 6),
        min_angles=np.min(angles, axis=0),
    )


def _components(n: int, edges: np.ndarray) -> np.ndarray:
    """Label the nodes of a graph by the least node reachable (pointer jumping)."""
    label = np.arange(n)
    while True:
        least = np.minimum(label[edges[:, 0]], label[edges[:, 1]])
        new = label.copy()
        np.minimum.at(new, label[edges[:, 0]], least)
        np.minimum.at(new, label[edges[:, 1]], least)
        new = new[new]
        if np.array_equal(new, label):
            return label
        label = new


@pytest.fixture(scope="session")
def survey() -> Callable[[Mesh], Survey]:
    return _survey


@pytest.fixture(scope="session")
def rate() -> Callable[[list[float]], float]:
    """The observed order: log2 of the last error ratio, for sizes halved each time."""

    def order(errors: list[float]) -> float:
        assert all(error > 0 for error in errors)
        return float(np.log2(errors[-2] / errors[-1]))

    return order
