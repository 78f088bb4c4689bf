"""Functions from arrays, text, meshes and neuroimaging files."""

from __future__ import annotations

import numpy as np
import pytest

from beltrami.errors import FileFormatError, UnknownNameError
from beltrami.io.function import read_function
from beltrami.io.registry import write_mesh
from beltrami.mesh.mesh import Mesh


def test_arrays(tmp_path):
    for f in (np.arange(5), np.ones((4, 2), np.float32)):
        np.save(tmp_path / "f.npy", f)
        assert np.array_equal(read_function(tmp_path / "f.npy"), f)
        assert read_function(tmp_path / "f.npy").dtype == np.float64


def test_refused_arrays(tmp_path, put):
    for f in (np.array([1.0, np.nan]), np.zeros((2, 2, 2)), np.array(["a"]), np.zeros(0)):
        np.save(tmp_path / "f.npy", f)
        with pytest.raises(FileFormatError):
            read_function(tmp_path / "f.npy")
    np.save(tmp_path / "f.npy", np.array([{}], dtype=object))
    with pytest.raises(FileFormatError, match="npy"):
        read_function(tmp_path / "f.npy")
    for content in (b"", b"no", (tmp_path / "f.npy").read_bytes()[:60]):
        with pytest.raises(FileFormatError):
            read_function(put("g.npy", content))


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("f.txt", "1\n2.5\n# c\n\n-3 # c\n", [1, 2.5, -3]),
        ("f.csv", "1,2\n3,4", [[1, 2], [3, 4]]),
        ("f.tsv", "a\tb\n1\t2\r\n3\t4\r\n", [[1, 2], [3, 4]]),
        ("f.dat", "1; 2\n3; 4\n", [[1, 2], [3, 4]]),
    ],
)
def test_text(put, name, text, expected):
    assert read_function(put(name, text)).tolist() == expected


def test_columns_by_name(put):
    path = put("f.csv", 'u,"v"\n1,2\n3,4\n')
    assert read_function(path, "v").tolist() == [2, 4]
    with pytest.raises(UnknownNameError, match="'u', 'v'"):
        read_function(path, "w")


@pytest.mark.parametrize(
    ("text", "line"),
    [("1\nx\n", 2), ("1 2\n\n3\n", 3), ("1\nnan\n", 2), ("a b\n1\n", 2), ("a\n", None)],
)
def test_faults_of_text(put, text, line):
    with pytest.raises(FileFormatError) as caught:
        read_function(put("f.txt", text))
    assert caught.value.line == line


def test_vertex_data(tmp_path):
    quality = np.array([0.5, 1.5, 2.5])
    mesh = Mesh(np.eye(3), [[0, 1, 2]], {"quality": quality})
    write_mesh(tmp_path / "a.ply", mesh)
    assert read_function(tmp_path / "a.ply").tolist() == quality.tolist()
    assert read_function(tmp_path / "a.ply", name="quality").tolist() == quality.tolist()
    with pytest.raises(UnknownNameError, match="'quality'"):
        read_function(tmp_path / "a.ply", name="quantity")
    write_mesh(tmp_path / "b.ply", Mesh(np.eye(3), [[0, 1, 2]], {"a": quality, "b": quality}))
    with pytest.raises(UnknownNameError, match="no vertex data was named: choose one of 'a', 'b'"):
        read_function(tmp_path / "b.ply")


def test_a_mesh_without_data(tmp_path):
    write_mesh(tmp_path / "bare.ply", Mesh(np.eye(3), [[0, 1, 2]]))
    with pytest.raises(FileFormatError, match="expected data on the vertices"):
        read_function(tmp_path / "bare.ply")


def test_gifti_and_freesurfer(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    f = np.arange(6, dtype=np.float32)
    array = nibabel.gifti.GiftiDataArray(f, intent="NIFTI_INTENT_SHAPE")
    nibabel.save(nibabel.gifti.GiftiImage(darrays=[array]), tmp_path / "a.shape.gii")
    assert read_function(tmp_path / "a.shape.gii").tolist() == f.tolist()
    nibabel.freesurfer.write_morph_data(tmp_path / "lh.thickness", f)
    assert read_function(tmp_path / "lh.thickness").tolist() == f.tolist()
    nibabel.save(nibabel.MGHImage(f.reshape(6, 1, 1), np.eye(4)), tmp_path / "a.mgh")
    assert read_function(tmp_path / "a.mgh").tolist() == f.tolist()
    nibabel.save(
        nibabel.MGHImage(np.stack([f, f]).T.reshape(6, 1, 1, 2), np.eye(4)), tmp_path / "a.mgz"
    )
    assert read_function(tmp_path / "a.mgz").tolist() == np.stack([f, f], axis=1).tolist()


def test_missing_and_unknown(tmp_path, put):
    with pytest.raises(FileNotFoundError):
        read_function(tmp_path / "no.npy")
    (tmp_path / "d.npy").mkdir()
    with pytest.raises(FileFormatError, match="directory"):
        read_function(tmp_path / "d.npy")
    with pytest.raises(UnknownNameError):
        read_function(put("f.xyz", "1"))
