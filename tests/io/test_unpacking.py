"""What is compressed may not unpack to more than its size allows: bombs end early, and small."""

import base64
import gzip
import lzma
import re
import tracemalloc
import zlib
from functools import partial
from itertools import pairwise

import numpy as np
import pytest

from beltrami.errors import FileFormatError, MeshError
from beltrami.io import unpacking
from beltrami.io.function import read_function
from beltrami.io.packed_inside import require_room
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.shapes import icosphere

MEGA = 1 << 20
MESH = icosphere(1)
MESHES = (".obj.gz", ".off.gz", ".ply.gz", ".stl.gz", ".gii.gz", ".vtk.gz", ".pial.gz", ".glb.gz")
FUNCTIONS = (".csv.gz", ".npy.gz", ".ply.gz", ".curv.gz", ".gii.gz", ".mgz")


@pytest.fixture
def small(monkeypatch):
    """Let every file unpack to a megabyte, and ten times its size."""
    monkeypatch.setattr(unpacking, "FREE", MEGA)
    monkeypatch.setattr(unpacking, "RATIO", 10)


def bomb(megabytes):
    """Return a file of a thousandth of what it unpacks to."""
    return gzip.compress(bytes(MEGA)) * megabytes


def refused(read, path, why="when it is unpacked, found more"):
    """Read a file, and return the peak of memory of being refused."""
    tracemalloc.start()
    try:
        with pytest.raises(FileFormatError, match=why) as error:
            read(path)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert error.value.path == str(path)
    return peak


@pytest.mark.parametrize("suffix", MESHES)
def test_a_bomb_is_no_mesh(put, small, suffix):
    path = put(f"a{suffix}", bomb(64))
    assert path.stat().st_size < MEGA / 10
    assert refused(read_mesh, path) < 8 * MEGA


@pytest.mark.parametrize("suffix", FUNCTIONS)
def test_a_bomb_is_no_function(put, small, suffix):
    pytest.importorskip("nibabel")
    assert refused(read_function, put(f"a{suffix}", bomb(64))) < 8 * MEGA


def test_each_byte_may_unpack_to_a_hundred():
    room = unpacking.room_of("a.off.gz", 10**8)
    room.take(10**10)
    with pytest.raises(FileFormatError, match="bomb"):
        room.take(1)
    room = unpacking.room_of("a.off.gz", 10)
    room.take(MEGA << 8)
    with pytest.raises(FileFormatError, match="bomb"):
        room.take(1)


def test_the_limit_can_be_chosen(tmp_path):
    path = tmp_path / "a.ply.gz"
    write_mesh(path, MESH)
    size = len(gzip.decompress(path.read_bytes()))
    assert read_mesh(path, max_bytes=size).n_faces == MESH.n_faces
    with pytest.raises(FileFormatError, match=f"at most {size - 1} bytes"):
        read_mesh(path, max_bytes=size - 1)
    np.savetxt(tmp_path / "f.csv.gz", np.arange(9.0))
    assert len(read_function(tmp_path / "f.csv.gz", max_bytes=9 * 25)) == 9
    with pytest.raises(FileFormatError, match="max_bytes"):
        read_function(tmp_path / "f.csv.gz", max_bytes=9 * 25 - 1)
    for wrong in (0, -1, 0.5, "1", np.nan, True):
        with pytest.raises(MeshError, match="max_bytes"):
            read_mesh(path, max_bytes=wrong)


def test_formats_of_packages_are_read_from_gzip(tmp_path):
    pytest.importorskip("meshio")
    write_mesh(tmp_path / "a.vtk", MESH)
    path = tmp_path / "b.vtk.gz"
    path.write_bytes(gzip.compress((tmp_path / "a.vtk").read_bytes()))
    assert np.array_equal(read_mesh(path).vertices, MESH.vertices)


