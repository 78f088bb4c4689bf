import gzip
import hashlib
import io
import threading
import zipfile
import zlib
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from types import SimpleNamespace

import numpy as np
import pytest

from beltrami.batch.failures import TooLargeError
from beltrami.batch.memory import BASE
from beltrami.batch.reading import Input, _unpacked, mesh_of, read_input
from beltrami.compression.compress import compress
from beltrami.errors import FileFormatError, UnknownNameError
from beltrami.io import extras
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.io.unpacking import inflated
from beltrami.mesh.shapes import icosphere

MESH = icosphere(1)
_TRIANGLE = (np.eye(3), np.array([[0, 1, 2]]), {})


def read(place, allowed=None):
    return mesh_of(read_input(str(place), str(place), allowed), allowed)


@pytest.mark.parametrize(
    "suffix", [".ply", ".off", ".obj", ".stl", ".ply.gz", ".PLY", ".vtk", ".vtp"]
)
def test_every_format_reads_as_from_a_file(tmp_path, suffix):
    path = tmp_path / f"mesh{suffix}"
    write_mesh(path, MESH)
    given = read_input("mesh", str(path))
    assert given.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    found = mesh_of(given)
    assert found.faces.shape == MESH.faces.shape
    assert np.abs(np.sort(found.vertices, axis=0) - np.sort(MESH.vertices, axis=0)).max() < 1e-6


def test_compressed_meshes_are_read(tmp_path):
    path = tmp_path / "mesh.btm"
    compress(MESH, path)
    assert read(path).n_faces == MESH.n_faces


def test_gzip_of_several_members_with_padding(tmp_path):
    path = tmp_path / "mesh.ply.gz"
    write_mesh(tmp_path / "mesh.ply", MESH)
    content = (tmp_path / "mesh.ply").read_bytes()
    path.write_bytes(gzip.compress(content[:99]) + gzip.compress(content[99:]) + b"\0" * 9)
    assert read(path).n_faces == MESH.n_faces


class _Unpacker:
    """Decompress, and count the bytes that are handed over."""

    handed = 0

    def __init__(self, *options):
        self._real = zlib.decompressobj(*options)

    def __getattr__(self, name):
        return getattr(self._real, name)

    def decompress(self, data, most):
        _Unpacker.handed += len(data)
        return self._real.decompress(data, most)


def test_gzip_of_many_blocks_is_handed_over_about_once(tmp_path, monkeypatch):
    monkeypatch.setattr("beltrami.io.unpacking._BLOCK", 1000)
    bits = np.random.default_rng(1).integers(0, 4, 50_000, np.uint8).tobytes()
    packed = b"".join(
        gzip.compress(bits[i : i + 7000]) + b"\0" * 2500 for i in range(0, 50_000, 7000)
    )
    given = Input("a.ply.gz", ".ply", True, "", len(packed), np.frombuffer(packed, np.uint8))
    fake = SimpleNamespace(decompressobj=_Unpacker, error=zlib.error)
    monkeypatch.setattr("beltrami.io.unpacking.zlib", fake)
    monkeypatch.setattr(_Unpacker, "handed", 0)
    assert _unpacked(given.content, given, None).tobytes() == bits
    assert len(packed) / 2 < _Unpacker.handed < 5 * len(packed)
    with pytest.raises(FileFormatError, match="whole gzip file"):
        _unpacked(given.content[:-2501], given, None)


def test_a_stream_of_many_blocks_is_handed_over_about_once(monkeypatch):
    monkeypatch.setattr("beltrami.io.unpacking._BLOCK", 1000)
    bits = np.random.default_rng(1).integers(0, 4, 100_000, np.uint8).tobytes()
    packed = zlib.compress(bits)
    fake = SimpleNamespace(decompressobj=_Unpacker, error=zlib.error)
    monkeypatch.setattr("beltrami.io.unpacking.zlib", fake)
    monkeypatch.setattr(_Unpacker, "handed", 0)
    assert b"".join(inflated(packed + b"what follows" * 1000)) == bits
    assert len(packed) <= _Unpacker.handed < 5 * len(packed)
    assert len(b"".join(inflated(packed[:9000]))) < len(bits)


@pytest.mark.parametrize("cut", [1, 9, 40])
def test_a_damaged_gzip_file(tmp_path, cut):
    path = tmp_path / "mesh.ply.gz"
    path.write_bytes(gzip.compress(bytes(range(256)))[:-cut])
    with pytest.raises(FileFormatError, match="whole gzip file"):
        read(path)


def test_a_bomb_is_not_unpacked(tmp_path):
    path = tmp_path / "bomb.ply.gz"
    with gzip.open(path, "wb", compresslevel=9) as file:
        for _ in range(64):
            file.write(bytes(1 << 20))
    assert path.stat().st_size < 100_000
    with pytest.raises(TooLargeError, match=r"reading .* MB of \.ply"):
        read(path, BASE + 40_000_000)


