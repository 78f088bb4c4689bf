"""Points without faces: read as such, and pointed to where a mesh is expected."""

import gzip

import numpy as np
import pytest

from beltrami.errors import FileFormatError, UnknownNameError
from beltrami.io.points import read_points
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.shapes import icosphere

POINTS = [[0.0, 0.0, 0.0], [1.0, -2.5, 0.0], [0.0, 1.0, 1e-3]]
ROWS = ["0 0 0", "1 -2.5 0", "0 1 1e-3"]
HEAD = "ply\nformat ascii 1.0\nelement vertex 3\n" + "".join(
    f"property float {axis}\n" for axis in "xyz"
)
FILES = {
    "a.obj": "# scanned\n" + "".join(f"v {row}\n" for row in ROWS),
    "a.off": "OFF\n3 0 0\n" + "\n".join(ROWS),
    "a.ply": HEAD + "end_header\n" + "\n".join(ROWS) + "\n",
    "a.xyz": "\n".join(ROWS),
}


@pytest.mark.parametrize("name", FILES)
def test_points_are_read_and_read_mesh_says_how(put, name):
    path = put(name, FILES[name])
    found = read_points(path)
    np.testing.assert_allclose(found, POINTS, rtol=1e-7)  # floats of 32 bits in PLY
    assert found.flags.writeable
    with pytest.raises(FileFormatError, match=r"PointCloud\(read_points\(path\)\)") as caught:
        read_mesh(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("suffix", ["ply", "obj", "off"])
def test_those_of_a_mesh(tmp_path, suffix):
    ball = icosphere(1)
    coloured = ball.with_data(color=np.zeros((ball.n_vertices, 3)), normal=ball.vertices)
    path = tmp_path / f"a.{suffix}"
    write_mesh(path, coloured)
    np.testing.assert_array_equal(read_points(path), ball.vertices)


def test_tables_with_names_colours_and_gzip(put, tmp_path):
    path = put("a.csv", "x,y,z,red\n1,2,3,255\n4,5,6,0\n")
    found = read_points(path)
    assert found.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert found.base is None  # the other columns are not held
    (tmp_path / "a.xyz.gz").write_bytes(gzip.compress(FILES["a.xyz"].encode()))
    assert read_points(tmp_path / "a.xyz.gz").tolist() == POINTS


@pytest.mark.parametrize(
    ("name", "content", "word"),
    [
        ("a.xyz", "1 2\n3 4\n", "three numbers or more"),
        ("a.xyz", "1\n2\n", "three numbers or more"),
        ("a.xyz", "1 2 3\n4 5 nan\n", "line 2"),
        ("a.xyz", "", "rows of numbers"),
        ("a.obj", "# nothing\n", "expected vertices"),
        ("a.obj", "v 1 2 inf\n", "finite"),
        ("a.off", "OFF\n0 0 0\n", "expected vertices"),
        ("a.off", "OFF\n999 0 0\n0 0 0\n", "cut off"),
        ("a.ply", HEAD.replace("vertex 3", "vertex 0") + "end_header\n", "expected vertices"),
        ("a.ply", HEAD + "end_header\n0 0 0\n0 0 0\n0 0 x    \n", "a number"),
    ],
)
def test_faults(put, name, content, word):
    with pytest.raises(FileFormatError, match=word):
        read_points(put(name, content))


def test_unknown_formats(put):
    with pytest.raises(UnknownNameError, match="xyz"):
        read_points(put("a.stl", "solid"))
    with pytest.raises(FileNotFoundError):
        read_points("not there.xyz")
