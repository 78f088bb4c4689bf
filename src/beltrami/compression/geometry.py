"""Positions to bytes and back, on a grid, three coordinates at a time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami._progress import Progress
from beltrami.compression import grid as grids
from beltrami.compression.grid import PositionGrid
from beltrami.compression.neighbourhood import Neighbourhood
from beltrami.compression.numbers import (
    EFFORTS,
    decode_numbers,
    encode_numbers,
    reader_is_done,
    surroundings,
)
from beltrami.compression.smoothing import WEIGHTS, smoothed
from beltrami.compression.varint import Reader, to_varints

MOST_COORDINATES = 256


@dataclass(frozen=True)
class Head:
    """What precedes the positions; ``bound`` is that of the error."""

    grid: PositionGrid
    effort: str
    choice: int
    bound: float


def read_head(reader: Reader) -> Head:
    """Read what precedes the positions."""
    d = reader.varint(MOST_COORDINATES, "coordinates")
    if d < 2:
        raise reader.fault(f"expected 2 or more coordinates, found {d}")
    effort = EFFORTS[reader.varint(len(EFFORTS) - 1, "effort")]
    is_short = bool(reader.varint(1, "precision"))
    choice = reader.varint(len(WEIGHTS), "smoothing")
    grid = grids.from_bytes(reader.take((4 if is_short else 8) * (d + 1)), is_short)
    if not (np.isfinite(grid.origin).all() and 0 < grid.step < np.inf):
        raise reader.fault("the grid of positions has no positive step, or no finite origin")
    bound = float(np.frombuffer(reader.take(8), "<f8")[0]) if choice else grid.bound
    return Head(grid, effort, choice, bound)


def largest_error(x: Floats, grid: PositionGrid, near: Neighbourhood, choice: int) -> float:
    """Return how far the decoded positions will be from x, at most."""
    decoded = grid.points(smoothed(grid.round(x), near, choice))
    return float(np.sqrt(((decoded - x) ** 2).sum(axis=1)).max()) if len(x) else 0.0


def _rounded_up(x: float) -> NDArray[np.float64]:
    return np.array([x * (1 + 2.0**-40)], "<f8")


def encode_positions(
    x: Floats,
    faces: Integers,
    grid: PositionGrid,
    effort: str,
    choice: int = 0,
    progress: Progress | None = None,
) -> bytes:
    """Write positions (n, d), rounded to the grid; ``choice`` of smoothing is told the decoder."""
    numbers = grid.round(x)
    n, d = numbers.shape
    near = surroundings(faces, n)
    data = to_varints([d, EFFORTS.index(effort), int(grid.is_short), choice])
    data += grids.to_bytes(grid)
    if choice:
        data += _rounded_up(largest_error(x, grid, near, choice)).tobytes()
    data += encode_numbers(numbers, near, effort, progress)
    return data


def decode_positions(
    reader: Reader, faces: Integers, n: int, progress: Progress | None = None
) -> Floats:
    """Read positions (n, d)."""
    head = read_head(reader)
    d, grid = len(head.grid.origin), head.grid
    near = surroundings(faces, n)
    numbers = decode_numbers(reader, (n, d), near, head.effort, progress)
    reader_is_done(reader)
    with np.errstate(over="ignore"):
        x = grid.points(smoothed(numbers, near, head.choice))
    if not np.isfinite(x).all():
        raise reader.fault("positions beyond the largest number")
    return x
