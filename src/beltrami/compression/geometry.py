"""Positions to bytes and back, on a grid, three coordinates at a time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami._progress import Progress, stages
from beltrami.compression import grid as grids
from beltrami.compression.grid import PositionGrid
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
MOST_COORDINATES = 256
_SOLVES = (BEST, FAST)
_BLOCK = 2048  # vertices between two looks at the progress


def _groups(d: int) -> range:
    return range(0, d, 3)


def _surroundings(faces: Integers, n: int) -> Neighbourhood:
    """Look around, at faces of three vertices."""
    a, b, c = faces.T
    return look_around(faces[(a != b) & (b != c) & (c != a)], n)


def encode_positions(
    x: Floats, faces: Integers, grid: PositionGrid, effort: str, progress: Progress | None = None
) -> bytes:
    """Write positions (n, d), rounded to the grid."""
    numbers = grid.round(x)
    n, d = numbers.shape
    near = _surroundings(faces, n)
    data = to_varints([d, EFFORTS.index(effort), int(grid.is_short)]) + grids.to_bytes(grid)
    for first in _groups(d):
        part = np.zeros((n, 3), np.int64)
        part[:, : d - first] = numbers[:, first : first + 3]
        size = 9 * n + 1024
        while True:
            buffer, state = np.zeros(size, np.uint8), new_encoder()
            _run(part, near, effort, state, buffer, progress)
            payload = finished(state, buffer)
            if payload is not None:
                break
            size = int(state[POSITION]) + 1024
        data += to_varints([len(payload)]) + payload
    return data


def decode_positions(
    reader: Reader, faces: Integers, n: int, progress: Progress | None = None
) -> Floats:
    """Read positions (n, d)."""
    d = reader.varint(MOST_COORDINATES, "coordinates")
    if d < 2:
        raise reader.fault(f"expected 2 or more coordinates, found {d}")
    effort = EFFORTS[reader.varint(len(EFFORTS) - 1, "effort")]
    is_short = bool(reader.varint(1, "precision"))
    grid = grids.from_bytes(reader.take((4 if is_short else 8) * (d + 1)), is_short)
    if not (np.isfinite(grid.origin).all() and 0 < grid.step < np.inf):
        raise reader.fault("the grid of positions has no positive step, or no finite origin")
    near = _surroundings(faces, n)
    numbers = np.zeros((n, d), np.int64)
    for first in _groups(d):
        buffer = readable(reader.take(reader.varint()))
        part = np.zeros((n, 3), np.int64)
        state = new_decoder(buffer)
        _run(part, near, effort, state, buffer, progress)
        if ran_dry(state, buffer):
            raise reader.fault("fewer positions than vertices")
        numbers[:, first : first + 3] = part[:, : d - first]
    reader_is_done(reader)
    with np.errstate(over="ignore"):
        x = grid.points(numbers)
    if not np.isfinite(x).all():
        raise reader.fault("positions beyond the largest number")
    return x


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
) -> None:
    """Code all numbers, block by block."""
    n = len(numbers)
    solves = _SOLVES[EFFORTS.index(effort)]
    coder = new_coder(n, len(solves))
    order = coding_order(near)
    done = 0
    for size in stages(n, progress, _BLOCK):
        code_positions(numbers, order, done, done + size, solves, near, coder, state, buffer)
        done += size
        if ran_dry(state, buffer):
            break
