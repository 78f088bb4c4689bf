"""Whole numbers on the vertices, predicted from those around: three columns at a time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami._progress import Progress, stages
from beltrami.compression.guesses import BEST, FAST
from beltrami.compression.neighbourhood import Neighbourhood, coding_order, look_around
from beltrami.compression.positions import code_positions, new_coder
from beltrami.compression.range_coder import (
    POSITION,
    finished,
    new_decoder,
    new_encoder,
    ran_dry,
    readable,
)
from beltrami.compression.tables import Table
from beltrami.compression.varint import Reader, to_varints

EFFORTS = ("best", "fast")
_SOLVES = (BEST, FAST)
_BLOCK = 2048  # vertices between two looks at the progress


def surroundings(faces: Integers, n: int) -> Neighbourhood:
    """Look around, at faces of three vertices."""
    a, b, c = faces.T
    return look_around(faces[(a != b) & (b != c) & (c != a)], n)


def encode_numbers(
    numbers: Integers,
    near: Neighbourhood,
    effort: str,
    progress: Progress | None = None,
    order: Integers | None = None,
) -> bytes:
    """Write (n, d) numbers, each below 2³⁸ or so: for each three columns a length, and bits.

    With an ``order`` only those of the vertices that it names.
    """
    n, d = numbers.shape
    data = b""
    for first in range(0, d, 3):
        part = np.zeros((n, 3), np.int64)
        part[:, : d - first] = numbers[:, first : first + 3]
        size = 9 * n + 1024
        while True:
            buffer, state = np.zeros(size, np.uint8), new_encoder()
            _run(part, near, effort, state, buffer, progress, order=order)
            payload = finished(state, buffer)
            if payload is not None:
                break
            size = int(state[POSITION]) + 1024
        data += to_varints([len(payload)]) + payload
    return data


def decode_numbers(
    reader: Reader, shape: tuple[int, int], near: Neighbourhood, effort: str,
    progress: Progress | None = None,
) -> Integers:  # fmt: skip
    """Read (n, d) numbers."""
    n, d = shape
    parts: list[Integers] = []  # of the memory only what the bytes are there for
    for first in range(0, d, 3):
        buffer = readable(reader.take(reader.varint()))
        part = np.zeros((n, 3), np.int64)
        state = new_decoder(buffer)
        _run(part, near, effort, state, buffer, progress)
        if ran_dry(state, buffer):
            raise reader.fault("fewer numbers than vertices")
        parts.append(part[:, : d - first])
    return np.ascontiguousarray(np.concatenate(parts, axis=1))


def encode_offsets(
    x: Floats,
    near: Neighbourhood,
    effort: str,
    is_bounded: bool = False,
    progress: Progress | None = None,
    order: Integers | None = None,
) -> tuple[bytes, Floats]:
    """Return (bytes, what they decode to) of positions (n, d) in steps.

    Each coordinate is within 0.6 of a step; with a bound the distance is within 0.5 sqrt(d).
    With an ``order`` only those of the vertices that it names are written.
    """
    n, d = x.shape
    data, found = b"", np.zeros((n, d))
    for first in range(0, d, 3):
        truth = np.zeros((n, 3))
        truth[:, : d - first] = x[:, first : first + 3]
        most = min(d - first, 3) / 4 if is_bounded else np.inf
        size = 9 * n + 1024
        while True:
            buffer, state = np.zeros(size, np.uint8), new_encoder()
            numbers = np.zeros((n, 3), np.int64)
            placed = _run(numbers, near, effort, state, buffer, progress, truth, most, order)
            payload = finished(state, buffer)
            if payload is not None:
                break
            size = int(state[POSITION]) + 1024
        data += to_varints([len(payload)]) + payload
        found[:, first : first + 3] = placed[:, : d - first]
    return data, found


def decode_offsets(
    reader: Reader, shape: tuple[int, int], near: Neighbourhood, effort: str,
    progress: Progress | None = None,
) -> Floats:  # fmt: skip
    """Read positions (n, d) in steps."""
    n, d = shape
    parts: list[Floats] = []
    for first in range(0, d, 3):
        buffer = readable(reader.take(reader.varint()))
        state, numbers = new_decoder(buffer), np.zeros((n, 3), np.int64)
        placed = _run(numbers, near, effort, state, buffer, progress, np.zeros((n, 3)))
        if ran_dry(state, buffer):
            raise reader.fault("fewer numbers than vertices")
        parts.append(placed[:, : d - first])
    return np.ascontiguousarray(np.concatenate(parts, axis=1))


def reader_is_done(reader: Reader) -> None:
    """Raise if bytes are left."""
    left = len(reader.data) - reader.position
    if left:
        raise reader.fault(f"{left} bytes too many in this section")


def _run(
    numbers: Integers,
    near: Neighbourhood,
    effort: str,
    state: Table,
    buffer: NDArray[np.uint8],
    progress: Progress | None,
    truth: Floats | None = None,
    most: float = np.inf,
    order: Integers | None = None,
) -> Floats:
    """Code all numbers, block by block; return the positions."""
    n = len(numbers)
    solves = _SOLVES[EFFORTS.index(effort)]
    coder = new_coder(n, len(solves), np.zeros((0, 3)) if truth is None else truth, most)
    vertices = coding_order(near) if order is None else order
    done = 0
    for size in stages(len(vertices), progress, _BLOCK):
        code_positions(numbers, vertices, done, done + size, solves, near, coder, state, buffer)
        done += size
        if ran_dry(state, buffer):
            break
    return coder.x
