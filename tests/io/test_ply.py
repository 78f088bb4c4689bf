"""PLY: the three encodings, schemas, strips, vertex data."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from beltrami.errors import FileFormatError, UnknownNameError
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.mesh import Mesh

ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
CODES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I"}
CODES |= {"float": "f", "double": "d", "int8": "b", "uint16": "H", "float64": "d"}
SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


def ply(form, elements, tail=b""):
    """Make a file from [(name, ["type name" or "list count type name"], rows)]."""
    lines = ["ply", f"format {form} 1.0", "comment made", "obj_info made"]
    body = b""
    for name, properties, rows in elements:
        lines += [f"element {name} {len(rows)}", *(f"property {p}" for p in properties)]
        for row in rows:
            words = []
            for p, value in zip(properties, row, strict=True):
                kind = p.split()
                if kind[0] == "list":
                    words += [(kind[1], len(value)), *((kind[2], v) for v in value)]
                else:
                    words.append((kind[0], value))
            if ORDERS[form]:
                body += b"".join(struct.pack(ORDERS[form] + CODES[k], v) for k, v in words)
            else:
                body += " ".join(str(v) for _, v in words).encode() + b"\n"
    return "\n".join([*lines, "end_header\n"]).encode() + body + tail


def square(faces, vertex=("float x", "float y", "float z"), count="uchar", index="int"):
    return [
        ("vertex", list(vertex), SQUARE),
        ("face", [f"list {count} {index} vertex_indices"], [(f,) for f in faces]),
    ]


@pytest.fixture(params=ORDERS)
def form(request):
    return request.param


@pytest.mark.parametrize(
    "faces", [[(0, 1, 2), (0, 2, 3)], [(0, 1, 2, 3)], [(0, 1, 2), (0, 1, 2, 3)]]
)
@pytest.mark.parametrize(("count", "index"), [("uchar", "int"), ("int", "uint"), ("short", "char")])
def test_polygons(put, form, faces, count, index):
    mesh = read_mesh(put("a.ply", ply(form, square(faces, count=count, index=index))))
    expected = [t for f in faces for t in ([f[:3]] if len(f) == 3 else [f[:3], (f[0], *f[2:])])]
    assert mesh.faces.tolist() == [list(t) for t in expected]
    assert mesh.vertices.tolist() == [list(map(float, x)) for x in SQUARE]


def test_order_of_properties_and_unknown_elements(put, form):
    elements = [
        ("camera", ["float a", "list uchar double b"], [(1.5, (1, 2, 3)), (2.5, ())]),
        ("nothing", [], [(), ()]),
        ("vertex", ["double z", "uchar k", "list int short l", "float y", "double x"], []),
        ("edge", ["int a", "int b"], [(0, 1), (1, 2)]),
        ("face", ["list uchar float texcoord", "short tag", "list ushort uint vertex_index"], []),
        ("edge2", ["int a"], [(5,)]),
    ]
    for i, (x, y, z) in enumerate(SQUARE):
        elements[2][2].append((z + 0.1, 250 + i, (7,) * i, y, x))
    elements[4][2].extend([((0.5, 0.5), -3, (0, 1, 2)), ((), 4, (0, 1, 2, 3))])
    mesh = read_mesh(put("a.ply", ply(form, elements)))
    assert np.array_equal(mesh.vertices, np.add(SQUARE, (0, 0, 0.1)))
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 1, 2], [0, 2, 3]]
    assert mesh.vertex_data["k"].dtype == np.uint8
    assert mesh.vertex_data["k"].tolist() == [250, 251, 252, 253]
    assert list(mesh.vertex_data) == ["k"]


def test_strips(put, form):
    strip = [0, 1, 2, 3, -1, 3, 2, 1, -1, 0, 1, 1, 2, 3, -1, 0, 1]
    elements = [square([])[0], ("tristrips", ["list int int vertex_indices"], [(strip,)])]
    expected = [[0, 1, 2], [2, 1, 3], [3, 2, 1], [1, 2, 3]]
    assert read_mesh(put("a.ply", ply(form, elements))).faces.tolist() == expected


def test_grouped_properties(put, form):
    names = ["x", "y", "z", "nx", "ny", "nz"]
    vertex = [f"float {n}" for n in names] + [f"uchar {n}" for n in ("red", "green", "blue")]
    vertex += ["double u_0", "double u_1", "short s_0", "int s_1"]
    rows = [(*x, 0, 0, 1, 10, 20, 30, 0.5, 0.25, 1, 2) for x in SQUARE]
    elements = [("vertex", vertex, rows), square([(0, 1, 2)])[1]]
    data = read_mesh(put("a.ply", ply(form, elements))).vertex_data
    assert list(data) == ["normal", "color", "u", "s_0", "s_1"]
    assert data["color"].dtype == np.uint8
    assert data["color"].tolist() == [[10, 20, 30]] * 4
    assert data["normal"].tolist() == [[0, 0, 1]] * 4
    assert data["u"].tolist() == [[0.5, 0.25]] * 4
    assert data["s_1"].dtype == np.dtype("i4")
    assert all(array.dtype.isnative for array in data.values())


def test_line_ends_of_the_header(put):
    for newline in (b"\r\n", b"\r"):
        head, body = ply("binary_little_endian", square([(0, 1, 2)])).split(b"end_header\n")
        content = (head + b"end_header\n").replace(b"\n", newline) + body
        assert read_mesh(put("a.ply", content)).faces.tolist() == [[0, 1, 2]]
    text = ply("ascii", square([(0, 1, 2)])).replace(b"\n", b"\r\n")
    assert read_mesh(put("a.ply", text)).faces.tolist() == [[0, 1, 2]]


def test_long_headers(put, form):
    long = b"comment end_header\n" + b"comment of many words\n" * 400
    content = ply(form, square([(0, 1, 2)])).replace(b"comment made\n", long)
    assert read_mesh(put("a.ply", content)).faces.tolist() == [[0, 1, 2]]


def test_not_finite_values_are_data_but_no_coordinates(put, form):
    vertex = ["float x", "float y", "float z", "float q"]
    rows = [(*x, float("nan")) for x in SQUARE]
    elements = [("vertex", vertex, rows), square([(0, 1, 2)])[1]]
    assert np.isnan(read_mesh(put("a.ply", ply(form, elements))).vertex_data["q"]).all()
    rows[2] = (1, float("inf"), 0, 1)
    with pytest.raises(FileFormatError, match=r"finite coordinates.* vertex 2"):
        read_mesh(put("a.ply", ply(form, elements)))


@pytest.mark.parametrize(
    ("faces", "word"),
    [
        ([(0, 1, 2), (0, 1, 4)], r"0\.\.3, found 4 in triangle 1"),
        ([(0, 1, 2), (0, -1, 2)], "found -1"),
        ([(0, 1, 2), (0, 1)], "found 2 in face 1"),
        ([(0, 1, 2), ()], "found 0 in face 1"),
        ([], "expected faces"),
    ],
)
def test_faults_of_faces(put, form, faces, word):
    with pytest.raises(FileFormatError, match=word):
        read_mesh(put("a.ply", ply(form, square(faces))))


def test_every_truncation_is_found(put, form):
    whole = ply(form, square([(0, 1, 2), (0, 1, 2, 3)]))
    for size in range(len(whole) - (2 if form == "ascii" else 1)):
        with pytest.raises(FileFormatError):
            read_mesh(put("a.ply", whole[:size]))


def test_bytes_after_the_end(put, form):
    with pytest.raises(FileFormatError, match="more bytes"):
        read_mesh(put("a.ply", ply(form, square([(0, 1, 2)]), b"7")))


@pytest.mark.parametrize("count", [4_000_000_000, 10**17])
def test_huge_counts(put, form, count):
    content = ply(form, square([(0, 1, 2)])).replace(b"vertex 4", b"vertex %d" % count)
    with pytest.raises(FileFormatError, match=f"{count} rows"):
        read_mesh(put("a.ply", content))
    content = ply(form, square([(0, 1, 2)])).replace(b"face 1", b"face %d" % count)
    with pytest.raises(FileFormatError, match=f"{count} rows"):
        read_mesh(put("a.ply", content))


def test_a_list_of_negative_length(put):
    content = ply("binary_little_endian", square([(0, 1, 2)], count="char"))
    content = content[:-13] + b"\xff" + content[-12:]
    with pytest.raises(FileFormatError, match="negative length") as caught:
        read_mesh(put("a.ply", content))
    assert caught.value.byte == len(content) - 13


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("ply\n", "plx\n", 1),
        ("format ascii", "format asci", 2),
        ("element vertex 4", "element vertex four", 5),
        ("element vertex 4", "element vertex -4", 5),
        ("element vertex 4\n", "", 5),
        ("float x", "flaot x", 6),
        ("float y", "float x", 7),
        ("list uchar int", "list float int", 10),
        ("list uchar int vertex_indices", "list uchar int", 10),
        ("comment made", "commend made", 3),
        ("3 0 1 2", "3 0 x 2", 16),
        ("3 0 1 2", "-3 0 1 2", 16),
        ("3 0 1 2", "3 0 1.5 2", 16),
        ("3 0 1 2", "99 0 1 2", None),
        ("1 0 0", "1 zero 0", 13),
    ],
)
def test_faults_name_their_line(put, old, new, line):
    content = ply("ascii", square([(0, 1, 2)])).decode()
    assert old in content
    with pytest.raises(FileFormatError) as caught:
        read_mesh(put("a.ply", content.replace(old, new, 1)))
    assert caught.value.line == line or line is None


def test_numbers_beyond_their_type(put):
    elements = [
        ("vertex", ["float x", "float y", "float z", "uchar k"], [(*x, 256) for x in SQUARE])
    ]
    with pytest.raises(FileFormatError, match="within the type of its property, found '256'"):
        read_mesh(put("a.ply", ply("ascii", [*elements, square([(0, 1, 2)])[1]])))


@pytest.mark.parametrize("missing", ["format ascii 1.0\n", "property float z\n", "end_header\n"])
def test_missing_parts(put, missing):
    content = ply("ascii", square([(0, 1, 2)])).decode().replace(missing, "")
    with pytest.raises(FileFormatError):
        read_mesh(put("a.ply", content))


def test_round_trip(tmp_path, scattered):
    write_mesh(tmp_path / "a.ply", scattered)
    again = read_mesh(tmp_path / "a.ply")
    assert again.vertices.tobytes() == scattered.vertices.tobytes()
    assert np.array_equal(again.faces, scattered.faces)
    assert list(again.vertex_data) == list(scattered.vertex_data)
    for name, array in scattered.vertex_data.items():
        assert again.vertex_data[name].dtype == array.dtype, name
        assert again.vertex_data[name].shape == array.shape, name
        assert again.vertex_data[name].tobytes() == array.tobytes(), name


def test_a_number_that_its_type_cannot_hold(tmp_path):
    text = (
        b"ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
        b"property double z\nproperty float heat\nelement face 1\n"
        b"property list uchar int vertex_indices\nend_header\n"
        b"0 0 0 1\n1 0 0 1e300\n0 1 0 3\n3 0 1 2\n"
    )
    path = tmp_path / "large.ply"
    path.write_bytes(text)
    with pytest.raises(FileFormatError, match=r"'heat', found 1e\+300 in row 1"):
        read_mesh(path)
    path.write_bytes(text.replace(b"1e300", b"2"))
    assert read_mesh(path).vertex_data["heat"].tolist() == [1, 2, 3]


@pytest.mark.parametrize("form", ["binary_little_endian", "binary_big_endian"])
def test_rows_without_lists_that_long_lists_before_leave_no_room_for(put, form):
    points = ["float x", "float y", "float z", "list uchar double q"]
    rows = [(0, 0, 0, [1.0] * 5), (1, 0, 0, []), (0, 1, 0, [2.0] * 5)]
    content = ply(form, [("vertex", points, rows), ("other", ["double a"], [(1.0,)] * 4)])
    for short in (1, 8, 31):
        with pytest.raises(FileFormatError, match="32 bytes for the 4 rows") as caught:
            read_mesh(put("a.ply", content[:-short]))
        assert caught.value.byte == len(content) - short


VERTEX = ("float x", "float y", "float z")
TURNS = [(0.5, 0.25, 1, 0, -3, 2), (0, 1, 2, 3, 4, 5, 6, 7)]


def textured(faces, turns, kind="float"):
    lists = ["list uchar int vertex_indices", f"list uchar {kind} texcoord", "int texnumber"]
    rows = [(f, t, 0) for f, t in zip(faces, turns, strict=True)]
    return [("vertex", list(VERTEX), SQUARE), ("face", lists, rows)]


@pytest.mark.parametrize("kind", ["float", "double"])
def test_texture_coordinates_of_faces(put, form, kind):
    """A triangle and a square, which is cut from its first corner, as its coordinates are."""
    mesh = read_mesh(put("a.ply", ply(form, textured([(0, 1, 2), (0, 1, 2, 3)], TURNS, kind))))
    exact = [
        [(0.5, 0.25), (1, 0), (-3, 2)],
        [(0, 1), (2, 3), (4, 5)],
        [(0, 1), (4, 5), (6, 7)],
    ]
    assert np.array_equal(mesh.corner_uv, exact)
    assert dict(mesh.vertex_data) == {}
    plain = read_mesh(put("b.ply", ply(form, textured([(0, 1, 2)], TURNS[:1], kind))))
    assert np.array_equal(plain.corner_uv, exact[:1])


def test_faces_without_texture_coordinates_have_none(put, form):
    turns = [(), TURNS[0], (1, 2, 3)]
    mesh = read_mesh(put("a.ply", ply(form, textured([(0, 1, 2)] * 3, turns))))
    assert np.isnan(mesh.corner_uv[[0, 2]]).all()
    assert np.array_equal(mesh.corner_uv[1].ravel(), TURNS[0])
    assert read_mesh(put("a.ply", ply(form, textured([(0, 1, 2)], [()])))).corner_uv is None
    whole = ply(form, textured([(0, 1, 2)] * 3, turns))
    for cut in range(2, 20):
        with pytest.raises(FileFormatError):
            read_mesh(put("a.ply", whole[:-cut]))


@pytest.mark.parametrize("names", [("texture_u", "texture_v"), ("u", "v"), ("t", "s")])
def test_texture_coordinates_of_vertices(put, form, names):
    rows = [(*x, 7, x[0] / 2, x[1] / 4) for x in SQUARE]
    vertex = [*VERTEX, "uchar k", *(f"float {name}" for name in names)]
    faces = square([(0, 1, 2, 3)])[1]
    mesh = read_mesh(put("a.ply", ply(form, [("vertex", vertex, rows), faces])))
    exact = np.array([(x / 2, y / 4) for x, y, _ in SQUARE])
    exact = exact[:, ::-1] if names[0] == "t" else exact
    assert np.array_equal(mesh.corner_uv, exact[mesh.faces])
    assert list(mesh.vertex_data) == ["k"]
    vertex = [p.replace("float t", "int t") for p in vertex] if names[0] == "t" else vertex[:-1]
    rows = [row[: len(vertex)] if names[0] != "t" else (*row[:4], 1, 2.5) for row in rows]
    alone = read_mesh(put("b.ply", ply(form, [("vertex", vertex, rows), faces])))
    assert alone.corner_uv is None  # one of the two, or whole numbers, is a function
    assert names[0] in alone.vertex_data


def test_those_of_the_faces_count_more(put, form):
    _, faces = textured([(0, 1, 2)], TURNS[:1])
    vertex = ("vertex", [*VERTEX, "float s", "float t"], [(*x, 9, 9) for x in SQUARE])
    mesh = read_mesh(put("a.ply", ply(form, [vertex, faces])))
    assert np.array_equal(mesh.corner_uv.ravel(), TURNS[0])


@pytest.mark.parametrize("digits", [np.float32, np.float64])
def test_texture_coordinates_are_written(tmp_path, scattered, digits):
    rng = np.random.default_rng(9)
    uv = rng.normal(size=(scattered.n_faces, 3, 2)).astype(digits)
    uv[3, 1] = np.nan
    write_mesh(tmp_path / "a.ply", scattered, uv)
    again = read_mesh(tmp_path / "a.ply")
    assert np.array_equal(again.corner_uv, uv, equal_nan=True)
    assert np.array_equal(again.faces, scattered.faces)
    kind = b"float" if digits is np.float32 else b"double"
    assert b"property list uchar %s texcoord" % kind in (tmp_path / "a.ply").read_bytes()
    write_mesh(tmp_path / "b.ply", again)
    assert (tmp_path / "b.ply").read_bytes() == (tmp_path / "a.ply").read_bytes()


@pytest.mark.parametrize("names", [("u", "v"), ("v", "u"), ("s", "t"), ("texture_v", "texture_u")])
def test_functions_of_such_names_stay_functions(tmp_path, scattered, names):
    pair = {name: np.arange(scattered.n_vertices) / 7 for name in names}
    mesh = Mesh(scattered.vertices, scattered.faces, pair)
    write_mesh(tmp_path / "a.ply", mesh)
    again = read_mesh(tmp_path / "a.ply")
    assert again.corner_uv is None
    assert list(again.vertex_data) == list(names)


def test_a_texture_needs_a_format_that_holds_it(tmp_path, scattered):
    with pytest.raises(UnknownNameError, match="texture"):
        write_mesh(tmp_path / "a.ply", scattered, texture=np.zeros((2, 2, 3)))


def test_meshlab_and_meshio_agree(tmp_path, scattered):
    """What MeshLab writes for wedges is read, and it reads what is written."""
    pymeshlab = pytest.importorskip("pymeshlab")
    tidy = Mesh(np.random.default_rng(1).normal(size=(40, 3)), scattered.faces)
    uv = np.random.default_rng(2).random((tidy.n_faces, 3, 2)).astype(np.float32)
    write_mesh(tmp_path / "a.ply", tidy, uv)
    theirs = pymeshlab.MeshSet()
    theirs.load_new_mesh(str(tmp_path / "a.ply"))
    found = theirs.current_mesh().wedge_tex_coord_matrix().reshape(-1, 3, 2)
    np.testing.assert_allclose(found, uv, atol=1e-7)
    for binary in (True, False):
        theirs.save_current_mesh(str(tmp_path / "b.ply"), binary=binary, save_wedge_texcoord=True)
        np.testing.assert_allclose(read_mesh(tmp_path / "b.ply").corner_uv, uv, atol=1e-6)
