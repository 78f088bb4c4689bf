"""OFF: what is read, what is refused and where, round trips."""

from __future__ import annotations

import numpy as np
import pytest

from beltrami.errors import FileFormatError
from beltrami.io import off
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.mesh import Mesh

POINTS = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
SPLIT = [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize(
    "text",
    [
        "OFF\n4 1 0\n" + POINTS + "4 0 1 2 3\n",
        "OFF 4 1 0\n" + POINTS + "4 0 1 2 3",
        "OFF\n4 1\n" + POINTS + "4 0 1 2 3 255 0 0\n\n",
        "# c\n\nOFF # c\n# c\n\n4 1 9 # c\n\n# c\n"
        + POINTS.replace("\n", " # c\n\n")
        + "4 0 1 2 3 # c\n#c",
        "OFF\r\n4 1 0\r\n" + POINTS.replace("\n", "\r\n") + "4 0 1 2 3\r\n",
        "OFF\n4 2 0\n" + POINTS + "3 0 1 2\n3 0 2 3\n",
        "OFF\n4 2 0\n" + POINTS + "3 0 1 2 .5 .5 .5\n3  0 2 3\n",
    ],
)
def test_forms(put, text):
    mesh = read_mesh(put("a.off", text))
    assert mesh.faces.tolist() == SPLIT
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]


def test_triangles_and_polygons_mixed(put):
    text = "OFF\n4 4 0\n" + POINTS + "3 0 1 2\n4 0 1 2 3\n3 1 2 3\n5 0 1 2 3 1\n"
    expected = [[0, 1, 2], *SPLIT, [1, 2, 3], *SPLIT, [0, 3, 1]]
    assert read_mesh(put("a.off", text)).faces.tolist() == expected


def test_normals_and_colours(put):
    rows = "0 0 0 0 0 1 10 20 30 255\n1 0 0 0 1 0 1 2 3 4\n0 1 0 1 0 0 0 0 0 0\n"
    mesh = read_mesh(put("a.off", "CNOFF\n3 1 0\n" + rows + "3 0 1 2\n"))
    assert mesh.vertex_data["normal"].tolist() == [[0, 0, 1], [0, 1, 0], [1, 0, 0]]
    assert mesh.vertex_data["color"].dtype == np.uint8
    assert mesh.vertex_data["color"].tolist() == [[10, 20, 30, 255], [1, 2, 3, 4], [0, 0, 0, 0]]


def test_texture_and_fractions(put):
    rows = "0 0 0 .5 0 1 .1 .2\n" * 3
    data = read_mesh(put("a.off", "STCOFF\n3 1 0\n" + rows + "3 0 1 2\n")).vertex_data
    assert data["color"].tolist() == [[0.5, 0, 1]] * 3
    assert data["uv"].tolist() == [[0.1, 0.2]] * 3


@pytest.mark.parametrize(
    ("text", "line", "word"),
    [
        ("", 1, "end of the file"),
        ("off\n", 1, "'off'"),
        ("OFFS 3 1 0\n", 1, "OFFS"),
        ("OFF BINARY\n4 4 4\n", 1, "BINARY"),
        ("OFF\n4 -1 0\n", 2, "counts"),
        ("OFF\n4 x 0\n", 2, "counts"),
        ("OFF\n4\n", 2, "counts"),
        ("OFF\n0 0 0\n", 2, "vertices"),
        ("OFF\n4 0 0\n" + POINTS, 2, "faces"),
        ("OFF\n999999999 1 0\n" + POINTS, 2, "cut off"),
        ("OFF\n4 999999999999 0\n" + POINTS, 2, "cut off"),
        ("OFF\n4 1 0\n0 0 0\n1 0 0 1\n1 1 0\n0 1 0\n3 0 1 2\n", 4, "3 numbers"),
        ("OFF\n4 1 0\n0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n# long\n", 3, "found 2"),
        ("OFF\n4 1 0\n0 0 0\n1 0\n1 1 0\n0 1 0\n3 0 1 2\n# long\n", 4, "end of the line"),
        ("OFF\n4 1 0\n0 0 0\n1 0 nan\n1 1 0\n0 1 0\n3 0 1 2\n", 4, "nan"),
        ("OFF\n4 1 0\n0 0 0 1\n1 0 0 1\n1 1 0 1\n0 1 0 1\n3 0 1 2\n", 3, "expected 3 numbers"),
        ("COFF\n4 1 0\n" + POINTS + "3 0 1 2\n", 3, "expected 6 or 7"),
        ("OFF\n4 1 0\n" + POINTS + "3 0 1 4\n", 7, "0..3"),
        ("OFF\n4 1 0\n" + POINTS + "4 0 1 2 -1\n", 7, "-1"),
        ("OFF\n4 1 0\n" + POINTS + "2 0 1   \n", 7, "three corners"),
        ("OFF\n4 1 0\n" + POINTS + "3 0 1 \n", 7, "integer"),
        ("OFF\n4 1 0\n" + POINTS + "3 0 1 1.5\n", 7, "1.5"),
        ("OFF\n4 2 0\n" + POINTS + "3 0 1 2\n# long\n", 9, "face 2 of 2"),
        ("OFF\n4 1 0\n" + POINTS + "3 0 1 2\n3 0 1 2\n", 8, "end of the file"),
        ("OFF\n4 1 0\n" + POINTS + "99999999 0 1 2\n", 7, "integer"),
    ],
)
def test_faults_name_their_line(put, text, line, word):
    with pytest.raises(FileFormatError) as caught:
        read_mesh(put("a.off", text))
    assert caught.value.line == line, str(caught.value)
    assert word in str(caught.value)


@pytest.mark.parametrize("names", [(), ("color",), ("normal",), ("color", "normal")])
def test_round_trip(tmp_path, scattered, names):
    data = {name: scattered.vertex_data[name] for name in names}
    write_mesh(tmp_path / "a.off", Mesh(scattered.vertices, scattered.faces, data))
    again = read_mesh(tmp_path / "a.off")
    assert again.vertices.tobytes() == scattered.vertices.tobytes()
    assert np.array_equal(again.faces, scattered.faces)
    assert set(again.vertex_data) == set(names)
    for name in names:
        assert again.vertex_data[name].dtype == data[name].dtype
        assert np.array_equal(again.vertex_data[name], data[name])


def test_a_polygon_that_says_more_corners_than_there_are_bytes_writes_no_further(put):
    head = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n"
    for corners in ("0 1 2\n", "0 1 2 " * 50):
        text = f"{head}1000000 {corners}"
        with pytest.raises(FileFormatError, match="expected an integer"):
            read_mesh(put("a.off", text))
        data, faces = np.frombuffer(text.encode(), np.uint8), np.empty((1, 3), np.int64)
        with np.errstate(over="ignore"):  # Python looks at each index
            off._faces.py_func(data, len(head), 3, 1, faces, 0, 0)
