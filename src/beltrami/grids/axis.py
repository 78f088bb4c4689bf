"""Axis: what a grid needs to know of one of its directions (section 3.2.4)."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from math import prod
from typing import Any, NamedTuple, TypeAlias, TypeGuard

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, rectangular
from beltrami.errors import DimensionError, NonFiniteError, shown

_LARGEST = 2**31  # entries of a sparse matrix with 32-bit indices


class Axis(NamedTuple):
    """One direction: p points, whether the last is beside the first, and the step h."""

    size: int
    periodic: bool
    spacing: float

    @property
    def coordinates(self) -> Floats:
        """(p,) i h on a circle (E31); the middles of the cells, (i + ½) h, between two ends."""
        return np.asarray((np.arange(self.size) + (0 if self.periodic else 0.5)) * self.spacing)

    @property
    def coincidence(self) -> int:
        """How often the two neighbours are one and the same point: 2 on a circle of two."""
        return 2 if self.periodic and self.size == 2 else 1


Axes: TypeAlias = tuple[Axis, ...]


def make_axes(
    shape: int | Sequence[int], periodic: bool | Sequence[bool], spacing: ArrayLike | None
) -> Axes:
    """Check the three descriptions of a grid, and sort them by axes.

    Raises
    ------
    DimensionError
        If a size is not a whole number >= 1, if the flags or steps are not one for each axis (or
        one for all), if a step is not positive or its inverse infinite, or if the grid is too
        large for its matrices.
    NonFiniteError
        If a step is NaN or infinite.

    Examples
    --------
    >>> make_axes((4, 5), [True, False], None)[1]
    Axis(size=5, periodic=False, spacing=0.2)
    """
    sizes = _sizes(shape)
    d = len(sizes)
    n = prod(sizes)
    if n * (2 * d + 1) >= _LARGEST:
        raise DimensionError(f"a grid of {n} points is too large for its sparse matrices")
    steps = _steps(spacing, sizes)
    return tuple(map(Axis, sizes, _flags(periodic, d), steps))


def _sizes(shape: int | Sequence[int]) -> tuple[int, ...]:
    given = tuple(shape) if _is_row(shape) else (shape,)
    try:
        sizes = tuple(operator.index(p) for p in given)
    except TypeError as cause:
        raise DimensionError(f"the shape of a grid is whole numbers, not {shown(shape)}") from cause
    if not sizes or min(sizes) < 1 or any(isinstance(p, bool) for p in given):
        raise DimensionError(
            f"a grid has one axis or more, of one point or more: not {shown(shape)}"
        )
    return sizes


def _flags(periodic: bool | Sequence[bool], d: int) -> tuple[bool, ...]:
    given: Any = periodic
    given = given[()] if isinstance(given, np.ndarray) else given  # a scalar, if it has no axes
    flags = tuple(given) if _is_row(given) else (given,) * d
    if not all(isinstance(flag, bool | np.bool_) for flag in flags) or len(flags) != d:
        raise DimensionError(f"periodic is True or False, or {d} of them: not {shown(periodic)}")
    return tuple(map(bool, flags))


def _steps(spacing: ArrayLike | None, sizes: tuple[int, ...]) -> tuple[float, ...]:
    if spacing is None:
        return tuple(1 / p for p in sizes)
    steps = rectangular(spacing).astype(np.float64)
    if steps.shape not in ((), (len(sizes),)):
        raise DimensionError(f"spacing is one number, or {len(sizes)}: not of shape {steps.shape}")
    if not np.isfinite(steps).all():
        raise NonFiniteError(f"spacing has values that are NaN or infinite: {steps.tolist()}")
    if not (steps > 0).all():
        raise DimensionError(f"spacing must be positive, and is {steps.tolist()}")
    with np.errstate(over="ignore", divide="ignore"):
        if not np.isfinite([1 / steps, steps * max(sizes)]).all():
            raise DimensionError(f"steps of {steps.tolist()} leave the range of floats: scale them")
    return tuple(float(h) for h in np.broadcast_to(steps, len(sizes)))


def _is_row(given: object) -> TypeGuard[Sequence[Any]]:
    """Whether there is one thing for each axis, and not one for all (an array may be either)."""
    return isinstance(given, Sequence) or (isinstance(given, np.ndarray) and given.ndim > 0)
