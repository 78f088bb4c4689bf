"""Suffixes, directories, compression, what cannot be written."""

from __future__ import annotations

import gzip

import numpy as np
import pytest

from beltrami.errors import (
    DimensionError,
    EmptyMeshError,
    FileFormatError,
    NonFiniteError,
    UnknownNameError,
)
from beltrami.io.registry import READERS, read_mesh, write_mesh
from beltrami.mesh.mesh import Mesh

OFF = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"


def test_suffixes(put):
    assert read_mesh(put("A.OFF", OFF)).n_faces == 1
    assert read_mesh(str(put("a.Off.GZ", gzip.compress(OFF)))).n_faces == 1
    for form in ("off", ".OFF"):
        assert read_mesh(put("a.dat", OFF), format=form).n_faces == 1


def test_unknown_suffixes(put, scattered):
    for name in ("a.offf", "a", "a.gz", ".off"):
        with pytest.raises(UnknownNameError) as caught:
            read_mesh(put(name, OFF))
        assert {".obj", ".off", ".ply", ".stl", ".gii"} <= set(caught.value.choices)
    with pytest.raises(UnknownNameError):
        read_mesh(put("a.off", OFF), format="xyz")
    with pytest.raises(UnknownNameError):
        write_mesh("a.xyz", scattered)


@pytest.mark.parametrize("suffix", [*READERS, ".off.gz", ".gii", ".vtk", ".vtp"])
def test_missing_files_and_directories(tmp_path, suffix):
    with pytest.raises(FileNotFoundError):
        read_mesh(tmp_path / f"no{suffix}")
    folder = tmp_path / f"folder{suffix}"
    folder.mkdir()
    with pytest.raises(FileFormatError, match="directory"):
        read_mesh(folder)


@pytest.mark.parametrize("size", [0, 1, 5, 12, 30])
def test_broken_compression(put, size):
    with pytest.raises(FileFormatError):
        read_mesh(put("a.off.gz", gzip.compress(OFF)[:size]))
    with pytest.raises(FileFormatError, match="gzip"):
        read_mesh(put("b.off.gz", OFF))


@pytest.mark.parametrize("suffix", [*READERS, ".ply.gz", ".obj.gz"])
def test_flat_meshes(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    write_mesh(path, Mesh([[0.5, 0.25], [1, 0], [0, 1]], [[0, 1, 2]]))
    assert read_mesh(path).vertices.tolist() == [[0.5, 0.25, 0], [1, 0, 0], [0, 1, 0]]


def test_what_cannot_be_written(tmp_path, scattered):
    old = tmp_path / "a.ply"
    old.write_bytes(b"old")
    for mesh, error in (
        (Mesh(np.eye(4), [[0, 1, 2]]), DimensionError),
        (Mesh(np.eye(3), np.zeros((0, 3), int)), EmptyMeshError),
        (Mesh(np.full((3, 3), np.nan), [[0, 1, 2]]), NonFiniteError),
    ):
        with pytest.raises(error):
            write_mesh(old, mesh)
    with pytest.raises(UnknownNameError, match="texture coordinates"):
        write_mesh(tmp_path / "a.off", scattered, uv=np.zeros((40, 2)))
    assert old.read_bytes() == b"old"


def test_arrays_cannot_be_changed(put):
    mesh = read_mesh(put("a.off", OFF))
    for array in (mesh.vertices, mesh.faces):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 7
