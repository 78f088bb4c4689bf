"""VTK's XML files of surfaces: those of VTK itself in all its ways, our own, and broken ones."""

import base64
import gzip
import re
from pathlib import Path

import numpy as np
import pytest

import beltrami as bt
from beltrami.errors import FileFormatError, MeshError
from beltrami.io import unpacking
from beltrami.io.source import Source
from beltrami.io.unpacking import Room
from beltrami.io.vtk_packing import lz4_block
from beltrami.io.vtp import read_vtp

WRITTEN = sorted((Path(__file__).parent / "vtp").iterdir())  # by VTK 9.7
POINTS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.1], [2, 0, 0.25]]
UV = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.25]])
NAME = "height of it é"


def text(points="0 0 0 1 0 0 0 1 0", faces="0 1 2", ends="3", data="", **changed):
    """Return a file with one triangle, or what is made of it."""
    told = {"count": "3", "polys": "1", "part": "Polys", "type": "PolyData", "width": "3"} | changed
    whole = (
        f'<VTKFile type="{told["type"]}"><PolyData>'
        f'<Piece NumberOfPoints="{told["count"]}" NumberOf{told["part"]}="{told["polys"]}"><Points>'
        f'<DataArray type="Float64" NumberOfComponents="{told["width"]}">{points}</DataArray>'
        f"</Points>{data}<{told['part']}>"
        f'<DataArray type="Int32" Name="connectivity">{faces}</DataArray>'
        f'<DataArray type="UInt8" Name="offsets">{ends}</DataArray>'
        f"</{told['part']}></Piece></PolyData></VTKFile>"
    )
    return whole.encode()


@pytest.mark.parametrize("path", WRITTEN, ids=lambda path: path.stem)
def test_all_that_vtk_writes_is_read(path):
    mesh = bt.read_mesh(path)
    np.testing.assert_array_equal(mesh.vertices, POINTS)
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [1, 4, 2]]
    assert list(mesh.vertex_data) == [NAME, "n", "id"]  # no texts, nothing of the cells
    np.testing.assert_array_equal(mesh.vertex_data[NAME], [0, 1, 2, np.nan, 4])
    assert mesh.vertex_data["n"].tolist() == [[0, 0, 1]] * 5
    assert mesh.vertex_data["n"].dtype == np.float32
    assert mesh.vertex_data["id"].tolist() == [2**40 + k for k in (4, 3, 2, 1, 0)]
    assert mesh.vertex_data["id"].dtype == np.int64
    np.testing.assert_array_equal(mesh.corner_uv, UV[mesh.faces])


def test_there_and_back_bit_for_bit(tmp_path, scattered):
    data = {**scattered.vertex_data, "a<&>\"'\t\r\n": np.arange(40), "b": np.arange(40) % 3 == 0}
    mesh = bt.Mesh(scattered.vertices, scattered.faces, data)
    for name in ("a.vtp", "b.VTP", "c.vtp.gz"):
        bt.write_mesh(tmp_path / name, mesh)
        again = bt.read_mesh(tmp_path / name)
        assert again.vertices.tobytes() == mesh.vertices.tobytes()
        np.testing.assert_array_equal(again.faces, mesh.faces)
        assert list(again.vertex_data) == list(data)
        for key, array in data.items():
            kept = again.vertex_data[key]
            assert kept.dtype == (np.uint8 if array.dtype == bool else array.dtype)
            np.testing.assert_array_equal(kept.reshape(array.shape), array)


@pytest.mark.parametrize("kind", ["?", "u1", "i2", "i8", "u8", "f2", "f4", "f8", "g", ">f4"])
def test_functions_of_every_type_come_back(tmp_path, kind):
    f = np.array([0, 1, 0, 1.0, 1]).astype(kind)
    mesh = bt.Mesh(POINTS, [[0, 1, 2]], {"f": f, "F": np.stack([f, f, f], 1)})
    bt.write_mesh(tmp_path / "a.vtp", mesh)
    data = bt.read_mesh(tmp_path / "a.vtp").vertex_data
    np.testing.assert_array_equal(data["f"], f)
    np.testing.assert_array_equal(data["F"], np.stack([f, f, f], 1))


