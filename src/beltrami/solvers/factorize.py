"""factorize: choose a backend by facts, and say which."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike
from scipy.sparse import csc_array, issparse

from beltrami._arrays import Floats
from beltrami.errors import (
    BeltramiError,
    DimensionError,
    NonFiniteError,
    NotPositiveDefiniteError,
    check_name,
)
from beltrami.solvers.cholesky import Cholesky, factorize_cholesky, singular
from beltrami.solvers.factor import REFINE_ABOVE, Factor
from beltrami.solvers.ordering import ORDERINGS, as_positions, order
from beltrami.solvers.superlu import factorize_superlu
from beltrami.solvers.symmetry import is_symmetric, rows_against_definite
from beltrami.solvers.trial import SINGULAR, trial

BACKENDS = ("auto", "cholesky", "superlu")
SMALL = 5000  # unknowns below which SuperLU is as fast, and has no kernels to load


def factorize(
    A: Any,
    coordinates: ArrayLike | None = None,
    backend: str = "auto",
    *,
    ordering: str = "auto",
    dtype: DTypeLike = np.float64,
) -> Factor:
    """Factorise a square sparse matrix, to solve with it many times.

    Parameters
    ----------
    A
        (n, n) scipy sparse matrix or array.
    coordinates
        (n, d) positions of the unknowns, by which Cholesky orders: it is faster with them. The
        solution does not depend on them but for its rounding.
    backend
        ``"cholesky"``: our own, for symmetric positive definite matrices.
        ``"superlu"``: LU with exchanges of rows, for every invertible matrix.
        ``"auto"``: Cholesky for 5000 unknowns or more if the matrix turns out to be symmetric
        positive definite, SuperLU for all others. The one used is told by ``Factor.backend``.
    ordering
        Of Cholesky: nested dissection by ``"positions"``, by the ``"graph"`` of the matrix, or
        ``"auto"``: by positions if there are any and they cut well.
    dtype
        float64, or float32 for a Cholesky factor of half the memory; solutions are then refined
        to the residuals of float64, or refused where the matrix is too nearly singular for that.

    Raises
    ------
    DimensionError
        If A is not sparse and square, or ``coordinates`` has not n rows.
    NonFiniteError
        If A or the coordinates have entries that are NaN or infinite.
    SingularMatrixError
        If A is singular to working precision; ``error.rows`` names the row without a pivot where
        Cholesky found it.
    NotPositiveDefiniteError
        If Cholesky was asked for and A is not symmetric positive definite; ``error.rows``.
    UnknownNameError, BeltramiError
        If there is no such backend, ordering or dtype.

    Notes
    -----
    Cholesky is supernodal and multifrontal, over the BLAS of scipy; SuperLU orders symmetric
    matrices by minimum degree on A' + A. On a surface mesh the cost is about n^1.5 operations and
    n log n memory. One trial solve is part of it: it tells singular matrices, and whether
    solutions need refinement.

    Examples
    --------
    >>> import scipy.sparse
    >>> factor = factorize(scipy.sparse.csr_array([[4.0, 1.0], [1.0, 3.0]]))
    >>> factor.solve([1.0, 2.0]).round(6).tolist(), factor.backend
    ([0.090909, 0.636364], 'superlu')
    """
    check_name("backend", backend, BACKENDS)
    check_name("ordering", ordering, ORDERINGS)
    matrix = _checked(A)
    n = matrix.shape[0]
    positions = None if coordinates is None else as_positions(coordinates, n)
    kind = np.dtype(dtype)
    if kind not in (np.float64, np.float32):
        raise BeltramiError(f"factors are float64 or float32, not {kind}")
    half = kind == np.float32
    if half and backend == "superlu":
        raise BeltramiError("SuperLU factorises in float64 only")
    if backend == "cholesky" or half or (backend == "auto" and n >= SMALL):
        try:
            return _by_cholesky(matrix, positions, ordering, kind)
        except NotPositiveDefiniteError:
            if backend == "cholesky" or half:
                raise
    solver = factorize_superlu(matrix, is_symmetric(matrix))
    return Factor(matrix, "superlu", False, solver)


def _checked(A: Any) -> csc_array:
    """Return the matrix by columns, rows sorted, every entry once and not zero."""
    shape: tuple[int, ...] = getattr(A, "shape", ())
    if not issparse(A) or len(shape) != 2 or shape[0] != shape[1]:
        what = shape or type(A).__name__
        raise DimensionError(f"a square scipy sparse matrix is needed, and this is {what}")
    given: Any = A
    if not shape[0] or given.dtype.kind not in "biuf":
        raise DimensionError("a matrix to factorise is real, and not empty")
    matrix = csc_array(given, dtype=np.float64)
    if not np.isfinite(matrix.data).all():
        raise NonFiniteError("the matrix has entries that are NaN or infinite")
    if not matrix.has_canonical_format or not matrix.data.all():
        matrix = matrix.copy()
        matrix.sum_duplicates()
        matrix.eliminate_zeros()
    return matrix


def _by_cholesky(matrix: csc_array, positions: Floats | None, ordering: str, dtype: Any) -> Factor:
    """Factorise with Cholesky and try the factor on one right-hand side."""
    against = rows_against_definite(matrix)
    if len(against):
        raise NotPositiveDefiniteError(against)
    elimination = order(matrix, positions, ordering)
    solver: Cholesky = factorize_cholesky(matrix, elimination, dtype)
    condition, error = trial(matrix, solver)
    if not condition < SINGULAR:
        raise singular(int(elimination.order[np.argmin(solver.pivots)]))
    return Factor(matrix, "cholesky", not error <= REFINE_ABOVE, solver)
