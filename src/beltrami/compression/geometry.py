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
    decode_offsets,
    encode_numbers,
    encode_offsets,
    reader_is_done,
    surroundings,
)
from beltrami.compression.smoothing import WEIGHTS, best_choice, smoothed
from beltrami.compression.varint import Reader, to_varints

MOST_COORDINATES = 256
FREE = len(WEIGHTS) + 1  # added to the choice of smoothing


@dataclass(frozen=True)
class Head:
    """What precedes the positions.

    ``bound`` is that of the error; ``is_free`` where numbers count from what is expected.
    """

    grid: PositionGrid
    effort: str
    choice: int
    bound: float
    is_free: bool = False


def read_dimension(reader: Reader, most: int) -> int:
    """Read the number of coordinates; ``most`` of so many vertices are allowed."""
    d = reader.varint(MOST_COORDINATES, "coordinates")
    if d < 2:
        raise reader.fault(f"expected 2 or more coordinates, found {d}")
    if d > most:
        raise reader.fault(f"{d} coordinates of so many vertices (max_vertices can be raised)")
    return d


def read_bound(reader: Reader) -> float:
    """Read the largest error."""
    bound = float(np.frombuffer(reader.take(8), "<f8")[0])
    if not 0 <= bound < np.inf:
        raise reader.fault(f"the largest error is {bound}")
    return bound


def read_head(reader: Reader, most: int = MOST_COORDINATES) -> Head:
    """Read what precedes the positions."""
    d = read_dimension(reader, most)
    effort = EFFORTS[reader.varint(len(EFFORTS) - 1, "effort")]
    is_short = bool(reader.varint(1, "precision"))
    choice = reader.varint(FREE + len(WEIGHTS), "smoothing")
    grid = grids.from_bytes(reader.take((4 if is_short else 8) * (d + 1)), is_short)
    if not (np.isfinite(grid.origin).all() and 0 < grid.step < np.inf):
        raise reader.fault("the grid of positions has no positive step, or no finite origin")
    bound = read_bound(reader) if choice else grid.bound
    is_free = choice >= FREE
    return Head(grid, effort, choice - FREE if is_free else choice, bound, is_free)


def _rounded_up(x: float) -> NDArray[np.float64]:
    return np.array([x * (1 + 2.0**-40)], "<f8")


def encode_positions(
    x: Floats,
    near: Neighbourhood,
    grid: PositionGrid,
    effort: str,
    progress: Progress | None = None,
) -> bytes:
    """Write positions (n, d), rounded to the grid."""
    numbers = grid.round(x)
    d = numbers.shape[1]
    data = to_varints([d, EFFORTS.index(effort), int(grid.is_short), 0])
    return data + grids.to_bytes(grid) + encode_numbers(numbers, near, effort, progress)


def encode_freely(
    x: Floats,
    near: Neighbourhood,
    grid: PositionGrid,
    effort: str,
    is_bounded: bool = False,
    progress: Progress | None = None,
) -> bytes:
    """Write positions (n, d) at whole numbers of steps from where they are expected, smoothed.

    They are at most 1.1 sqrt(d) steps off; ``is_bounded``: at most ``grid.bound``, which every
    residual can keep, and of the smoothings one is taken that keeps it.
    """
    exact = (x - grid.origin) / grid.step
    payload, placed = encode_offsets(exact, near, effort, is_bounded, progress)
    most = grid.bound / grid.step * (1 + 2.0**-30) if is_bounded else np.inf
    choice = best_choice(exact, placed, near, most)
    found = grid.points(smoothed(placed, near, choice))
    error = float(np.sqrt(((found - x) ** 2).sum(axis=1)).max(initial=0.0))
    head = [x.shape[1], EFFORTS.index(effort), int(grid.is_short), FREE + choice]
    data = to_varints(head) + grids.to_bytes(grid) + _rounded_up(error).tobytes()
    return data + payload


def decode_positions(
    reader: Reader,
    faces: Integers,
    n: int,
    progress: Progress | None = None,
    most: int = MOST_COORDINATES,
) -> Floats:
    """Read positions (n, d), of at most so many coordinates."""
    head = read_head(reader, most)
    d, grid = len(head.grid.origin), head.grid
    near = surroundings(faces, n)
    read = decode_offsets if head.is_free else decode_numbers
    numbers = read(reader, (n, d), near, head.effort, progress)
    reader_is_done(reader)
    with np.errstate(over="ignore"):
        x = grid.points(smoothed(numbers, near, head.choice))
    if not np.isfinite(x).all():
        raise reader.fault("positions beyond the largest number")
    return x
