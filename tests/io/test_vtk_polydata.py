"""Legacy VTK files of surfaces: text and binary, before version 5 and since, and broken ones."""

import gzip

import numpy as np
import pytest

import beltrami as bt
from beltrami.errors import FileFormatError
from beltrami.io.source import Source
from beltrami.io.vtk_polydata import is_polydata, read_polydata

POINTS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.1], [2, 0, 0.25]]
HEAD = "# vtk DataFile Version {version}\nany title: POINTS 3\n{mode}\nDATASET POLYDATA\n"


def big(kind, values):
    return np.asarray(values).astype(">" + kind).tobytes() + b"\n"


def text(*lines, version="3.0"):
    return (HEAD.format(version=version, mode="ASCII") + "\n".join(lines) + "\n").encode()


def old_text():
    return text(
        "POINTS 5 float", "0 0 0 1 0 0", "1 1 0 0 1 0.1", "2 0 .25", "",
        "VERTICES 1 2", "1 0", "LINES 1 3", "2 0 1",
        "POLYGONS 2 9", "4 0 1 2 3", "3 1 4 2",
        "CELL_DATA 4", "SCALARS on_cells int 1", "LOOKUP_TABLE default", "1 2 3 4",
        "POINT_DATA 5", "SCALARS height%20of double", "LOOKUP_TABLE default", "0 1 2 nan 4",
        "NORMALS n float", "0 0 1 " * 5, "FIELD FieldData 2", "id 1 5 vtkIdType", "5 4 3 2 1",
        "two 2 5 short", "0 1 2 3 4 5 6 7 8 9",
    )  # fmt: skip


def new_text():
    return text(
        "POINTS 5 double", "0 0 0 1 0 0 1 1 0 0 1 0.1 2 0 .25",
        "METADATA", "INFORMATION 1", "NAME L2_NORM_RANGE LOCATION vtkDataArray", "DATA 2 0 1", "",
        "POLYGONS 3 7", "OFFSETS vtktypeint64", "0 4 7", "CONNECTIVITY vtktypeint64",
        "0 1 2 3 1 4 2",
        "POINT_DATA 5", "SCALARS height%20of double", "LOOKUP_TABLE default", "0 1 2 nan 4",
        "METADATA", "INFORMATION 0", "", "NORMALS n float", "0 0 1 " * 5,
        "FIELD FieldData 2", "id 1 5 vtktypeint64", "5 4 3 2 1",
        "METADATA", "INFORMATION 0", "", "two 2 5 short", "0 1 2 3 4 5 6 7 8 9",
        version="5.1",
    )  # fmt: skip


def old_binary():
    head = HEAD.format(version="4.2", mode="BINARY").encode()
    return b"".join([
        head, b"POINTS 5 float\n", big("f4", POINTS),
        b"POLYGONS 2 9\n", big("i4", [4, 0, 1, 2, 3, 3, 1, 4, 2]),
        b"POINT_DATA 5\nSCALARS height%20of double\nLOOKUP_TABLE mine\n",
        big("f8", [0, 1, 2, np.nan, 4]),
        b"LOOKUP_TABLE mine 2\n", big("u1", range(8)),
        b"NORMALS n float\n", big("f4", [[0, 0, 1]] * 5),
        b"FIELD FieldData 2\nid 1 5 vtkIdType\n", big("i4", [5, 4, 3, 2, 1]),
        b"two 2 5 short\n", big("i2", range(10)),
    ])  # fmt: skip


def new_binary():
    head = HEAD.format(version="5.1", mode="BINARY").encode()
    return b"".join([
        head, b"FIELD FieldData 1\nTime 1 1 double\n", big("f8", [0.5]),
        b"POINTS 5 float\n", big("f4", POINTS),
        b"METADATA\nINFORMATION 0\n\n",
        b"POLYGONS 3 7\nOFFSETS vtktypeint64\n", big("i8", [0, 4, 7]),
        b"CONNECTIVITY vtktypeint64\n", big("i8", [0, 1, 2, 3, 1, 4, 2]),
        b"CELL_DATA 2\nCOLOR_SCALARS of_cells 3\n", big("u1", range(6)),
        b"POINT_DATA 5\nSCALARS height%20of double\nLOOKUP_TABLE default\n",
        big("f8", [0, 1, 2, np.nan, 4]),
        b"NORMALS n float\n", big("f4", [[0, 0, 1]] * 5),
        b"FIELD FieldData 2\nid 1 5 vtktypeint64\n", big("i8", [5, 4, 3, 2, 1]),
        b"two 2 5 short\n", big("i2", range(10)),
    ])  # fmt: skip


FILES = [old_text, new_text, old_binary, new_binary]


@pytest.mark.parametrize("make", FILES)
def test_all_of_it_is_read(make, tmp_path):
    (tmp_path / "a.vtk").write_bytes(make())
    mesh = bt.read_mesh(tmp_path / "a.vtk")
    assert np.allclose(mesh.vertices, POINTS, atol=1e-7)
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [1, 4, 2]]
    assert list(mesh.vertex_data) == ["height of", "n", "id", "two"]
    assert np.array_equal(mesh.vertex_data["height of"], [0, 1, 2, np.nan, 4], equal_nan=True)
    assert mesh.vertex_data["n"].tolist() == [[0, 0, 1]] * 5
    assert mesh.vertex_data["n"].dtype == np.float32
    assert mesh.vertex_data["id"].tolist() == [5, 4, 3, 2, 1]
    assert mesh.vertex_data["id"].dtype.kind == "i"
    assert mesh.vertex_data["two"].tolist() == np.arange(10).reshape(5, 2).tolist()


