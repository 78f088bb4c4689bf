"""OBJ: what is read, what is refused and where, round trips."""

from __future__ import annotations

import numpy as np
import pytest

from beltrami.errors import DimensionError, FileFormatError
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.mesh import Mesh

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


@pytest.mark.parametrize(
    ("lines", "faces"),
    [
        ("f 1 2 3 4\n", [[0, 1, 2], [0, 2, 3]]),
        ("f -4 -3 -2\n", [[0, 1, 2]]),
        ("f 1//1 2//1 3//9\n", [[0, 1, 2]]),
        ("f 1 2 3", [[0, 1, 2]]),
        ("  f\t1  2 3 # no 4\n", [[0, 1, 2]]),
        ("f 1 2 \\\n 3 4\n", [[0, 1, 2], [0, 2, 3]]),
        ("f 1 2 3\\\r\n 4\r\n", [[0, 1, 2], [0, 2, 3]]),
        ("f 1 2 3\nf 1 3 4\nf 2 3 4 1\n", [[0, 1, 2], [0, 2, 3], [1, 2, 3], [1, 3, 0]]),
        ("l 1 2 \\\nf 9 9 9\nf 1 2 3\n", [[0, 1, 2]]),
        ("g a\ns 1\nusemtl f\nvn 0 0 1\np 1\nfo 9 9\nf 1 2 3\n", [[0, 1, 2]]),
        ("f 1 2 5\nv 2 2 2\n", [[0, 1, 4]]),
    ],
)
def test_faces(put, lines, faces):
    assert read_mesh(put("a.obj", SQUARE + lines)).faces.tolist() == faces


def test_vertices_of_every_form(put):
    text = "v  1 2 3\nv 1 2 3 0.5\r\nv\t-1e-3 +2. .25 \nv 1 \\\n 2 3 # c\nv 4 5 6#c\nf 1 2 3\n"
    with pytest.raises(FileFormatError) as caught:
        read_mesh(put("a.obj", text))
    assert caught.value.line == 6  # the number ends at a blank only
    mesh = read_mesh(put("b.obj", text.replace("6#c", "6 #c")))
    expected = [[1, 2, 3], [1, 2, 3], [-1e-3, 2, 0.25], [1, 2, 3], [4, 5, 6]]
    assert mesh.vertices.tolist() == expected
    assert not mesh.vertex_data


def test_colours(put):
    text = "v 0 0 0\nv 1 0 0 .5 .25 1\nv 1 1 0 1 0 0\nf 1 2 3\n"
    colour = read_mesh(put("a.obj", text)).vertex_data["color"]
    assert np.isnan(colour[0]).all()
    assert colour[1:].tolist() == [[0.5, 0.25, 1], [1, 0, 0]]
    text = text.replace("0 0 0\n", "0 0 0 .1 .2 .3 .4\n")
    assert read_mesh(put("a.obj", text)).vertex_data["color"].shape == (3, 4)


def test_texture_coordinates(put):
    text = SQUARE + "vt 0\nf 1 2 3\nvt .5 .25 0\nf 1/1 3/-1 4/2\nf 2/1/1 3 1/2\n"
    uv = read_mesh(put("a.obj", text)).corner_uv
    assert np.isnan(uv[0]).all()
    assert uv[1].tolist() == [[0, 0], [0.5, 0.25], [0.5, 0.25]]
    assert np.isnan(uv[2, 1]).all()
    assert uv[2, 2].tolist() == [0.5, 0.25]


def test_texture_coordinates_that_no_face_uses(put):
    assert read_mesh(put("a.obj", SQUARE + "vt 0 0\nf 1 2 3\n")).corner_uv is None


@pytest.mark.parametrize(
    ("lines", "line", "word"),
    [
        ("f 1 2 5\n", 5, "1..4"),
        ("f 1 2 3\nf 1 2 0\n", 6, "'0'"),
        ("f 1 2 -5\n", 5, "'-5'"),
        ("f 1 2\n", 5, "three corners"),
        ("\n\nf 1 2 x\n", 7, "'x'"),
        ("f 1 2 3.5\n", 5, "3.5"),
        ("f 1/ 2/x 3\n", 5, "2/x"),
        ("f 1/1 2/1 3/1\n", 5, "texture"),
        ("vt 0 0\nf 1/0 2/1 3/1\n", 6, "texture"),
        ("vt 0 0\nf 1/1 2/1 3/2\n", 6, "3/2"),
        ("vt x 0\nf 1 2 3\n", 5, "'x'"),
        ("v 1 2\n", 5, "end of the line"),
        ("v 1  2\n", 5, "end of the line"),
        ("v  1 2\n", 5, "end of the line"),
        ("v 1 nan 2\n", 5, "'nan'"),
        ("v 1 2 inf\n", 5, "'inf'"),
        ("v 1 2 1e999\n", 5, "finite"),
        ("v 1 2 3 4 5\n", 5, "x y z"),
        ("v 1 2 3 4 5 6 7 8\n", 5, "x y z"),
        ("v 1 2 3 4 5 nan\n", 5, "nan"),
        ("v 1 2 3x\n", 5, "3x"),
        ("v 1 2", 5, "end of the"),
        ("f 1 2 99999999999999999999\n", 5, "99999"),
    ],
)
def test_faults_name_their_line(put, lines, line, word):
    with pytest.raises(FileFormatError, match=r"a\.obj, line") as caught:
        read_mesh(put("a.obj", SQUARE + lines))
    assert caught.value.line == line
    assert word in str(caught.value)


