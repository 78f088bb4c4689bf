"""Bytes that nobody wrote: a mesh, or FileFormatError, and never anything else."""

import functools
import hashlib
import zlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import beltrami as bt
from beltrami.compression import grid
from beltrami.compression.container import (
    CONNECTIVITY,
    GRID,
    KEEPS_ORDER,
    PREDICTS,
    PROGRESSIVE,
    SPECTRUM,
    Section,
    pack,
    unpack,
)
from beltrami.compression.contents import describe
from beltrami.compression.grid import PositionGrid
from beltrami.compression.spectral_head import SpectralHead
from beltrami.compression.varint import Reader, to_varints
from beltrami.errors import FileFormatError
from beltrami.mesh.mesh import Mesh

LIMIT = 3000


@functools.cache
def files():
    """Small files with everything in them."""
    cylinder = bt.shapes.cylinder(8, 4)
    rng = np.random.default_rng(0)
    full = Mesh(
        cylinder.vertices,
        np.concatenate([cylinder.faces, cylinder.faces[:3], [[0, 0, 1], [2, 4, 9]]]),
        {"f": rng.normal(size=cylinder.n_vertices)},
        rng.normal(size=(cylinder.n_faces + 5, 3, 2)),
    )
    plane = bt.shapes.disk(3)
    heights = plane.vertices[:, 0]
    colours = {"c": np.rint(99 + 9 * plane.vertices).astype("u1"), "h": heights.astype("f4")}
    painted = Mesh(
        plane.vertices, plane.faces, colours | {"d": heights.copy()}, plane.vertices[plane.faces]
    )
    return [
        bt.compress(full, keep_order=True, bits=9),
        bt.compress(full, max_error=1e-3, effort="fast", mode="grid"),
        bt.compress(Mesh(plane.vertices, plane.faces[:, [0, 2, 1]]), bits=5),
        bt.compress(full, mode="spectral", keep_order=True, max_error=0.05),
        bt.compress(plane, mode="spectral", bits=6, effort="fast"),
        bt.compress(plane, mode="smooth", bits=5),
        bt.compress(painted, bits=6, function_errors={"d": 1e-2}),
        bt.compress(Mesh(np.zeros((0, 3)), np.zeros((0, 3), int))),
    ]


def with_checksums(data):
    """Make the checksums right again, as far as the sections can be followed."""
    data = bytearray(data)
    reader = Reader(bytes(data), "x")
    try:
        reader.take(6)
        for _ in range(reader.varint()):
            reader.varint()
            reader.take(reader.varint())
            end = reader.position
            data[end : end + 4] = zlib.crc32(data[:end]).to_bytes(4, "little")
            reader.data = bytes(data)
            reader.take(4)
    except FileFormatError:
        pass
    return bytes(data)


def attempt(data):
    attempts = [
        (bt.decompress, {"max_vertices": LIMIT}),
        (bt.decompress, {"max_vertices": LIMIT, "partial": True}),
        (describe, {}),
    ]
    for read, options in attempts:
        try:
            result = read(data, **options)
        except FileFormatError:
            continue
        if isinstance(result, Mesh):
            assert result.n_vertices <= LIMIT
            assert np.isfinite(result.vertices).all()
            assert Mesh(result.vertices, result.faces).n_faces == result.n_faces


def mutated(rng, data):
    """Change some bytes, cut or repeat a piece; mostly with right checksums."""
    data = bytearray(data)
    for _ in range(int(rng.integers(1, 6))):
        i = int(rng.integers(len(data)))
        kind = int(rng.integers(6))
        if kind < 3:
            data[i] = int(rng.integers(256))
        elif kind == 3:
            data[i] ^= 1 << int(rng.integers(8))
        elif kind == 4:
            del data[i : i + int(rng.integers(1, 9))]
        else:
            data[i:i] = data[i : i + int(rng.integers(1, 9))]
        if not data:
            data = bytearray(b"\0")
    return with_checksums(data) if rng.random() < 0.9 else bytes(data)


