"""What is fuzzed: each reader of ours, by its format, from bytes in memory or in a file."""

from __future__ import annotations

import tempfile
from functools import partial
from pathlib import Path

import numpy as np

from beltrami.compression.contents import describe
from beltrami.compression.decompress import decompress
from beltrami.errors import FileFormatError
from beltrami.io.function import read_function
from beltrami.io.registry import READERS, read_mesh
from beltrami.io.source import Source
from beltrami.spectrum.load_basis import load_basis

CORPUS = Path(__file__).parent / "corpus"
_MOST = 100_000  # vertices that a compressed file may declare


def _of_mesh(suffix):
    def read(data):
        mesh = READERS[suffix](Source(f"fuzz{suffix}", np.frombuffer(data, np.uint8)))
        assert np.isfinite(mesh.vertices).all()
        assert mesh.n_faces == 0 or (mesh.faces.min() >= 0 and mesh.faces.max() < mesh.n_vertices)

    return read


def _of_file(suffix, reader):
    def read(data):
        with tempfile.NamedTemporaryFile(suffix=suffix) as file:
            file.write(data)
            file.flush()
            values = reader(file.name)
            assert values is not None

    return read


def _packed(suffix):
    """Read a file that is compressed, or whose numbers are, by its name."""
    return _of_file(suffix, partial(read_mesh, max_bytes=1 << 20))


def _compressed(data):
    mesh = decompress(data, max_vertices=_MOST)
    assert np.isfinite(mesh.vertices).all()
    describe(data)


TARGETS = {
    "obj": _of_mesh(".obj"),
    "off": _of_mesh(".off"),
    "ply": _of_mesh(".ply"),
    "stl": _of_mesh(".stl"),
    "btm": _compressed,
    "csv": _of_file(".csv", read_function),
    "npy": _of_file(".npy", read_function),
    "npz": _of_file(".npz", load_basis),
    "gz": _packed(".off.gz"),
    "gii": _packed(".gii"),
    "vtu": _packed(".vtu"),
    "vtp": _packed(".vtp"),
}


def outcome(name, data):
    """Read, and say what came of it. Anything but a FileFormatError is a mistake of ours."""
    try:
        TARGETS[name](data)
    except FileFormatError as error:
        return error.problem
    return "read"


def corpus(name):
    """The inputs that are kept for a format."""
    return [path.read_bytes() for path in sorted((CORPUS / name).iterdir())]


WORDS = [
    b"nan", b"inf", b"-1", b"1e999", b"4294967295", b"99999999999999999999", b"0", b"3", b"/",
    b"//", b"\\\n", b"#", b"\n", b"\r\n", b" ", b"\t", b",", b"\x00", b"\xff",
    b"\xff\xff\xff\xff", b"\x00\x00\xc0\x7f", b"f 1 2 3\n", b"f -1 -2 -3\n", b"v 1 2 3\n",
    b"vt 0 1\n", b"vn 0 0 1\n", b"OFF\n", b"ST", b"C", b"N", b"4", b"n", b"BINARY",
    b"end_header\n", b"property list uchar int ", b"property double ", b"element face 1\n",
    b"element vertex 3\n", b"comment ", b"tristrips", b"format ascii 1.0\n",
    b"format binary_little_endian 1.0\n", b"vertex_indices\n", b"solid ", b"facet", b"vertex ",
    b"endsolid", b"1e-400", b"0x1p3", b"1d5", b"+.5", b"\x1f\x8b", b"<Piece ", b"</Polys>",
    b'format="appended" offset="0"',
]  # fmt: skip


def mutated(rng, inputs):
    """Change one input in up to five places, or splice two."""
    data = bytearray(inputs[rng.integers(len(inputs))])
    if rng.random() < 0.1:
        other = inputs[rng.integers(len(inputs))]
        data = data[: rng.integers(len(data) + 1)] + other[rng.integers(len(other) + 1) :]
    for _ in range(rng.integers(1, 6)):
        place, size = int(rng.integers(len(data) + 1)), int(rng.integers(1, 9))
        match rng.integers(7):
            case 0:
                data[place : place + 1] = rng.bytes(1)
            case 1:
                del data[place : place + size]
            case 2:
                data[place:place] = WORDS[rng.integers(len(WORDS))]
            case 3:
                data[place : place + size] = WORDS[rng.integers(len(WORDS))]
            case 4:
                data[place:place] = data[place : place + 4 * size]
            case 5 if place < len(data):
                data[place] ^= 1 << int(rng.integers(8))
            case 6 if rng.random() < 0.2:
                del data[place:]
    return bytes(data)
