"""A mesh with all that a file can hold, and files made of text."""

from __future__ import annotations

import numpy as np
import pytest

from beltrami.mesh.mesh import Mesh


@pytest.fixture
def put(tmp_path):
    """Write text or bytes into a file, and return its path."""

    def write(name, content):
        path = tmp_path / name
        path.write_bytes(content.encode("latin-1") if isinstance(content, str) else content)
        return path

    return write


@pytest.fixture
def scattered():
    """40 vertices with numbers of all sizes, 70 random faces, data of all types."""
    rng = np.random.default_rng(40_917_263)
    n, m = 40, 70
    vertices = rng.normal(size=(n, 3)) * 10.0 ** rng.integers(-30, 30, (n, 3))
    vertices[0] = [0.1, -0.0, 5e-324]
    faces = rng.permuted(np.tile(np.arange(n), (m, 1)), axis=1)[:, :3]
    data = {
        kind: rng.integers(0, 100, n).astype(kind)
        for kind in ("i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8")
    }
    data["color"] = rng.integers(0, 256, (n, 3)).astype(np.uint8)
    data["normal"] = rng.normal(size=(n, 3))
    data["field"] = rng.normal(size=(n, 5)).astype(np.float32)
    data["single"] = rng.normal(size=(n, 1))
    data["red"] = rng.normal(size=n)
    data["x"] = rng.normal(size=n)
    data["with blank é %"] = rng.normal(size=n)
    data["numbered_0"] = rng.normal(size=n)
    uv = rng.integers(0, 9, (m, 3, 2)) / 7
    return Mesh(vertices, faces, data, uv)