def test_a_bomb_in_an_archive_is_not_unpacked(tmp_path, monkeypatch):
    monkeypatch.setattr("beltrami.io.unpacking.FREE", 1 << 20)
    write_mesh(tmp_path / "mesh.off", MESH)
    with zipfile.ZipFile(tmp_path / "all.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("bomb.off", bytes(4 << 20))
        archive.write(tmp_path / "mesh.off", "mesh.off")
    with pytest.raises(FileFormatError, match=r"bomb\.off.* found more: it may be a bomb"):
        read(f"zip://bomb.off::{tmp_path / 'all.zip'}")
    assert read(f"zip://mesh.off::{tmp_path / 'all.zip'}").n_faces == MESH.n_faces


def test_a_file_that_is_too_large_is_not_read(tmp_path):
    path = tmp_path / "huge.ply"
    with path.open("wb") as file:
        file.truncate(50 * 10**9)
    with pytest.raises(TooLargeError, match=r"50000 MB of \.ply is estimated to need 200\.35 GB"):
        read(path, 4 * 10**9)


def test_what_is_no_mesh(tmp_path):
    with pytest.raises(UnknownNameError):
        read(tmp_path / "a.txt")
    with pytest.raises(FileNotFoundError):
        read(tmp_path / "a.ply")
    (tmp_path / "b.ply").mkdir()
    with pytest.raises(FileFormatError, match="found a directory"):
        read(tmp_path / "b.ply")
    (tmp_path / "c.ply").write_bytes(b"")
    with pytest.raises(FileFormatError):
        read(tmp_path / "c.ply")


def test_a_member_of_an_archive(tmp_path):
    write_mesh(tmp_path / "mesh.off", MESH)
    with zipfile.ZipFile(tmp_path / "all.zip", "w") as archive:
        archive.write(tmp_path / "mesh.off", "../../up/mesh.off")
    found = read(f"zip://../../up/mesh.off::{tmp_path / 'all.zip'}")
    assert found.n_faces == MESH.n_faces
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["all.zip", "mesh.off"]


class _Serving(BaseHTTPRequestHandler):
    content = b""

    def do_HEAD(self):
        self._answer()

    def do_GET(self):
        self._answer()
        self.wfile.write(self.content)

    def _answer(self):
        self.send_response(200)
        self.send_header("Content-Length", str(len(self.content)))
        self.end_headers()

    def log_message(self, *_):
        pass


def test_a_mesh_behind_http(tmp_path):
    write_mesh(tmp_path / "mesh.ply", MESH)
    serving = type("Serving", (_Serving,), {"content": (tmp_path / "mesh.ply").read_bytes()})
    with ThreadingHTTPServer(("127.0.0.1", 0), serving) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        found = read(f"http://127.0.0.1:{server.server_port}/mesh.ply")
        server.shutdown()
    assert found.n_faces == MESH.n_faces


def test_a_source_without_a_size_is_read_to_its_end(tmp_path, monkeypatch):
    class Stream(io.BytesIO):
        def seekable(self):
            return False

    write_mesh(tmp_path / "mesh.ply", MESH)
    content = (tmp_path / "mesh.ply").read_bytes()
    monkeypatch.setattr("beltrami.batch.reading._opened", lambda place: Stream(content))
    assert read("any.ply").n_faces == MESH.n_faces
    with pytest.raises(TooLargeError):
        read("any.ply", BASE + 100)


def test_a_package_out_of_memory_does_not_blame_the_file(tmp_path, monkeypatch):
    path = tmp_path / "mesh.vtk"
    write_mesh(path, MESH)

    def full(*_):
        raise MemoryError("no room")

    monkeypatch.setitem(extras.READERS, ".vtk", full)
    with pytest.raises(MemoryError, match="no room"):
        read(path)


def test_a_broken_file_of_a_package_has_its_own_name(tmp_path):
    path = tmp_path / "broken.vtk"
    path.write_bytes(b"nothing")
    with pytest.raises(FileFormatError) as error:
        read(path)
    assert error.value.path == str(path)


def test_what_is_compressed_twice_has_the_room_of_the_file(tmp_path, monkeypatch):
    pytest.importorskip("meshio")
    rooms = []
    monkeypatch.setattr("beltrami.io.unpacking.FREE", 1)
    monkeypatch.setitem(
        extras.READERS, ".vtk", lambda _, room: (rooms.append(room.most), *_TRIANGLE)[1:]
    )
    path = tmp_path / "mesh.vtk.gz"
    path.write_bytes(gzip.compress(bytes(range(50)) * 90))
    assert read(path).n_faces == 1
    assert read_mesh(path).n_faces == 1
    assert rooms == [100 * path.stat().st_size] * 2