@pytest.mark.parametrize(
    ("text", "word"), [("", "vertices"), ("# no\n", "vertices"), (SQUARE, "faces")]
)
def test_nothing_to_read(put, text, word):
    with pytest.raises(FileFormatError, match=f"expected {word}"):
        read_mesh(put("a.obj", text))


def test_arrays_grow(put):
    short = "v 0 0 0\n" * 4000 + "f 1 2 3\n" * 4000 + "vt 0\n" * 4000
    polygon = "f " + " ".join(["1", "2", "3"] * 3000) + "\n"
    mesh = read_mesh(put("a.obj", short + polygon + "f 1/4000 2/1 3/1\n"))
    assert (mesh.n_vertices, mesh.n_faces) == (4000, 4000 + 8998 + 1)
    assert np.isnan(mesh.corner_uv[:-1]).all()
    assert mesh.corner_uv[-1].tolist() == [[0, 0]] * 3


def test_round_trip(tmp_path, scattered):
    path = tmp_path / "a.obj"
    write_mesh(path, scattered)
    again = read_mesh(path)
    assert again.vertices.tobytes() == scattered.vertices.tobytes()
    assert np.array_equal(again.faces, scattered.faces)
    assert again.corner_uv.tobytes() == scattered.corner_uv.tobytes()
    assert np.array_equal(again.vertex_data["color"], scattered.vertex_data["color"] / 255)
    points = len(np.unique(scattered.corner_uv.reshape(-1, 2), axis=0))
    assert path.read_bytes().count(b"\nvt ") == points


def test_round_trip_of_corners_without_texture(tmp_path):
    uv = np.full((4, 3, 2), np.nan)
    uv[1] = [[0.1, 0.2], [0.3, 0.4], [0.1, 0.2]]
    uv[3, 0] = [0.3, 0.4]
    mesh = Mesh(np.eye(3), [[0, 1, 2]] * 4, None, uv)
    write_mesh(tmp_path / "a.obj", mesh)
    assert np.array_equal(read_mesh(tmp_path / "a.obj").corner_uv, uv, equal_nan=True)


def test_given_texture_coordinates(tmp_path, scattered):
    uv = np.random.default_rng(77_301_448).normal(size=(scattered.n_vertices, 2))
    write_mesh(tmp_path / "a.obj", scattered, uv=uv)
    assert np.array_equal(read_mesh(tmp_path / "a.obj").corner_uv, uv[scattered.faces])
    write_mesh(tmp_path / "a.obj", scattered, uv=uv[scattered.faces])
    assert np.array_equal(read_mesh(tmp_path / "a.obj").corner_uv, uv[scattered.faces])
    with pytest.raises(DimensionError, match=r"\(40, 2\)"):
        write_mesh(tmp_path / "a.obj", scattered, uv=uv[:-1])


@pytest.mark.parametrize("newline", ["\n", "\r\n", " \r\n", "\r\r\n"])
@pytest.mark.parametrize("last", ["", "\r", "f 1 2 3\r", "f 1 2"])
def test_ends_of_lines(put, newline, last):
    """Also at the very end, where no byte may be looked at beyond it."""
    lines = ["v 0 0 0", "v 1 .5 0", "v 0 1e0 -2.25", "f 1 2 3", "f 3 2 1"]
    content = newline.join([*lines, ""]) + last
    if last == "f 1 2":
        with pytest.raises(FileFormatError, match="three corners"):
            read_mesh(put("a.obj", content))
        return
    mesh = read_mesh(put("a.obj", content))
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0.5, 0], [0, 1, -2.25]]
    assert mesh.faces.tolist() == [[0, 1, 2], [2, 1, 0], *([[0, 1, 2]] if "f" in last else [])]
