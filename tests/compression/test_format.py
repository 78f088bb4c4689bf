"""A second reader, written from docs/format.md alone: the document says what the bytes are."""

import json
import struct
import zlib

import numpy as np
import pytest

import beltrami as bt
from beltrami.compression.contents import describe
from beltrami.mesh.mesh import Mesh
from golden_files import FOLDER

NAMES = sorted(json.loads((FOLDER / "digests.json").read_text(encoding="utf-8")))
SECTIONS = {
    1: "connectivity",
    2: "positions on a grid",
    3: "order of the vertices",
    4: "functions",
    5: "texture coordinates",
    6: "positions in a spectrum",
    7: "predicted functions",
    8: "predicted texture coordinates",
}


class Bytes:
    """Varints and numbers, one after another."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, count):
        assert self.at + count <= len(self.data)
        self.at += count
        return self.data[self.at - count : self.at]

    def rest(self):
        return self.take(len(self.data) - self.at)

    def varint(self):
        value, shift = 0, 0
        while True:
            byte = self.take(1)[0]
            value += (byte % 128) << shift
            shift += 7
            if byte < 128:
                return value

    def numbers(self, kind, count):
        return list(struct.unpack(f"<{count}{kind}", self.take(struct.calcsize(f"<{count}{kind}"))))


class Bits:
    """The range coder, reading."""

    def __init__(self, data):
        self.data, self.at, self.low, self.high = data, 4, 0, 2**32 - 1
        self.code = int.from_bytes(data[:4].ljust(4, b"\0"), "big")

    def bit(self, p):
        width = self.high - self.low
        middle = self.low + (width >> 16) * p + (((width & 65535) * p) >> 16)
        one = self.code <= middle
        self.low, self.high = (self.low, middle) if one else (middle + 1, self.high)
        while self.low >> 24 == self.high >> 24:
            byte = self.data[self.at] if self.at < len(self.data) else 0
            self.at += 1
            self.low = self.low % 2**24 << 8
            self.high = (self.high % 2**24 << 8) + 255
            self.code = (self.code % 2**24 << 8) + byte
        return int(one)

    def adaptive(self, model, i):
        p = model.get(i, 32768)
        bit = self.bit(p)
        p = p + ((65535 - p) >> 4) if bit else p - (p >> 4)
        model[i] = min(max(p, 64), 65472)
        return bit

    def uniform(self, count):
        low, size = 0, count
        while size > 1:
            half = size // 2
            if self.bit(((size - half) << 16) // size):
                low, size = low + half, size - half
            else:
                size = half
        return low

    def number(self, model):
        length = 0
        while length < 40 and self.adaptive(model, length):
            length += 1
        value = 1
        for i in range(length):
            value = 2 * value + (self.bit(32768) if i else self.adaptive(model, 64 + length))
        return value - 1

    def signed(self, model):
        value = self.number(model)
        return value // 2 if value % 2 == 0 else -(value + 1) // 2


def read_container(data):
    """(features, [(kind, payload, bytes)])."""
    source = Bytes(data)
    assert source.take(4).hex(" ") == "89 42 54 4d"
    assert source.take(1) == b"\1"
    features, sections = source.take(1)[0], []
    for _ in range(source.varint()):
        first = source.at
        kind = source.varint()
        payload = source.take(source.varint())
        before = zlib.crc32(data[: source.at])
        assert source.numbers("I", 1) == [before]
        sections.append((kind, payload, source.at - first))
    assert source.at == len(data)
    return features, sections


def read_array_head(source):
    name = source.take(source.varint()).decode()
    kind = source.take(source.varint()).decode()
    return name, kind, [source.varint() for _ in range(source.varint())]


def read_array(payload, rows):
    source = Bytes(payload)
    name, kind, axes = read_array_head(source)
    size, plain = np.dtype(kind).itemsize, zlib.decompress(source.rest())
    count = len(plain) // size
    numbers = b"".join(plain[i::count] for i in range(count))
    return name, np.frombuffer(numbers, kind).reshape(rows, *axes)


def read_order(payload, n):
    bits, left, order = Bits(payload), list(range(n)), []
    steps, flags, expected, near = {}, {}, 0, 0
    while left:
        window = min(32, len(left) >> 6)
        if window:
            near = bits.adaptive(flags, near)
        rank = expected + bits.signed(steps) if window and near else bits.uniform(len(left))
        order.append(left.pop(rank))
        expected = min(rank, len(left) - 1)
    return order


def read_head(source, spectral):
    """(d, effort, smoothing, origin and step, largest error or None)."""
    d, effort, single, smoothing = (source.varint() for _ in range(4))
    grid = source.numbers("f" if single else "d", d + 1)
    error = source.numbers("d", 1)[0] if smoothing or spectral else None
    return d, ("best", "fast")[effort], smoothing, grid, error


@pytest.mark.parametrize("name", NAMES)
def test_containers_and_heads_are_what_the_document_says(name):
    data = (FOLDER / f"{name}.btm").read_bytes()
    features, sections = read_container(data)
    contents, mesh = describe(data), bt.decompress(data)
    assert tuple((SECTIONS[kind], size) for kind, _, size in sections) == contents.sections
    kinds = {kind for kind, _, _ in sections}
    assert features == (3 in kinds) + 2 * (6 in kinds) + 4 * bool(kinds & {7, 8})
    found = {kind: Bytes(payload) for kind, payload, _ in sections}
    n, faces, vertices = (found[1].varint() for _ in range(3))
    middles, merged, turned, improper = (found[1].varint() for _ in range(4))
    assert n == mesh.n_vertices
    assert vertices - middles - merged <= n
    assert turned in (0, mesh.n_faces - improper)
    assert mesh.n_faces - improper <= faces
    d, effort, smoothing, grid, error = read_head(found.get(2) or found[6], 6 in kinds)
    assert (d, effort, grid[-1]) == (contents.dimension, contents.effort, contents.step)
    assert error is None or error == contents.max_error
    mode = "spectral" if 6 in kinds else "smooth" if smoothing else "grid"
    assert mode == contents.mode
    if 2 in found:  # each three coordinates
        for _ in range(-(-d // 3)):
            found[2].take(found[2].varint())
        assert not found[2].rest()


@pytest.mark.parametrize("name", NAMES)
def test_arrays_are_what_the_document_says(name):
    data = (FOLDER / f"{name}.btm").read_bytes()
    mesh = bt.decompress(data)
    _, sections = read_container(data)
    order = next((read_order(p, mesh.n_vertices) for kind, p, _ in sections if kind == 3), None)
    for kind, payload, _ in sections:
        if kind == 4:
            label, values = read_array(payload, mesh.n_vertices)
            expected = mesh.vertex_data[label]
            np.testing.assert_array_equal(expected if order is None else expected[order], values)
        elif kind == 5:
            _, values = read_array(payload, mesh.n_faces)
            np.testing.assert_array_equal(mesh.corner_uv.reshape(-1, 6), values)
        elif kind == 7:
            source = Bytes(payload)
            label, dtype, axes = read_array_head(source)
            effort, how = source.varint(), source.varint()
            assert mesh.vertex_data[label].dtype == np.dtype(dtype)
            assert mesh.vertex_data[label].shape[1:] == tuple(axes)
            assert effort < 2
            assert (how == 0) == (np.dtype(dtype).kind != "f")


def test_orders_are_what_the_document_says():
    cylinder = bt.shapes.cylinder(40, 30)
    shuffle = np.arange(cylinder.n_vertices)
    shuffle[:300] = np.random.default_rng(4).permutation(300)
    mesh = Mesh(cylinder.vertices[shuffle], np.argsort(shuffle)[cylinder.faces])
    _, sections = read_container(bt.compress(mesh, bits=6, keep_order=True, effort="fast"))
    payload = next(payload for kind, payload, _ in sections if kind == 3)
    assert read_order(payload, mesh.n_vertices) == bt.vertex_order(mesh).tolist()


def test_spectra_and_corrections_are_what_the_document_says(monkeypatch):
    from beltrami.compression import spectral_reading

    seen = []
    honest = spectral_reading.decode_corrections

    def noting(*arguments):
        seen.append(honest(*arguments))
        return seen[-1]

    monkeypatch.setattr(spectral_reading, "decode_corrections", noting)
    blob = bt.shapes.blob(600)
    data = bt.compress(blob, mode="spectral", max_error=0.05, effort="fast", terms=40)
    bt.decompress(data)
    source = Bytes(next(p for kind, p, _ in read_container(data)[1] if kind == 6))
    d, effort, smoothing, _, error = read_head(source, spectral=True)
    assert (effort, error) == ("fast", describe(data).max_error)
    assert smoothing <= 8
    terms, count = source.varint(), source.varint()
    assert terms == describe(data).terms
    assert count > 3
    step = source.numbers("d", 1)[0]
    assert 0 < step <= 0.1 / np.sqrt(3)
    source.take(8)
    source.take(source.varint())
    bits, gaps, models = Bits(source.rest()), {}, [{} for _ in range(d)]
    vertex, vertices, offsets = -1, [], []
    for _ in range(count):
        vertex += 1 + bits.number(gaps)
        vertices.append(vertex)
        offsets.append([bits.signed(model) for model in models])
    assert vertices == seen[-1][0].tolist()
    assert offsets == seen[-1][1].tolist()
