"""factorize: choose a backend by facts, and say which."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike
from scipy.sparse import csc_array

from beltrami._arrays import Floats
from beltrami.errors import (
    BeltramiError,
    NotPositiveDefiniteError,
    SingularMatrixError,
    check_name,
    shown,
)
from beltrami.solvers.cholesky import Cholesky, factorize_cholesky, singular
from beltrami.solvers.cholespy import factorize_cholespy
from beltrami.solvers.cholmod import factorize_cholmod
from beltrami.solvers.factor import REFINE_ABOVE, Backend, Factor
from beltrami.solvers.ldl import factorize_ldl, without_pivot
from beltrami.solvers.matrix import as_matrix
from beltrami.solvers.ordering import ORDERINGS, as_positions, order
from beltrami.solvers.pardiso import factorize_pardiso
from beltrami.solvers.superlu import factorize_superlu
from beltrami.solvers.symmetry import (
    is_symmetric,
    rows_against_definite,
    rows_against_symmetric,
)
from beltrami.solvers.trial import SINGULAR, trial

OTHERS: dict[str, Callable[[csc_array], Backend]] = {
    "cholespy": factorize_cholespy,
    "cholmod": factorize_cholmod,
    "pardiso": factorize_pardiso,
}
BACKENDS = ("auto", "cholesky", "ldl", "superlu", *OTHERS)
WORTHLESS = 1e-9  # backward error of a trial of LDL beyond which refinement is not relied on
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

    Chapter items: P41.

    Parameters
    ----------
    A
        (n, n) scipy sparse matrix or array.
    coordinates
        (n, d) positions of the unknowns, by which Cholesky orders: it is faster with them. The
        solution does not depend on them but for its rounding.
    backend
        ``"cholesky"``: our own, for symmetric positive definite matrices.
        ``"ldl"``: likewise without exchanges, for symmetric matrices of any signs; it counts them
        (``Factor.inertia``).
        ``"superlu"``: LU with exchanges of rows, for every invertible matrix.
        ``"cholespy"``, ``"cholmod"`` (definite matrices) and ``"pardiso"`` (every invertible one):
        libraries to compare with, if you have installed them; the ordering is theirs.
        ``"auto"``: from 5000 unknowns on the first of Cholesky, LDL and SuperLU that the matrix
        allows and whose trial solution is good; SuperLU below. The one used is told by
        ``Factor.backend``.
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
        Cholesky or LDL found it. LDL also raises it where only exchanges of rows would help.
    NotPositiveDefiniteError
        If Cholesky was asked for and A is not symmetric positive definite; ``error.rows``.
    UnknownNameError, BeltramiError
        If there is no such backend, ordering or dtype.
    MissingExtraError
        If the library of the backend is not installed.

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
    matrix = as_matrix(A)
    n = matrix.shape[0]
    positions = None if coordinates is None else as_positions(coordinates, n)
    try:
        kind = np.dtype(dtype)
    except TypeError as cause:
        raise BeltramiError(f"factors are float64 or float32, not {shown(dtype)}") from cause
    if kind not in (np.float64, np.float32):
        raise BeltramiError(f"factors are float64 or float32, not {kind}")
    half = kind == np.float32
    if half and backend not in ("auto", "cholesky"):
        raise BeltramiError(f"{backend} factorises in float64 only")
    if half or backend == "cholesky":
        return _by_cholesky(matrix, positions, ordering, kind)
    if backend == "ldl":
        return _by_ldl(matrix, positions, ordering)
    if backend in OTHERS:
        return _by_other(matrix, backend)
    if backend == "superlu" or n < SMALL:
        return Factor(matrix, "superlu", False, factorize_superlu(matrix, is_symmetric(matrix)))
    return _first_that_fits(matrix, positions, ordering)


def _first_that_fits(matrix: csc_array, positions: Floats | None, ordering: str) -> Factor:
    """Try Cholesky, then LDL, then SuperLU, which exchanges rows and takes everything."""
    try:
        return _by_cholesky(matrix, positions, ordering, np.dtype(np.float64))
    except NotPositiveDefiniteError:
        symmetric = not len(rows_against_symmetric(matrix))
    if symmetric:
        try:
            return _by_ldl(matrix, positions, ordering)
        except SingularMatrixError:  # or it needs exchanges: SuperLU tells
            return Factor(matrix, "superlu", False, factorize_superlu(matrix, symmetric))
    return Factor(matrix, "superlu", False, factorize_superlu(matrix, symmetric))


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


def _by_ldl(matrix: csc_array, positions: Floats | None, ordering: str) -> Factor:
    """Factorise without exchanges and try the factor; it must be as good as one with them."""
    pair = rows_against_symmetric(matrix)
    if len(pair):
        raise BeltramiError(
            f"LDL needs a symmetric matrix: entries {pair.tolist()} and {pair[::-1].tolist()} "
            'differ. Use backend="superlu"'
        )
    elimination = order(matrix, positions, ordering)
    solver = factorize_ldl(matrix, elimination)
    condition, error = trial(matrix, solver)
    if not (condition < SINGULAR and error <= WORTHLESS):
        raise without_pivot(int(elimination.order[np.argmin(solver.pivots)]))
    return Factor(matrix, "ldl", not error <= REFINE_ABOVE, solver)


def _by_other(matrix: csc_array, backend: str) -> Factor:
    """Factorise with another library and try the factor: it may be worthless and not say so."""
    solver = OTHERS[backend](matrix)
    condition, error = trial(matrix, solver)
    if not (condition < SINGULAR and error <= WORTHLESS):
        raise SingularMatrixError(
            f"the matrix is singular to working precision, or {backend} cannot do it: its solution "
            f'of a trial has the relative residual {error:.1e}. Try backend="superlu"'
        )
    return Factor(matrix, backend, not error <= REFINE_ABOVE, solver)