def test_coordinates_in_text_keep_their_digits(tmp_path):
    lines = "POINTS 3 float", "0.123456789012 0 0 1 0 0 0 1 0", "POLYGONS 1 4", "3 0 1 2"
    (tmp_path / "a.vtk").write_bytes(text(*lines))
    assert bt.read_mesh(tmp_path / "a.vtk").vertices[0, 0] == 0.123456789012


def test_strips_and_texture_coordinates(tmp_path):
    lines = (
        "POINTS 4 float", "0 0 0 1 0 0 0 1 0 1 1 0", "TRIANGLE_STRIPS 1 5", "4 0 1 2 3",
        "POINT_DATA 4", "TEXTURE_COORDINATES t 2 float", "0 0 1 0 0 1 1 1",
    )  # fmt: skip
    (tmp_path / "a.vtk").write_bytes(text(*lines))
    mesh = bt.read_mesh(tmp_path / "a.vtk")
    assert (mesh.face_normals[:, 2] == 1).all()
    assert mesh.area == 1
    assert np.array_equal(mesh.corner_uv, mesh.vertices[mesh.faces][:, :, :2])


def test_coordinates_of_a_texture_that_is_no_picture_are_left_out(tmp_path):
    lines = (
        "POINTS 3 float", "0 0 0 1 0 0 0 1 0", "POLYGONS 1 4", "3 0 1 2",
        "POINT_DATA 3", "TEXTURE_COORDINATES t 3 float", "0 0 1 0 0 1 1 1 1",
    )  # fmt: skip
    (tmp_path / "a.vtk").write_bytes(text(*lines))
    mesh = bt.read_mesh(tmp_path / "a.vtk")
    assert mesh.n_faces == 1
    assert mesh.corner_uv is None


def test_it_may_be_compressed(tmp_path):
    (tmp_path / "a.vtk.gz").write_bytes(gzip.compress(old_binary()))
    assert bt.read_mesh(tmp_path / "a.vtk.gz").n_faces == 3


@pytest.mark.parametrize("make", FILES)
def test_every_cut_is_a_mesh_or_one_clear_line(make, tmp_path):
    whole = make()
    path = tmp_path / "a.vtk"
    for end in range(0, len(whole), 2):
        path.write_bytes(whole[:end])
        try:
            if is_polydata(Source(path)):
                assert len(read_polydata(Source(path)).points) in (0, 5)
        except FileFormatError as error:
            assert "\n" not in str(error)  # noqa: PT017


@pytest.mark.parametrize("make", FILES)
def test_changed_bytes(make, tmp_path):
    whole = np.frombuffer(make(), np.uint8)
    path, rng = tmp_path / "a.vtk", np.random.default_rng(0)
    for _ in range(200):
        changed = whole.copy()
        changed[rng.integers(80, len(whole), 2)] = rng.integers(0, 256, 2)
        path.write_bytes(changed.tobytes())
        try:
            read_polydata(Source(path))
        except FileFormatError as error:
            assert "\n" not in str(error)  # noqa: PT017


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        (("POINTS 3 float", "0 0 0 1 x 0 0 1 0"), "line 6: expected a number (4 of 9), found 'x'"),
        (("POINTS many float",), "expected a count"),
        (("POINTS 3 text", "0 0 0"), None),
        (("POINTS 900000000 float", "0 0 0"), "at least 5399999999 bytes, found 6"),
        (("POINTS 3 float", "0 0 0 1 0 0 0 1 0", "POLYGONS 1 3", "2 0 1"), "three corners or more"),
        (("POINTS 3 float", "0 0 0 1 0 0 0 1 0", "POLYGONS 1 4", "3 0 1 3"), "vertices, 0..2"),
        (("POINTS 3 float", "0 0 0 1 0 0 0 1 0", "POLYGONS 1 5", "3 0 1 2 0"), "1 lists"),
        (("POINTS 3 float", "0 0 0 1 0 0 0 1 0", "POLYGONS 1 4", "3 0 1 .5"), "whole numbers"),
        (("POINTS 3 float", "0 0 0 1 0 0 0 1 0", "SHAPES 1"), "a section of a surface"),
        (("POINTS 3 float", "0 0 0 1 0 0 0 1 0"), "triangles or polygons, found none"),
        (("POINTS 3 float", "0 0 nan 1 0 0 0 1 0", "POLYGONS 1 4", "3 0 1 2"), "NaN in vertex 0"),
        (
            ("POINTS 3 float", "0 0 0 1 0 0 0 1 0", "POINT_DATA 3", "FIELD F 1", "s 1 3 string"),
            "one of the types",
        ),
        (
            ("POINTS 3 float", "0 0 0 1 0 0 0 1 0", "POLYGONS 99999999999999 4", "3 0 1 2"),
            "fewer than 99999999999999 lists in 4 numbers",
        ),
        (
            ("POINTS 3 float", "0 0 0 1 0 0 0 1 0", "POLYGONS 2 3", "OFFSETS int", "1 3"),
            "expected 2 words",
        ),
    ],
)
def test_what_is_wrong_is_named(lines, told, tmp_path):
    (tmp_path / "a.vtk").write_bytes(text(*lines))
    with pytest.raises(FileFormatError) as caught:
        bt.read_mesh(tmp_path / "a.vtk")
    assert (told or "") in str(caught.value)
    assert str(caught.value).startswith(str(tmp_path / "a.vtk"))
