"""The meshes: subdivision, and what is kept in the folder."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from benchmarks.cases import FOLDER_VARIABLE, Arrays, Case, cases, subdivided

TETRAHEDRON = (
    np.array([[0.0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]]),
    np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]),
)


def normals(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    a, b, c = vertices[faces].transpose(1, 0, 2)
    return np.cross(b - a, c - a)


def test_subdivision_cuts_each_face_into_four_equal_ones() -> None:
    V, F = TETRAHEDRON
    fine, small = subdivided(V, F)
    assert fine.shape == (4 + 6, 3)
    assert small.shape == (16, 3)
    np.testing.assert_array_equal(fine[:4], V)
    np.testing.assert_allclose(normals(fine, small), np.repeat(normals(V, F) / 4, 4, axis=0))


def test_subdivision_is_closed_and_uses_each_midpoint_once() -> None:
    fine, small = subdivided(*TETRAHEDRON)
    assert len(np.unique(fine, axis=0)) == len(fine)
    sides = np.stack([small, np.roll(small, -1, axis=1)], axis=-1).reshape(-1, 2)
    directed = set(map(tuple, sides.tolist()))
    assert len(directed) == len(sides)
    assert all((j, i) in directed for i, j in directed)


def test_mesh_is_made_once_for_all_processes(tmp_path: Path) -> None:
    made = []

    def make() -> Arrays:
        made.append(1)
        return TETRAHEDRON

    for _ in range(2):  # a second Case stands for another process
        case = Case("a mesh", tmp_path, make)
        np.testing.assert_array_equal(case.vertices, TETRAHEDRON[0])
        np.testing.assert_array_equal(case.faces, TETRAHEDRON[1])
        assert case.vertices.flags.writeable
    assert made == [1]


def test_igea_is_there_where_the_folder_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv(FOLDER_VARIABLE, raising=False)
    assert [case.name for case in cases(134_000, tmp_path)] == ["blob 134k"]
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))
    assert [case.name for case in cases(537_000, tmp_path)] == ["blob 537k", "igea 537k"]
    assert [case.name for case in cases(35_000, tmp_path)] == ["blob 35k", "bunny 35k"]
    assert [case.name for case in cases(537_000, tmp_path, quick=True)] == ["blob 10k"]
    assert [case.name for case in cases(0, tmp_path)] == ["no mesh"]
