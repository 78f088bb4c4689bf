"""Meshes whose pictures are known."""

from __future__ import annotations

import numpy as np
import pytest

from beltrami.mesh.mesh import Mesh


def _sphere(levels: int) -> Mesh:
    """An octahedron whose faces are cut in four again and again, pushed onto the unit sphere."""
    x = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]], float)
    f = np.array(
        [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    )
    for _ in range(levels):
        corners = x[f]
        middles = (corners + np.roll(corners, -1, axis=1)) / 2
        a, b, c = corners.transpose(1, 0, 2)
        ab, bc, ca = middles.transpose(1, 0, 2)
        pieces = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
        pieces /= np.linalg.norm(pieces, axis=1, keepdims=True)
        x, f = np.unique(pieces.round(12), axis=0, return_inverse=True)
        x, f = x / np.linalg.norm(x, axis=1, keepdims=True), f.reshape(-1, 3)
    return Mesh(x, f)


@pytest.fixture(scope="session")
def sphere() -> Mesh:
    return _sphere(5)


@pytest.fixture(scope="session")
def coarse_sphere() -> Mesh:
    return _sphere(3)


@pytest.fixture(scope="session")
def square() -> Mesh:
    """[-1, 1]², two triangles, in the plane z = 0, facing z > 0."""
    return Mesh([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]])


@pytest.fixture(scope="session")
def chapter() -> dict[str, object]:
    """Options that leave nothing but the light of the chapter on white, one sample a pixel."""
    return {"ambient": 0.0, "fill": 0.0, "color": "white", "background": "black", "antialias": 1}
