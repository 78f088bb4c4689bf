"""Matrices and right-hand sides at the door of the solvers."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csc_array, issparse

from beltrami._arrays import Floats, rectangular
from beltrami.errors import DimensionError, NonFiniteError


def as_matrix(A: Any) -> csc_array:
    """Return the matrix by columns, rows sorted, every entry once and not zero.

    Raises
    ------
    DimensionError
        If A is not sparse, square, real and not empty.
    NonFiniteError
        If an entry is NaN or infinite.
    """
    shape: tuple[int, ...] = getattr(A, "shape", ())
    if not issparse(A) or len(shape) != 2 or shape[0] != shape[1]:
        what = shape or type(A).__name__
        raise DimensionError(f"a square scipy sparse matrix is needed, and this is {what}")
    given: Any = A
    if not shape[0] or given.dtype.kind not in "biuf":
        raise DimensionError("a matrix to solve with is real, and not empty")
    matrix = csc_array(given, dtype=np.float64)
    if not np.isfinite(matrix.data).all():
        raise NonFiniteError("the matrix has entries that are NaN or infinite")
    if not matrix.has_canonical_format or not matrix.data.all():
        matrix = matrix.copy()
        matrix.sum_duplicates()
        matrix.eliminate_zeros()
    return matrix


def as_right_hand_side(b: ArrayLike, n: int, what: str = "right-hand side") -> Floats:
    """Return b as float64, of the shape (n,) or (n, c).

    Raises
    ------
    DimensionError
        If it has another shape.
    """
    right = np.asarray(rectangular(b), dtype=np.float64)
    if right.ndim not in (1, 2) or len(right) != n:
        raise DimensionError(
            f"the {what} has the shape {right.shape} where ({n},) or ({n}, c) is needed"
        )
    return right
