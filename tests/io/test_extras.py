"""Formats of other packages: round trips and broken files."""

from __future__ import annotations

import gzip

import numpy as np
import pytest

from beltrami.errors import FileFormatError, MeshError, MissingExtraError, NonFiniteError
from beltrami.io import extras
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.mesh import Mesh

FACES = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
POINTS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0.5]]


@pytest.mark.parametrize("suffix", extras.WRITERS)
def test_round_trip(tmp_path, suffix):
    pytest.importorskip(
        {".vtk": "meshio", ".vtu": "meshio", ".vtp": "numpy"}.get(suffix, "nibabel")
    )
    write_mesh(tmp_path / f"a{suffix}", Mesh(POINTS, FACES, {"f": np.arange(4.0)}))
    again = read_mesh(tmp_path / f"a{suffix}")
    assert np.array_equal(again.vertices, POINTS)
    assert again.faces.tolist() == FACES
    if suffix in (".vtk", ".vtp", ".vtu"):
        assert again.vertex_data["f"].tolist() == [0, 1, 2, 3]


@pytest.mark.parametrize("suffix", [".vtk", ".vtu"])
@pytest.mark.parametrize("kind", ["?", "u1", "i2", "i8", "u8", "f2", "f4", "f8", "g", ">f4"])
def test_functions_of_every_type_come_back(tmp_path, suffix, kind):
    pytest.importorskip("meshio")
    f = np.array([0, 1, 0, 1.0]).astype(kind)
    write_mesh(tmp_path / f"a{suffix}", Mesh(POINTS, FACES, {"f": f, "F": np.stack([f, f, f], 1)}))
    data = read_mesh(tmp_path / f"a{suffix}").vertex_data
    assert np.array_equal(data["f"], f)
    assert np.array_equal(data["F"], np.stack([f, f, f], 1))


def there_and_back(place, name, values):
    try:
        write_mesh(place, Mesh(POINTS, FACES, {name: values}))
    except MeshError:
        return None
    return read_mesh(place).vertex_data[name].reshape(values.shape)


@pytest.mark.parametrize("suffix", [".vtk", ".vtu"])
def test_what_vtk_would_not_give_back_is_refused(tmp_path, capfd, suffix):
    pytest.importorskip("meshio")
    place = tmp_path / f"a{suffix}"
    for name in ("plain", "a/b", "é", "my f", 'x"y', "a<b", "a&b", "a>b", "a\tb", "", "a\nb"):
        back = there_and_back(place, name, np.arange(4.0))
        assert (back is None and name not in ("plain", "a/b", "é")) or back.tolist() == [0, 1, 2, 3]
    for columns in range(5):
        values = np.arange(4.0 * columns).reshape(4, columns)
        back = there_and_back(place, "F", values)
        if columns == 0 or (columns == 2 and suffix == ".vtk"):
            assert back is None
        else:
            assert np.array_equal(back, values)
    assert capfd.readouterr() == ("", "")


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


@pytest.mark.parametrize(
    "suffix", [".gii", ".vtk", ".vtp", ".vtu", ".glb", ".msh", ".pial", ".gii.gz"]
)
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
