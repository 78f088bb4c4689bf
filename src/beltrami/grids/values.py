"""Functions in the shape of a grid, at the door: real or complex, any dimension, finite."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beltrami.errors import DimensionError, NonFiniteError

Values: TypeAlias = NDArray[np.float64] | NDArray[np.complex128]


def as_values(f: ArrayLike, what: str = "the function") -> Values:
    """Return a function on a grid as float64, or as complex128 where it is complex.

    Raises
    ------
    DimensionError
        If it is ragged, not of numbers, empty, or a single number without an axis.
    NonFiniteError
        If a value is NaN or infinite; ``error.vertices`` are the flat indices.
    """
    try:
        given: NDArray[Any] = np.asarray(f)
    except ValueError as cause:
        raise DimensionError(f"the rows of {what} differ in length") from cause
    if given.dtype.kind not in "biufc":
        raise DimensionError(f"{what} must be an array of numbers, not of type {given.dtype}")
    if given.ndim == 0 or given.size == 0:
        raise DimensionError(f"{what} needs one value or more along each axis, not {given.shape}")
    with np.errstate(over="ignore"):  # of longer floats, told below
        values: Values = (
            given.astype(np.complex128) if given.dtype.kind == "c" else given.astype(np.float64)
        )
    require_finite_values(values, what, "Give finite values there.")
    return values


def is_whole(number: object) -> bool:
    """Whether this is an integer of Python or numpy, and not a truth value."""
    return isinstance(number, int | np.integer) and not isinstance(number, bool)


def require_finite_values(values: Values, what: str, remedy: str) -> None:
    """Raise NonFiniteError, with the flat indices, if a value is NaN or infinite."""
    finite = np.isfinite(values)
    if not finite.all():
        raise NonFiniteError(
            f"{what} has values that are NaN or infinite",
            vertices=np.flatnonzero(~finite),
            remedy=remedy,
        )


def refuse_overflow(result: Values, what: str) -> Values:
    """Return a result computed from finite values, or say that it left the range of floats."""
    require_finite_values(result, what, "The input is too large for floats: scale it down.")
    return result