def test_texture_coordinates_where_each_vertex_has_one_pair(tmp_path):
    faces = np.array([[0, 1, 2], [0, 2, 3]])  # nothing at the vertex 4
    taken = {"texture coordinates": np.arange(5.0)}
    bt.write_mesh(tmp_path / "a.vtp", bt.Mesh(POINTS, faces, taken, UV[faces]))
    again = bt.read_mesh(tmp_path / "a.vtp")
    np.testing.assert_array_equal(again.corner_uv, UV[faces])
    np.testing.assert_array_equal(again.vertex_data["texture coordinates"], np.arange(5))
    seam = UV[faces].copy()
    seam[0, 0] += 1
    bt.write_mesh(tmp_path / "b.vtp", bt.Mesh(POINTS, faces, None, seam))
    assert bt.read_mesh(tmp_path / "b.vtp").corner_uv is None


def test_names_and_columns_that_xml_does_not_hold_are_refused(tmp_path):
    for name, columns in (("", 1), ("a\0", 1), ("\x1b", 1), ("\ud800", 1), ("\ufffe", 1), ("f", 0)):
        with pytest.raises(MeshError, match=r"name of vertex data|functions of 0 columns"):
            bt.write_mesh(
                tmp_path / "a.vtp", bt.Mesh(POINTS, [[0, 1, 2]], {name: np.zeros((5, columns))})
            )
    assert not list(tmp_path.iterdir())


def test_strips(put):
    mesh = bt.read_mesh(
        put("a.vtp", text("0 0 0 1 0 0 0 1 0 1 1 0", "0 1 2 3 2 1 0", "4 7", count=4, polys=2,
                          part="Strips"))
    )  # fmt: skip
    assert mesh.faces.tolist() == [[0, 1, 2], [2, 1, 3], [2, 1, 0]]


def test_pieces_side_by_side(put):
    def data(more, width=1):
        return (
            f'<PointData><DataArray type="Int8" Name="f">1 2 3</DataArray><DataArray type="Int8" '
            f'NumberOfComponents="{width}" Name="g">{"1 2 3 " * width}</DataArray>{more}'
            "</PointData>"
        )

    extra = '<DataArray type="Float32" Name="alone">1 2 3</DataArray>'
    first, second = text(data=data(extra)), text("0 0 1 1 0 1 0 1 1", data=data("", 2))
    start, end = second.index(b"<Piece"), second.index(b"</PolyData>")
    mesh = bt.read_mesh(
        put("a.vtp", first.replace(b"</PolyData>", second[start:end] + b"</PolyData>"))
    )
    assert mesh.faces.tolist() == [[0, 1, 2], [3, 4, 5]]
    assert mesh.vertices[:, 2].tolist() == [0, 0, 0, 1, 1, 1]
    assert {name: f.tolist() for name, f in mesh.vertex_data.items()} == {"f": [1, 2, 3, 1, 2, 3]}


