"""Functions on the vertices and texture coordinates, exactly: bytes sorted by place, deflated."""

from __future__ import annotations

import math
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami.compression.varint import Reader, to_varints
from beltrami.errors import MeshError

TYPES = {f"<{kind}{size}" for kind in "iuf" for size in (2, 4, 8)} | {"|u1", "|i1", "|b1"}


def encode_array(name: str, values: NDArray[Any]) -> bytes:
    """Write an array with its name; its first axis is known from elsewhere.

    Examples
    --------
    >>> data = encode_array("height", np.arange(5.0))
    >>> decode_array(Reader(data, "a.btm"), 5)
    ('height', array([0., 1., 2., 3., 4.]))
    """
    ordered = values.astype(values.dtype.newbyteorder("<"), order="C")
    head = write_label(name, ordered)
    planes = ordered.reshape(-1).view(np.uint8).reshape(-1, ordered.dtype.itemsize).T
    return head + zlib.compress(planes.tobytes(), 9)


def write_label(name: str, ordered: NDArray[Any]) -> bytes:
    """Write the name, the type and the shape of an array of low bytes first."""
    kind = ordered.dtype.str
    if kind not in TYPES:
        raise MeshError(
            f"functions of the type {ordered.dtype} cannot be stored",
            remedy="Turn them into float64 or integers.",
        )
    label = name.encode()
    head = to_varints([len(label)]) + label + to_varints([len(kind)]) + kind.encode()
    return head + to_varints([ordered.ndim - 1, *ordered.shape[1:]])


def read_label(reader: Reader) -> tuple[str, str, list[int]]:
    """Read (name, type, further axes)."""
    label = reader.take(reader.varint())
    kind = reader.take(reader.varint()).decode("latin-1")
    if kind not in TYPES:
        raise reader.fault(f"an array of the type {kind!r}, unknown here")
    try:
        name = label.decode()
    except UnicodeDecodeError as cause:
        raise reader.fault("a name that is not UTF-8") from cause
    tail = [reader.varint(1 << 16, "columns") for _ in range(reader.varint(1, "axes"))]
    return name, kind, tail


def decode_array(reader: Reader, rows: int) -> tuple[str, NDArray[Any]]:
    """Read an array with this many rows; no more memory than it declares is used."""
    name, kind, tail = read_label(reader)
    size = np.dtype(kind).itemsize
    count = rows * math.prod(tail)
    deflated = reader.rest()
    if count * size > 1100 * len(deflated) + 1100:  # deflate shortens at most 1032 times
        raise reader.fault("an array that is larger than its bytes can be")
    inflating = zlib.decompressobj()
    try:
        plain = inflating.decompress(deflated, count * size + 1)
    except zlib.error as cause:
        raise reader.fault(f"expected deflated bytes ({cause})") from cause
    if len(plain) != count * size or not inflating.eof:
        raise reader.fault(f"expected {count * size} bytes, found {len(plain)} or more")
    planes = np.frombuffer(plain, np.uint8).reshape(size, count)
    if kind == "|b1" and (planes > 1).any():
        raise reader.fault("truth values that are neither 0 nor 1")
    return name, np.ascontiguousarray(planes.T).view(kind).reshape(rows, *tail)
