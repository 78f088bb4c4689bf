"""STL: text and binary, exact welding."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from beltrami.errors import FileFormatError, NonFiniteError
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.io.weld import weld
from beltrami.mesh.mesh import Mesh

CORNERS = [[(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(1, -0.0, 0), (1, 1, 0), (0, 1, 0)]]
LOOP = "facet normal 0 0 1\nouter loop\n{}endloop\nendfacet\n"
TEXT = (
    "solid a b\n"
    + "".join(LOOP.format("".join(f"vertex {x} {y} {z}\n" for x, y, z in t)) for t in CORNERS)
    + "endsolid a\n"
)


def binary(triangles, header=b"binary"):
    body = b"".join(
        struct.pack("<12fH", 0, 0, 1, *(x for corner in t for x in corner), 0) for t in triangles
    )
    return header.ljust(80) + struct.pack("<I", len(triangles)) + body


@pytest.mark.parametrize(
    "content",
    [TEXT, TEXT.upper(), TEXT.replace("\n", "\r\n  "), TEXT.replace("\n", "\n\n"), binary(CORNERS),
     binary(CORNERS, b"solid of a bad exporter")],
)  # fmt: skip
def test_welded_in_order_of_appearance(put, content):
    mesh = read_mesh(put("a.stl", content))
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
    assert mesh.faces.tolist() == [[0, 1, 2], [1, 3, 2]]
    assert not np.signbit(mesh.vertices).any()


def test_text_polygons(put):
    loop = "".join(f"vertex {x}\n" for x in ("0 0 0", "1 0 0", "1 1 0", "0 1 0"))
    text = f"solid\n{LOOP.format(loop)}endsolid\nsolid\n{LOOP.format(loop)}endsolid"
    faces = read_mesh(put("a.stl", text)).faces.tolist()
    assert faces == [[0, 1, 2], [0, 2, 3]] * 2


@pytest.mark.parametrize(
    ("old", "new", "line", "word"),
    [
        ("vertex 1 0 0", "vertex 1 0", 5, "end of the line"),
        ("vertex 1 0 0", "vertex 1 nan 0", 5, "nan"),
        ("vertex 1 0 0\n", "", 6, "three vertices"),
        ("outer loop\n", "", 3, "outer loop"),
        ("endloop\n", "", 7, "endloop"),
        ("facet normal", "fact normal", 2, "'fact'"),
        ("endsolid a\n", "", 16, "endsolid"),
    ],
)
def test_faults_of_text(put, old, new, line, word):
    assert old in TEXT
    with pytest.raises(FileFormatError) as caught:
        read_mesh(put("a.stl", TEXT.replace(old, new, 1)))
    assert caught.value.line == line, str(caught.value)
    assert word in str(caught.value)


def test_faults_of_binary(put):
    whole = binary(CORNERS)
    for content in (b"", whole[:50], whole[:-1], whole + b"0", b"x" * 80 + b"\xff" * 104):
        with pytest.raises(FileFormatError) as caught:
            read_mesh(put("a.stl", content))
        assert caught.value.byte == (80 if len(content) >= 84 else len(content))
    with pytest.raises(FileFormatError, match="faces"):
        read_mesh(put("a.stl", binary([])))
    bad = [CORNERS[0], [(0, 0, 0), (1, 0, float("nan")), (0, 1, 0)]]
    with pytest.raises(FileFormatError, match="triangle 1") as caught:
        read_mesh(put("a.stl", binary(bad)))
    assert caught.value.byte == 84 + 50


def test_welding_against_a_dictionary():
    rng = np.random.default_rng(36_118_240)
    corners = rng.integers(-3, 3, (3000, 3)) * 0.1
    corners[corners == 0] *= rng.choice([-1.0, 1.0], np.count_nonzero(corners == 0))
    vertices, labels = weld(corners)
    seen: dict[tuple[float, ...], int] = {}
    expected = [seen.setdefault(tuple(row), len(seen)) for row in corners.tolist()]
    assert labels.tolist() == expected
    assert np.array_equal(vertices, np.array(list(seen)))


def test_numbers_next_to_each_other_stay_apart():
    assert len(weld(np.array([[1.0, 0, 0], [np.nextafter(1, 2), 0, 0]]))[0]) == 2


def test_round_trip(tmp_path):
    rng = np.random.default_rng(91_002_577)
    vertices = rng.normal(size=(30, 3)).astype(np.float32).astype(float)
    faces = np.concatenate(
        [np.arange(30).reshape(-1, 3), rng.permuted(np.tile(np.arange(30), (20, 1)), axis=1)[:, :3]]
    )
    write_mesh(tmp_path / "a.stl", Mesh(vertices, faces))
    again = read_mesh(tmp_path / "a.stl")
    assert np.array_equal(again.vertices, vertices)
    assert np.array_equal(again.faces, faces)
    row = np.frombuffer((tmp_path / "a.stl").read_bytes(), "<f4", 3, 84)
    a, b, c = vertices[faces[0]]
    assert np.allclose(
        row, np.cross(b - a, c - a) / np.linalg.norm(np.cross(b - a, c - a)), atol=1e-6
    )


def test_beyond_32_bits(tmp_path):
    with pytest.raises(NonFiniteError):
        write_mesh(tmp_path / "a.stl", Mesh(np.eye(3) * 1e39, [[0, 1, 2]]))
    assert not (tmp_path / "a.stl").exists()
