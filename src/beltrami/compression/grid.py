"""Grids: positions rounded to whole numbers of steps, and the bound of the error."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami.errors import MeshError

MOST_BITS = 30
_SHORT = 20  # bits up to which an origin and a step in single precision are good enough


@dataclass(frozen=True, eq=False)
class PositionGrid:
    """The points origin + step k, k whole.

    Parameters
    ----------
    origin
        (d,) at most the smallest coordinates.
    step
        The distance of the points along an axis, > 0.
    """

    origin: Floats
    step: float

    @property
    def bound(self) -> float:
        """How far a point may be from the nearest point of the grid: half a diagonal of a cell."""
        return 0.5 * self.step * float(np.sqrt(len(self.origin)))

    def round(self, x: Floats) -> Integers:
        """Return the numbers of the nearest points."""
        return np.floor((x - self.origin) / self.step + 0.5).astype(np.int64)

    def points(self, numbers: Integers | Floats) -> Floats:
        """Return the points of these numbers."""
        scaled = numbers * self.step
        return scaled + self.origin

    @property
    def is_short(self) -> bool:
        """Whether single precision holds it exactly."""
        numbers = np.append(self.origin, self.step)
        return bool((_single(numbers) == numbers).all())


def _single(numbers: Floats) -> Floats:
    with np.errstate(over="ignore", under="ignore"):
        return numbers.astype(np.float32).astype(np.float64)


def grid_for(x: Floats, max_error: float | None, bits: int | None) -> PositionGrid:
    """Choose the grid: as fine as the bound needs, or with 2^bits points along the longest side.

    Where that changes hardly anything, its numbers are rounded (down) to single precision.

    Raises
    ------
    MeshError
        If the bound is not positive, or needs more than 2^30 points along a side.
    """
    low = x.min(axis=0) if len(x) else np.zeros(x.shape[1])
    extent = float((x.max(axis=0) - low).max()) if len(x) else 0.0
    if max_error is not None:
        if not 0 < max_error < np.inf:
            raise MeshError(f"the largest error must be positive, not {max_error}")
        step = 2 * max_error / float(np.sqrt(x.shape[1])) * (1 - 2.0**-30)
        if extent > step * 2**MOST_BITS:
            raise MeshError(
                f"an error of {max_error:.3g} is below {extent:.3g} / 2^{MOST_BITS + 1}",
                remedy="Allow a larger error.",
            )
    else:
        step = extent / (2 ** (bits or 1) - 1) if extent > 0 else 1.0
    if step < np.finfo(np.float64).tiny:
        raise MeshError(
            f"the extent of {extent:.3g} is too small for a grid",
            remedy="Scale the mesh to another unit of length.",
        )
    return _shortened(low, step, extent)


def _shortened(low: Floats, step: float, extent: float) -> PositionGrid:
    """Round origin and step down to single precision, unless that shifts the grid."""
    numbers = np.append(low, step)
    with np.errstate(over="ignore", under="ignore"):
        short = numbers.astype(np.float32)
        above = short.astype(np.float64) > numbers
        short[above] = np.nextafter(short[above], np.float32(-np.inf))
    single = short.astype(np.float64)
    fine = np.isfinite(single).all() and single[-1] > 1e-30
    if fine and extent < step * 2**_SHORT and (low - single[:-1] < 8 * step).all():
        return PositionGrid(single[:-1], float(single[-1]))
    return PositionGrid(low, step)


def to_bytes(grid: PositionGrid) -> bytes:
    """Write origin and step, in single or in double precision."""
    numbers = np.append(grid.origin, grid.step)
    return numbers.astype("<f4" if grid.is_short else "<f8").tobytes()


def from_bytes(data: bytes, is_short: bool) -> PositionGrid:
    """Read origin and step."""
    with np.errstate(invalid="ignore"):  # a signalling NaN; what is not finite is refused later
        numbers: NDArray[np.float64] = np.frombuffer(data, "<f4" if is_short else "<f8").astype(
            np.float64
        )
    return PositionGrid(numbers[:-1], float(numbers[-1]))
