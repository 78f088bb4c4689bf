"""Texts that begin with the mark of UTF-8, as some editors and Excel write them."""

import gzip

import numpy as np
import pytest

from beltrami.errors import FileFormatError
from beltrami.io.function import read_function
from beltrami.io.registry import read_mesh

MARK = b"\xef\xbb\xbf"
ROWS = b"0 0 0\n1 0 0\n0 1 0\n"
HEADER = (
    b"element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    b"element face 1\nproperty list uchar int vertex_indices\nend_header\n"
)
TEXTS = {
    ".obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n",
    ".off": b"OFF\n3 1 0\n" + ROWS + b"3 0 1 2\n",
    ".ply": b"ply\nformat ascii 1.0\n" + HEADER + ROWS + b"3 0 1 2\n",
    ".stl": b"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    b"endloop\nendfacet\nendsolid\n",
}
BINARY = (
    b"ply\nformat binary_little_endian 1.0\n"
    + HEADER
    + np.array([0, 0, 0, 1, 0, 0, 0, 1, 0], "<f4").tobytes()
    + b"\3"
    + np.arange(3, dtype="<i4").tobytes()
)


@pytest.mark.parametrize("suffix", TEXTS)
def test_a_mesh_is_the_same_with_a_mark(put, suffix):
    """An OBJ lost its first vertex, and its faces were those of others."""
    for content in (MARK + TEXTS[suffix], TEXTS[suffix]):
        for name, held in ((f"a{suffix}", content), (f"a{suffix}.gz", gzip.compress(content))):
            mesh = read_mesh(put(name, held))
            assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
            assert mesh.faces.tolist() == [[0, 1, 2]]


def test_binary_ply_with_a_mark(put):
    for content in (BINARY, MARK + BINARY):
        assert read_mesh(put("a.ply", content)).vertices[1].tolist() == [1, 0, 0]


def test_a_function_keeps_its_first_value_and_the_name_of_its_first_column(put):
    """The first number was taken for the name of a column, and left out."""
    assert read_function(put("f.txt", MARK + b"1\n2\n3\n")).tolist() == [1, 2, 3]
    table = put("f.csv", MARK + b"u,v\r\n1,2\r\n3,4\r\n")
    assert read_function(table, "u").tolist() == [1, 3]


@pytest.mark.parametrize("suffix", TEXTS)
def test_faults_are_found_in_their_lines_all_the_same(put, suffix):
    whole = TEXTS[suffix]
    at = whole.rindex(b"1 0")
    broken = whole[:at] + b"x" + whole[at + 1 :]
    lines = []
    for content in (broken, MARK + broken):
        with pytest.raises(FileFormatError) as caught:
            read_mesh(put(f"a{suffix}", content))
        lines.append(caught.value.line)
    assert lines[0] == lines[1] == whole[:at].count(b"\n") + 1


def test_a_binary_stl_may_begin_with_these_bytes(put):
    triangle = np.zeros(1, [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    triangle["corners"] = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    whole = MARK.ljust(80, b"\0") + np.array([1], "<u4").tobytes() + triangle.tobytes()
    assert read_mesh(put("a.stl", whole)).n_faces == 1


def test_only_a_mark_is_no_mesh(put):
    for suffix in TEXTS:
        with pytest.raises(FileFormatError):
            read_mesh(put(f"a{suffix}", MARK))
    with pytest.raises(FileFormatError):
        read_function(put("f.txt", MARK))
