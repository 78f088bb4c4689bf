"""Arrays at the door: conversion, checks, read-only views."""

from __future__ import annotations

import math
import operator
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray
from scipy.sparse import csr_array

from beltrami.errors import DimensionError, MeshError, NonFiniteError, shown

Floats: TypeAlias = NDArray[np.float64]
Integers: TypeAlias = NDArray[np.int64]
Booleans: TypeAlias = NDArray[np.bool_]

FUNCTION = "the function"
GIVE = "Give finite values there."
LEAVE_OUT = (
    "Give finite values there, or leave these vertices out with "
    "repair(mesh, remove_vertices=~np.isfinite(f))."
)
DROP = "Drop these vertices with repair(mesh, remove_non_finite=True)."

_HUGE = 2**21  # bytes: a page of memory for those who need much of it


def _can_change(array: NDArray[Any]) -> bool:
    """Whether somebody else could still write into this memory."""
    base: Any = array
    while isinstance(base, np.ndarray):
        if base.flags.writeable:
            return True
        base = base.base
    return base is not None


def read_only(array: NDArray[Any]) -> NDArray[Any]:
    """Mark an array that we have just made as read-only, in place, and return it."""
    array.flags.writeable = False
    return array


def read_only_matrix(matrix: csr_array) -> csr_array:
    """Mark the arrays of a sparse matrix that we have just made as read-only; return it."""
    matrix.sort_indices()  # now, because whoever does it later would write
    for array in (matrix.data, matrix.indices, matrix.indptr):
        read_only(array)
    return matrix


def frozen(array: ArrayLike, dtype: DTypeLike) -> NDArray[Any]:
    """Return a read-only, C-ordered array of this type, copied only where somebody could write.

    Examples
    --------
    >>> import numpy as np
    >>> mine = np.zeros(3)
    >>> frozen(mine, float).flags.writeable, mine.flags.writeable
    (False, True)
    """
    given = rectangular(array)
    result = np.asarray(given, dtype=dtype, order="C")
    if result is given or np.may_share_memory(result, given):
        if not _can_change(given):
            return result
        result = unwritten(given.shape, dtype)
        result[...] = given
        if isinstance(result.base, np.ndarray):
            read_only(result.base)
    return read_only(result)


def unwritten(shape: int | tuple[int, ...], dtype: DTypeLike) -> NDArray[Any]:
    """Make an array as ``numpy.empty`` does; a large one fills huge pages from end to end.

    The first touch of memory is dear. Numpy asks for huge pages, where there are any, but has small
    ones before the first boundary between two of them and behind the last. Here the array begins
    at one and has room up to another; what is not touched takes no memory.
    """
    kind = np.dtype(dtype)
    size = math.prod(shape) if isinstance(shape, tuple) else shape
    if size * kind.itemsize < _HUGE:
        return np.empty(shape, kind)
    pages = -(-size * kind.itemsize // _HUGE) + 1
    block = np.empty(pages * _HUGE // kind.itemsize, kind)
    start = -block.ctypes.data % _HUGE // kind.itemsize
    return block[start : start + size].reshape(shape)


def rectangular(array: ArrayLike) -> NDArray[Any]:
    """Return an array of real numbers; DimensionError if it has ragged rows or other things."""
    try:
        given = np.asarray(array)
    except ValueError as cause:
        raise DimensionError("the rows of an array differ in length") from cause
    except (RuntimeError, TypeError) as cause:  # a tensor with a gradient, or on another device
        raise DimensionError(
            f"no array can be made of an object of type {type(array).__name__}: {cause}"
        ) from cause
    if isinstance(array, np.ma.MaskedArray) and np.ma.is_masked(array):
        hidden = np.atleast_1d(np.ma.getmaskarray(array))
        raise NonFiniteError(
            "an array hides some of its values behind a mask, which would be lost",
            vertices=np.flatnonzero(hidden.reshape(len(hidden), -1).any(axis=1)),
            remedy="Fill them: f.filled(0). Or leave these vertices out with repair(mesh, "
            "remove_vertices=f.mask).",
        )
    if given.dtype.kind not in "biuf":
        raise DimensionError(f"an array of real numbers is needed, not of type {given.dtype}")
    return given


def as_floats(array: ArrayLike) -> Floats:
    """Return an array of float64; DimensionError if it has ragged rows, or things not real."""
    return rectangular(array).astype(np.float64, copy=False)


def as_function(f: ArrayLike, n: int, what: str = FUNCTION) -> Floats:
    """Check a function on n vertices: shape (n,) or (n, c), every value finite.

    Chapter items: D5.

    Raises
    ------
    DimensionError
        If it has not n rows, or more than two axes.
    NonFiniteError
        If a value is NaN or infinite; ``error.vertices`` names the rows.
    """
    values = np.ascontiguousarray(rectangular(f), dtype=np.float64)
    if values.ndim not in (1, 2) or len(values) != n:
        raise DimensionError(
            f"{what} has the shape {values.shape} where ({n},) or ({n}, c) is needed",
            remedy="Give one row for each vertex.",
        )
    require_finite(values, what, LEAVE_OUT if what.startswith(FUNCTION) else GIVE)
    return values


def require_finite(values: NDArray[Any], what: str, remedy: str = GIVE) -> None:
    """Raise NonFiniteError, with the rows, if a value is NaN or infinite."""
    finite = np.isfinite(values)
    if not finite.all():
        rows = np.flatnonzero(~finite.reshape(len(values), -1).all(axis=1))
        raise NonFiniteError(
            f"{what} has values that are NaN or infinite",
            vertices=rows,
            remedy=remedy,
        )


def as_indices(indices: ArrayLike, n: int, what: str, repeated: bool = False) -> Integers:
    """Check a list of indices into n things, or a boolean mask of n values.

    Raises
    ------
    MeshError
        If an index is not an integer in 0..n-1; ``error.vertices`` lists them. Also for n zeros
        and ones, which are a mask by mistake, unless things may well be ``repeated``.
    """
    given = rectangular(indices)
    if given.dtype == np.bool_ and given.shape == (n,):
        return np.flatnonzero(given).astype(np.int64)
    if given.size == 0:
        return np.zeros(0, np.int64)
    if given.dtype.kind not in "iu":
        raise MeshError(f"{what} must be integers or a mask of {n} truth values")
    if not repeated and given.shape == (n,) and n > 2 and given.min() >= 0 and given.max() <= 1:
        raise MeshError(
            f"{what} are {n} zeros and ones, which are no list of indices",
            remedy="Give a mask as truth values: mask.astype(bool).",
        )
    flat = given.astype(np.int64).ravel()
    outside = flat[(flat < 0) | (flat >= n)]
    if len(outside):
        raise MeshError(f"{what} outside 0..{n - 1}", vertices=outside)
    return flat


def whole(name: str, value: Any, least: int, most: int = 2**53) -> int:
    """Return a whole number from ``least`` to ``most``.

    Raises
    ------
    MeshError
        If it is not an integer, or too small or large.

    Examples
    --------
    >>> whole("nx", 4, least=1)
    4
    """
    try:
        if isinstance(value, bool):
            raise TypeError
        number = operator.index(value)
    except TypeError:
        raise MeshError(f"{name} is {shown(value)} where a whole number is needed") from None
    if number < least:
        raise MeshError(f"{name} is {number} where {least} or more is needed")
    if number > most:
        raise MeshError(f"{name} is {number} where {most} at the most is possible")
    return number
