"""Damaged files give FileFormatError or a mesh, and nothing else."""

from __future__ import annotations

import gzip

import numpy as np
import pytest

from beltrami.errors import FileFormatError
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.mesh import Mesh

WORDS = [b"nan", b"-1", b"1e999", b"4294967295", b"/", b"\\\n", b"#", b"\n", b"\r", b"\0", b"\xff"]
WORDS += [b"99999999999999999999", b"f 1 2 3\n", b"v 1 2 3\n", b"end_header\n", b"list ", b"OFF "]
TEXT_PLY = (
    b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    b"property float z\nproperty uchar red\nelement face 2\n"
    b"property list uchar int vertex_indices\n"
    b"end_header\n0 0 0 1\n1 0 0 2\n1 1 0 3\n0 1 0 4\n3 0 1 2\n4 0 1 2 3\n"
)
STRIPS = TEXT_PLY.replace(b"face 2", b"tristrips 1").replace(b"3 0 1 2\n4 0 1 2 3", b"5 0 1 2 -1 3")
TEXT_STL = (
    b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    b"endfacet\nendsolid a\n"
)


def damaged(whole: bytes, rng: np.random.Generator) -> bytes:
    data = bytearray(whole)
    for _ in range(rng.integers(1, 4)):
        place = int(rng.integers(0, len(data) + 1))
        match rng.integers(0, 5):
            case 0:
                data[place : place + 1] = rng.bytes(1)
            case 1:
                del data[place : place + int(rng.integers(1, 9))]
            case 2:
                data[place:place] = WORDS[rng.integers(len(WORDS))]
            case 3:
                data[place : place + 3] = WORDS[rng.integers(len(WORDS))]
            case _:
                del data[place:]
    return bytes(data)


KINDS = (".obj", ".off", ".ply", ".stl", "t.ply", "s.ply", "t.stl", ".off.gz")


@pytest.mark.parametrize("suffix", KINDS)
@pytest.mark.parametrize(
    ("seed", "rounds"),
    [(58_290_117, 1500), pytest.param(7_710_223, 40_000, marks=pytest.mark.heavy)],
)
def test_damaged_files(tmp_path, scattered, suffix, seed, rounds):
    path = tmp_path / f"a{suffix}"
    if suffix == ".obj":
        write_mesh(
            path,
            Mesh(scattered.vertices[:9], [[0, 1, 2], [3, 4, 8]], None, scattered.corner_uv[:2]),
        )
    elif suffix[0] == ".":
        write_mesh(path, Mesh(scattered.vertices[:9] * 1e-30, [[0, 1, 2], [3, 4, 8]]))
    else:
        path.write_bytes({"t.ply": TEXT_PLY, "s.ply": STRIPS, "t.stl": TEXT_STL}[suffix])
    whole = path.read_bytes()
    rng = np.random.default_rng(seed)
    refused = 0
    for _ in range(rounds):
        path.write_bytes(damaged(whole, rng))
        try:
            mesh = read_mesh(path)
        except FileFormatError:
            refused += 1
        else:
            assert np.isfinite(mesh.vertices).all()
            assert mesh.faces.min() >= 0
            assert mesh.faces.max() < mesh.n_vertices
    assert refused > 100


@pytest.mark.parametrize("suffix", [".obj", ".off", ".ply", ".stl", ".off.gz"])
def test_noise(tmp_path, suffix):
    rng = np.random.default_rng(13_377_904)
    heads = {
        ".off": b"OFF\n3 1 0\n",
        ".ply": TEXT_PLY[:201],
        ".stl": b"solid\n",
        ".obj": b"v 0 0 0\n",
    }
    path = tmp_path / f"a{suffix}"
    for i in range(300):
        noise = rng.bytes(rng.integers(0, 300))
        content = heads.get(suffix, b"") + noise if i % 2 else noise
        path.write_bytes(gzip.compress(content) if suffix.endswith("gz") and i % 2 else content)
        with pytest.raises(FileFormatError):
            read_mesh(path)