def test_texture_coordinates_of_three_dimensions_are_left_out(put):
    data = (
        '<PointData TCoords="t"><DataArray type="Float32" Name="t" NumberOfComponents="3">'
        "0 0 0 1 0 0 0 1 0</DataArray></PointData>"
    )
    mesh = bt.read_mesh(put("a.vtp", text(data=data)))
    assert mesh.corner_uv is None
    assert not mesh.vertex_data


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (text(type="UnstructuredGrid"), "the type PolyData, found 'UnstructuredGrid'"),
        (b"<html></html>", "the element VTKFile"),
        (text()[:-5], "line 1: expected XML"),
        (text("0 0 0 1 x 0 0 1 0"), "9 numbers in the array 'DataArray', found 'x' after 4"),
        (text("0 0 0 1 0 0 0 1 0 7"), "found '7' after 9"),
        (text("0 0 0"), "9 numbers"),
        (text("nan 0 0 1 0 0 0 1 0"), "NaN in vertex 0"),
        (text(count="3x"), "a count as NumberOfPoints of Piece, found '3x'"),
        (text(count="9" * 30), "found fewer"),
        (text(width=2), "3 as NumberOfComponents"),
        (text(faces="0 1 3"), "indices of points, 0..2, in the Polys"),
        (text(faces="0 1 -1"), "indices of points"),
        (text(faces="0 1 .5"), "whole numbers of int32"),
        (text(faces="0 1 2").replace(b'"Int32" Name="c', b'"Float32" Name="c'),
         "whole numbers as offsets and connectivity of Polys"),
        (text(faces="0 1"), "3 numbers in the array 'connectivity'"),
        (text(ends="2"), "three corners or more in each of the Polys"),
        (text(ends="3 1", polys=2), "three corners or more"),
        (text(ends="300"), "whole numbers of uint8"),
        (text().replace(b"connectivity", b"c"), "the arrays offsets and connectivity in Polys"),
        (text(polys=0), "triangles or polygons, found none"),
        (text().replace(b"Piece", b"Part"), "a Piece of PolyData, found none"),
        (re.sub(rb"<Points>.*</Points>", b"", text()), "3 points, found none"),
        (text().replace(b"Float64", b"Float16"), "one of Int8, UInt8"),
        (text().replace(b'"Float64"', b'"Float64" format="hex"'), "found the format 'hex'"),
        (text().replace(b'e="Poly', b'e="Poly', 1).replace(b"<VTKFile", b'<VTKFile byte_order="?"'),
         "one of LittleEndian, BigEndian, found '?'"),
        (text().replace(b"<VTKFile", b'<VTKFile compressor="gzip"'), "no compressor 'gzip' of VTK"),
        (text().replace(b"</VTKFile>", b'<AppendedData encoding="raw">_'), "file is cut off"),
        (text().replace(b"</VTKFile>", b"<AppendedData>_</AppendedData>"), "base64 or raw"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(content, told, put):
    with pytest.raises(FileFormatError, match=re.escape(told)) as caught:
        bt.read_mesh(put("a.vtp", content))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("path", WRITTEN, ids=lambda path: path.stem)
def test_every_cut_and_changed_bytes_are_a_mesh_or_one_clear_line(path):
    whole = path.read_bytes()
    rng = np.random.default_rng(11)
    broken = [whole[:end] for end in range(0, len(whole), 61)]
    for _ in range(150):
        changed = bytearray(whole)
        for place in rng.integers(60, len(whole), 2):
            changed[place] = rng.integers(256)
        broken.append(bytes(changed))
    refused = []
    for data in broken:
        try:
            read_vtp(Source("a.vtp", np.frombuffer(data, np.uint8)), Room("a.vtp", 1 << 16))
        except FileFormatError as error:
            refused.append(str(error))
    assert 0 < len(refused) < len(broken)
    assert not any("\n" in line for line in refused)


def packed(values, compress, blocks=1, raw=False):
    """Return an array as VTK writes it in a file whose heads have 32 bits."""
    data = np.asarray(values).tobytes()
    size = -(-len(data) // blocks)
    parts = [data[at : at + size] for at in range(0, len(data), size)]
    made = [compress(part) for part in parts]
    last = len(parts[-1]) % size
    head = np.array([len(parts), size, last, *map(len, made)], "<u4").tobytes()
    return (
        head + b"".join(made) if raw else base64.b64encode(head) + base64.b64encode(b"".join(made))
    )


def one_array(values, compressor, content, count=None):
    """Return a file whose points are compressed."""
    count = len(values) if count is None else count
    whole = text("POINTS", count=count).decode()
    whole = whole.replace("<VTKFile", f'<VTKFile compressor="vtk{compressor}DataCompressor"')
    whole = whole.replace('NumberOfComponents="3">', 'NumberOfComponents="3" format="binary">')
    return whole.encode().replace(b"POINTS", content)


def lz4(data):
    """Compress by LZ4, greedily: a copy wherever the four bytes to come were there before."""
    out, begin, k, seen = bytearray(), 0, 0, {}

    def write(literals, back, length):
        extra = [len(literals), length - 4 if length else 0]
        out.append(min(extra[0], 15) << 4 | min(extra[1], 15))
        for part, more in enumerate(extra):
            if part == 0 or length:
                if part:
                    out.extend(back.to_bytes(2, "little"))
                if more >= 15:
                    out.extend(b"\xff" * ((more - 15) // 255) + bytes([(more - 15) % 255]))
                if not part:
                    out.extend(literals)

    while k + 12 < len(data):
        place = seen.get(data[k : k + 4], -1)
        seen[data[k : k + 4]] = k
        if place < 0 or k - place > 65535:
            k += 1
            continue
        length = 4
        while k + length < len(data) - 5 and data[place + length] == data[k + length]:
            length += 1
        write(data[begin:k], k - place, length)
        k = begin = k + length
    write(data[begin:], 0, 0)
    return bytes(out)


def test_lz4_gives_back_what_was_compressed():
    rng = np.random.default_rng(5)
    for size in (1, 12, 13, 14, 300, 20_000):
        for letters in (1, 2, 20, 256):
            data = rng.integers(0, letters, size, dtype=np.uint8).tobytes()
            block = lz4(data)
            assert lz4_block(block, size) == data
            for wrong in (size - 1, size + 1, 10**15):
                with pytest.raises(ValueError, match="a block"):
                    lz4_block(block, wrong)
    assert len(block) > 20_000 > 200 * len(lz4(bytes(20_000)))


@pytest.mark.parametrize(
    "block", [b"", b"\x10", b"\x40abc", b"\x10a\x00\x00", b"\x10a\x02\x00", b"\x10a\x01", b"\xf0"]
)
def test_no_block_of_lz4(block):
    with pytest.raises(ValueError, match="a block"):
        lz4_block(block, 5)


def compressors():
    import lzma
    import zlib

    return {"ZLib": zlib.compress, "LZMA": lzma.compress, "LZ4": lz4}


@pytest.mark.parametrize("name", compressors())
def test_many_blocks(put, name):
    x = np.random.default_rng(3).integers(0, 9, (200, 3)) / 8
    for blocks in (1, 2, 7):
        content = packed(x, compressors()[name], blocks)
        mesh = bt.read_mesh(put("a.vtp", one_array(x, name, content)))
        np.testing.assert_array_equal(mesh.vertices, x)
        with pytest.raises(FileFormatError, match="its head says"):
            bt.read_mesh(put("b.vtp", one_array(x, name, content, count=201)))


@pytest.mark.parametrize("name", compressors())
def test_a_bomb_ends_early(put, name, monkeypatch):
    monkeypatch.setattr(unpacking, "FREE", 1 << 14)
    monkeypatch.setattr(unpacking, "RATIO", 2)
    many = np.zeros((20_000, 3))
    path = put("a.vtp", one_array(many, name, packed(many, compressors()[name])))
    assert path.stat().st_size < 1 << 14
    with pytest.raises(FileFormatError, match="found more: it may be a bomb") as error:
        bt.read_mesh(path)
    assert error.value.path == str(path)
    assert len(bt.read_mesh(path, max_bytes=1 << 23).vertices) == 20_000
    few = np.zeros((3, 3))  # the block becomes more than its head says
    liar = packed(few, lambda _: compressors()[name](many.tobytes()))
    with pytest.raises(FileFormatError, match="a block"):
        bt.read_mesh(put("b.vtp", one_array(few, name, liar)))


def test_many_arrays_at_one_place_are_a_bomb(put):
    """Each array is no longer than the file, and so all of them together."""
    n = 2000
    array = '<DataArray type="Float64" Name="f{}" format="appended" offset="0"/>'
    data = "".join(array.format(k) for k in range(10))
    whole = text("0 " * 3 * n, data=f"<PointData>{data}</PointData>", count=n).decode()
    content = np.array([8 * n], "<u4").tobytes() + np.ones(n).tobytes()
    head, _ = whole.split("</VTKFile>")
    tail = b'<AppendedData encoding="raw">_' + content + b"</AppendedData></VTKFile>"
    path = put("a.vtp", head.encode() + tail)
    assert bt.read_mesh(path).vertex_data["f9"].tolist() == [1] * n
    with pytest.raises(FileFormatError, match="it may be a bomb"):
        bt.read_mesh(path, max_bytes=100_000)


def test_entities_that_stand_for_a_gigabyte(put):
    entities = "".join(
        f'<!ENTITY {b} "{10 * f"&{a};"}">' for a, b in zip("abcdefgh", "bcdefghi", strict=True)
    )
    head = f"<!DOCTYPE VTKFile [<!ENTITY a '0 1 2 3 4 5 6 7 8 9 '>{entities}]>".encode()
    with pytest.raises(FileFormatError, match="amplification"):
        bt.read_mesh(put("a.vtp", head + text("&i;")))


def test_it_may_be_compressed_as_a_whole(put):
    content = gzip.compress(WRITTEN[0].read_bytes())
    assert bt.read_mesh(put("a.vtp.gz", content)).n_faces == 3
