"""The container refuses, by name, all that it does not know."""

import re
import zlib
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from beltrami.compression import container
from beltrami.compression.container import (
    CONNECTIVITY,
    DATA,
    GRID,
    MAGIC,
    NAMES,
    Section,
    pack,
    unpack,
)
from beltrami.compression.functions import decode_array, encode_array
from beltrami.compression.ordering import decode_order, encode_order
from beltrami.compression.varint import Reader, to_varints
from beltrami.errors import FileFormatError, MeshError

FORMAT = Path(__file__).parents[2] / "docs" / "format.md"


def small():
    return pack(0, [Section(CONNECTIVITY, b"faces"), Section(GRID, b"")])


def test_there_and_back():
    features, sections = unpack(small(), "a.btm")
    assert features == 0
    assert [(s.kind, s.payload, s.start) for s in sections] == [(1, b"faces", 9), (2, b"", 20)]


def test_every_changed_byte_and_every_cut_is_noticed():
    data = small()
    for i in range(len(data)):
        with pytest.raises(FileFormatError):
            unpack(data[:i] + bytes([data[i] ^ 1]) + data[i + 1 :], "a.btm")
        with pytest.raises(FileFormatError):
            unpack(data[:i], "a.btm")
    with pytest.raises(FileFormatError, match="after the last section"):
        unpack(data + b"\0", "a.btm")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ((0, 0x88), "not a .btm file"),
        ((4, 2), "version 2 of the format; this reads version 1"),
        ((5, 0x80), "features 0x80 of a later beltrami"),
    ],
)
def test_what_is_unknown_is_named(change, message):
    data = bytearray(small())
    data[change[0]] = change[1]
    with pytest.raises(FileFormatError, match=re.escape(message)):
        unpack(bytes(data), "a.btm")


def test_unknown_double_and_unsorted_sections_are_refused():
    with pytest.raises(FileFormatError, match="kind 99, unknown"):
        unpack(pack(0, [Section(99, b"")]), "a.btm")
    for kinds in ([GRID, CONNECTIVITY], [GRID, GRID]):
        with pytest.raises(FileFormatError, match="wrong order"):
            unpack(pack(0, [Section(k, b"") for k in kinds]), "a.btm")
    assert len(unpack(pack(0, [Section(DATA, b"")] * 3), "a.btm")[1]) == 3


def test_checksums_take_time_in_proportion_to_the_file(monkeypatch):
    """Sixty thousand sections of a file must not be sixty thousand sums over it."""
    summed = []

    def counting(data, *before):
        summed.append(len(data))
        return zlib.crc32(data, *before)

    monkeypatch.setattr(container, "zlib", SimpleNamespace(crc32=counting))
    data = pack(0, [Section(DATA, bytes(40))] * 500)
    assert len(data) <= sum(summed) <= 2 * len(data)
    summed.clear()
    assert len(unpack(data, "x")[1]) == 500
    assert len(data) <= sum(summed) <= 2 * len(data)


def test_the_document_says_what_the_code_does():
    text = FORMAT.read_text(encoding="utf-8")
    assert " ".join(f"{byte:02x}" for byte in MAGIC) in text
    for kind, name in NAMES.items():
        assert re.search(rf"^\| {kind} \| {name} \|", text, re.M), name


def test_varints():
    numbers = [0, 1, 127, 128, 300, 2**62]
    reader = Reader(to_varints(numbers), "x")
    assert [reader.varint() for _ in numbers] == numbers
    with pytest.raises(FileFormatError, match="found the end"):
        reader.varint()
    with pytest.raises(FileFormatError, match="more than 9 bytes"):
        Reader(b"\xff" * 20, "x").varint()
    with pytest.raises(FileFormatError, match="faces of at most 5, found 6"):
        Reader(b"\x06", "x").varint(5, "faces")


@pytest.mark.parametrize("dtype", ["f8", "f4", "i8", "u1", "?", ">i2", "u4"])
@pytest.mark.parametrize("tail", [(), (3,)])
def test_arrays_come_back(dtype, tail):
    values = np.random.default_rng(0).integers(0, 2, (50, *tail)).astype(dtype)
    name, back = decode_array(Reader(encode_array("größe", values), "x"), 50)
    assert name == "größe"
    np.testing.assert_array_equal(back, values)
    assert back.dtype == values.dtype.newbyteorder("=")


def test_arrays_of_other_types_are_refused():
    with pytest.raises(MeshError, match="functions of the type complex128"):
        encode_array("f", np.zeros(3, complex))


def test_deflated_bytes_cannot_fill_the_memory():
    bomb = to_varints([1]) + b"f" + to_varints([3]) + b"<f8" + to_varints([1, 1 << 16])
    with pytest.raises(FileFormatError, match="larger than its bytes"):
        decode_array(Reader(bomb + zlib.compress(bytes(10**6), 9), "x"), 10**6)
    head = to_varints([1]) + b"f" + to_varints([3]) + b"|u1" + to_varints([0])
    with pytest.raises(FileFormatError, match="expected 10 bytes, found 11"):
        decode_array(Reader(head + zlib.compress(bytes(10**5), 9), "x"), 10)


def test_truth_values_are_0_or_1():
    head = to_varints([1]) + b"f" + to_varints([3]) + b"|b1" + to_varints([0])
    _, values = decode_array(Reader(head + zlib.compress(b"\1\0"), "x"), 2)
    assert values.tolist() == [True, False]
    with pytest.raises(FileFormatError, match="neither 0 nor 1"):
        decode_array(Reader(head + zlib.compress(b"\1\2"), "x"), 2)


@pytest.mark.parametrize("n", [0, 1, 2, 7, 1000])
def test_orders_come_back_in_log2_of_n_factorial_bits(n):
    order = np.random.default_rng(n).permutation(n)
    data = encode_order(order)
    np.testing.assert_array_equal(decode_order(Reader(data, "x"), n), order)
    factorial = np.log2(np.arange(1, n + 1)).sum()
    assert 8 * len(data) <= 1.01 * factorial + 0.05 * n + 16


def test_any_bytes_are_an_order():
    rng = np.random.default_rng(5)
    for _ in range(50):
        noise = rng.integers(0, 256, 30, dtype=np.uint8).tobytes()
        assert sorted(decode_order(Reader(noise, "x"), 40).tolist()) == list(range(40))
