"""Formats of other packages: round trips and broken files."""

from __future__ import annotations

import gzip

import numpy as np
import pytest

from beltrami.errors import FileFormatError, MissingExtraError, NonFiniteError
from beltrami.io import extras
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.mesh import Mesh

FACES = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
POINTS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0.5]]


@pytest.mark.parametrize("suffix", extras.WRITERS)
def test_round_trip(tmp_path, suffix):
    pytest.importorskip({".vtk": "meshio", ".vtu": "meshio"}.get(suffix, "nibabel"))
    write_mesh(tmp_path / f"a{suffix}", Mesh(POINTS, FACES, {"f": np.arange(4.0)}))
    again = read_mesh(tmp_path / f"a{suffix}")
    assert np.array_equal(again.vertices, POINTS)
    assert again.faces.tolist() == FACES
    if suffix in (".vtk", ".vtu"):
        assert again.vertex_data["f"].tolist() == [0, 1, 2, 3]


def test_compressed_gifti(tmp_path):
    pytest.importorskip("nibabel")
    write_mesh(tmp_path / "a.gii", Mesh(POINTS, FACES))
    (tmp_path / "b.gii.gz").write_bytes(gzip.compress((tmp_path / "a.gii").read_bytes()))
    assert read_mesh(tmp_path / "b.gii.gz").faces.tolist() == FACES
    write_mesh(tmp_path / "c.gii.gz", Mesh(POINTS, FACES))
    assert gzip.decompress((tmp_path / "c.gii.gz").read_bytes()).startswith(b"<?xml")
    assert read_mesh(tmp_path / "c.gii.gz").faces.tolist() == FACES


def test_freesurfer(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    nibabel.freesurfer.write_geometry(tmp_path / "lh.pial", np.array(POINTS), np.array(FACES))
    assert read_mesh(tmp_path / "lh.pial").faces.tolist() == FACES


def test_freesurfer_reads_what_is_written_and_the_bytes_are_the_same_each_time(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    for name in ("lh.sphere.reg", "rh.white"):
        write_mesh(tmp_path / name, Mesh(POINTS, FACES))
        first = (tmp_path / name).read_bytes()
        write_mesh(tmp_path / name, Mesh(POINTS, FACES))
        assert (tmp_path / name).read_bytes() == first
        points, faces = nibabel.freesurfer.read_geometry(tmp_path / name)
        assert np.array_equal(points, POINTS)
        assert faces.tolist() == FACES


@pytest.mark.parametrize("suffix", extras.SINGLE)
def test_coordinates_too_large_for_32_bits_are_refused(tmp_path, suffix):
    with pytest.raises(NonFiniteError, match="32 bits"):
        write_mesh(tmp_path / f"a{suffix}", Mesh(1e200 * np.array(POINTS), FACES))
    assert not list(tmp_path.iterdir())


def test_polygons(tmp_path):
    meshio = pytest.importorskip("meshio")
    points = np.array(POINTS)
    meshio.Mesh(points, [("quad", [[0, 1, 2, 3]]), ("line", [[0, 1]])]).write(tmp_path / "a.vtk")
    assert read_mesh(tmp_path / "a.vtk").faces.tolist() == [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize("suffix", [".gii", ".vtk", ".vtu", ".glb", ".msh", ".pial", ".gii.gz"])
def test_broken_files(put, capfd, suffix):
    for content in (b"", b"no such file at all", b"\x1f\x8b" + b"\0" * 50):
        with pytest.raises(FileFormatError) as error:
            read_mesh(put(f"a{suffix}", content))
        assert str(error.value).count("\n") == 0
    assert capfd.readouterr() == ("", "")  # the packages print nothing


def test_missing_package(put, monkeypatch):
    def absent(package, extra, purpose):
        raise MissingExtraError(package, extra, purpose)

    monkeypatch.setattr(extras, "require", absent)
    with pytest.raises(MissingExtraError, match=r"beltrami\[io\]"):
        read_mesh(put("a.gii", b"x"))