@given(st.integers(0, 2**63 - 1), st.sampled_from(range(8)))
@settings(max_examples=400)
def test_mutated_files(seed, place):
    attempt(mutated(np.random.default_rng(seed), files()[place]))


@given(st.binary(max_size=200))
def test_noise(noise):
    attempt(noise)
    attempt(files()[0][:6] + noise)


def test_a_signalling_nan_is_a_number_like_any_other_bad_one():
    data = b"\x00" * 12 + b"\x01\x00\x80\x7f"  # of single precision
    assert np.isnan(grid.from_bytes(data, is_short=True).step)


@pytest.mark.heavy
def test_a_hundred_thousand_mutated_files():
    seed = np.random.SeedSequence().entropy
    for k in range(100_000):
        try:
            attempt(mutated(np.random.default_rng([seed, k]), files()[k % len(files())]))
        except Exception as error:
            error.add_note(f"default_rng([{seed}, {k}])")
            raise


def test_a_small_file_cannot_declare_more_than_is_allowed():
    data = bytearray(files()[2])
    assert describe(bytes(data)).n_vertices == 37
    for declared in (b"\xff\xff\xff\x7f", b"\xff\xff\xff\xff\xff\xff\xff\x7f"):
        head = data[:8] + bytes([data[8] + len(declared) - 1]) + declared + data[10:]
        with pytest.raises(FileFormatError, match="max_vertices can be raised"):
            bt.decompress(with_checksums(head))


def test_sections_and_features_must_agree():
    """A file whose order is not announced would come back in another one, and nobody be told."""
    for kept in (False, True):
        features, sections = unpack(bt.compress(bt.shapes.disk(2), bits=5, keep_order=kept), "x")
        with pytest.raises(FileFormatError, match="order of the vertices is announced and not"):
            bt.decompress(pack(features ^ KEEPS_ORDER, sections))
    colours = Mesh(bt.shapes.disk(3).vertices, bt.shapes.disk(3).faces, {"c": np.arange(37)})
    features, sections = unpack(bt.compress(colours, bits=5), "x")
    assert features == PREDICTS
    with pytest.raises(FileFormatError, match="not announced"):
        bt.decompress(pack(0, sections))


def stars(n):
    """The section of n vertices without faces."""
    return Section(CONNECTIVITY, to_varints([n, 0, 0, 0, 0, 0, 0]))


def test_few_bytes_cannot_declare_many_coordinates_of_many_vertices():
    """Of a basis that is not needed, coefficients take no bytes: 20 GB of zeros would follow."""
    plane = PositionGrid(np.zeros(256), 1.0)
    head = SpectralHead(plane, "best", 0, 1.0, 0, 0, 0.0, hashlib.sha256().digest()[:8])
    spectrum = Section(SPECTRUM, head.to_bytes() + to_varints([0]))
    points = Section(GRID, to_varints([256, 0, 1, 0]) + grid.to_bytes(plane))
    for features, positions in ((PROGRESSIVE, spectrum), (0, points)):
        for n in (10**7, 50_000):
            data = pack(features, [stars(n), positions])
            assert describe(data).dimension == 256
            with pytest.raises(FileFormatError, match="max_vertices can be raised"):
                bt.decompress(data, max_vertices=n)
    few = bt.decompress(pack(PROGRESSIVE, [stars(9), spectrum]), max_vertices=9)
    assert few.vertices.shape == (9, 256)


@pytest.mark.parametrize("bound", [np.nan, np.inf, -1.0])
def test_a_bound_that_is_none_is_refused(bound):
    """No error of a vertex is below it, or every one is: nothing would be stated."""
    plane = bt.shapes.disk(2)
    for mode in ("smooth", "spectral"):
        data = bytearray(bt.compress(plane, mode=mode, bits=5))
        stated = np.array([describe(bytes(data)).max_error], "<f8").tobytes()
        place = data.index(stated)
        data[place : place + 8] = np.array([bound], "<f8").tobytes()
        for read in (bt.decompress, describe):
            with pytest.raises(FileFormatError, match="the largest error is"):
                read(with_checksums(data))