def gifti(tmp_path, content, dims=(42, 3)):
    """Write a GIFTI file whose points have these bytes, compressed."""
    path = tmp_path / "a.gii"
    write_mesh(path, MESH)
    text = path.read_text()
    start = text.index("<Data>") + len("<Data>")
    packed = base64.b64encode(zlib.compress(content)).decode()
    text = text[:start] + packed + text[text.index("</Data>") :]
    for i, size in enumerate(dims):
        text = text.replace(f'Dim{i}="{(42, 3)[i]}"', f'Dim{i}="{size}"', 1)
    path.write_text(text)
    return path


def test_gifti_that_is_compressed_inside(tmp_path, small):
    pytest.importorskip("nibabel")
    points = MESH.vertices.astype(np.float32)
    assert np.array_equal(read_mesh(gifti(tmp_path, points.tobytes())).vertices, points)
    liar = gifti(tmp_path, bytes(4 * MEGA))
    with pytest.raises(FileFormatError, match="at most 1008 bytes in an array, as it says"):
        read_mesh(liar)
    honest = gifti(tmp_path, bytes(4 * MEGA), (4 * MEGA // 12, 3))
    assert refused(read_mesh, honest) < 8 * MEGA
    assert refused(read_function, honest) < 8 * MEGA


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('Encoding="GZipBase64Binary"', ""),  # what it is then, too
        ("<Data>", "<Data><MetaData/>"),
        ("<Data>", "<Data>eJwDAAAAAAE=</Data><Data>"),
    ],
)
def test_gifti_cannot_hide_what_is_compressed(tmp_path, small, before, after):
    pytest.importorskip("nibabel")
    path = gifti(tmp_path, bytes(4 * MEGA), (4 * MEGA // 12, 3))
    text = path.read_text()
    assert before in text
    path.write_text(text.replace(before, after, 1))
    for read in (read_mesh, read_function):
        with pytest.raises(FileFormatError, match=r"found more: it may be a bomb|MetaData in Data"):
            read(path)


def vtu(tmp_path, compression, points):
    """Write a VTU file, with these points instead of its own."""
    import meshio

    found = meshio.Mesh(points, [("triangle", np.array(MESH.faces))])
    meshio.vtu.write(tmp_path / "a.vtu", found, compression=compression)
    return tmp_path / "a.vtu"


def appended(path, raw):
    """Move the arrays of a VTU file to its end, as ParaView does."""
    text, pieces, at = path.read_text(), [], 0

    def moved(found):
        nonlocal at
        given = found[2].strip()
        head = base64.b64decode(given[:8])
        sizes = 12 + 4 * int.from_bytes(head[:4], "little")
        letters = 4 * -(-sizes // 3)
        blocks = base64.b64decode(given[:letters]) + base64.b64decode(given[letters:])
        pieces.append(blocks if raw else given.encode())
        offset, at = at, at + len(pieces[-1])
        return f'{found[1].replace("binary", "appended")} offset="{offset}"/>'

    text = re.sub(r"(<DataArray[^>]*format=\"binary\"[^>]*)>([^<]*)</DataArray>", moved, text)
    kind = "raw" if raw else "base64"
    head, end = text.split("</VTKFile>")
    start = f'{head}<AppendedData encoding="{kind}">_'.encode()
    path.write_bytes(start + b"".join(pieces) + b"\n</AppendedData></VTKFile>" + end.encode())
    return path


@pytest.mark.parametrize("compression", ["zlib", "lzma"])
@pytest.mark.parametrize("place", ["inline", "base64", "raw"])
def test_vtu_that_is_compressed_inside(tmp_path, small, compression, place, monkeypatch):
    pytest.importorskip("meshio")
    fast = partial(lzma.compress, preset=0)
    monkeypatch.setattr(lzma, "compress", fast)

    def written(points):
        path = vtu(tmp_path, compression, points)
        return path if place == "inline" else appended(path, place == "raw")

    assert np.array_equal(read_mesh(written(MESH.vertices)).vertices, MESH.vertices)
    many = np.zeros((16 * MEGA // 24, 3))
    assert refused(read_mesh, written(many)) < 8 * MEGA


def test_lzma_streams_are_bounded_in_memory():
    from beltrami.io.packed_inside import one_stream

    assert b"".join(one_stream(lzma.compress(b"ab" * MEGA))) == b"ab" * MEGA
    assert b"".join(one_stream(lzma.compress(bytes(9))[:-1])) in (b"", bytes(9))  # and it ends


def hidden(head):
    """Return a VTU file of which one array has this head in 8 bytes each, and a bomb."""
    packed = zlib.compress(bytes(4 * MEGA))
    sizes = np.array([1, 0, 0, len(packed)], head)
    text = (base64.b64encode(sizes.tobytes()) + base64.b64encode(packed)).decode()
    return (
        '<VTKFile type="UnstructuredGrid" version="0.1" header_type="UInt64" '
        'byte_order="LittleEndian" compressor="vtkZLibDataCompressor"><UnstructuredGrid>'
        '<Piece NumberOfPoints="1" NumberOfCells="0"><Points><DataArray type="Float64" '
        f'NumberOfComponents="3" format="binary">{text}</DataArray></Points></Piece>'
        "</UnstructuredGrid></VTKFile>"
    )


def test_vtu_cannot_hide_what_is_compressed(put, small):
    pytest.importorskip("meshio")
    whole = hidden("<u8")
    assert refused(read_mesh, put("a.vtu", whole)) < 8 * MEGA
    text = whole.partition('format="binary">')[2].partition("<")[0]
    at, rest = text[:44], text[44:]
    appended = whole.replace(f'format="binary">{text}', 'format="appended" offset="OFF">')
    tail = f'<AppendedData encoding="base64" xencoding="raw">_{text}</AppendedData></VTKFile>'
    nested = "<DataArray><AppendedData>_AAAA</AppendedData></DataArray></Points>"
    for other in (
        whole.replace("UInt64", "Int64"),
        whole.replace(text, at + "!" * len(text) + rest),
        appended.replace("OFF", "0").replace("</VTKFile>", tail),
        appended.replace("OFF", "0").replace("</Points>", nested).replace("</VTKFile>", tail),
        appended.replace("OFF", f"-{len(text)}").replace("</VTKFile>", tail),
    ):
        path = put("a.vtu", other)
        with pytest.raises(FileFormatError):
            require_room(path, ".vtu", unpacking.room_of(path, path.stat().st_size))


@pytest.mark.parametrize("suffix", ["vtu", "gii"])
def test_entities_that_stand_for_a_gigabyte(put, suffix):
    """Ten of ten, nine times over: it is refused before it has become that."""
    pytest.importorskip({"vtu": "meshio", "gii": "nibabel"}[suffix])
    names = "abcdefghi"
    entities = ['<!ENTITY a "0 1 2 3 4 5 6 7 8 9 ">']
    entities += [f'<!ENTITY {b} "{10 * f"&{a};"}">' for a, b in pairwise(names)]
    kind = {"vtu": "VTKFile", "gii": "GIFTI"}[suffix]
    head = f"<?xml version='1.0'?><!DOCTYPE {kind} [{''.join(entities)}]>"
    body = {
        "vtu": hidden("<u8").replace('format="binary">', 'format="ascii">&i;'),
        "gii": "<GIFTI Version='1.0' NumberOfDataArrays='1'><DataArray>&i;</DataArray></GIFTI>",
    }[suffix]
    assert refused(read_mesh, put(f"a.{suffix}", head + body), "amplification") < 64 * MEGA


def test_lzma_has_no_second_stream():
    from beltrami.io.packed_inside import one_stream

    with pytest.raises(ValueError, match="follows the stream"):
        list(one_stream(lzma.compress(b"a") + lzma.compress(bytes(MEGA))))
