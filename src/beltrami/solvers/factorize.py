"""factorize: choose a backend by facts, and say which."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csc_array, issparse

from beltrami.errors import DimensionError, NonFiniteError, check_name
from beltrami.solvers.factor import Factor
from beltrami.solvers.superlu import factorize_superlu

BACKENDS = ("auto", "superlu")


def factorize(A: Any, coordinates: ArrayLike | None = None, backend: str = "auto") -> Factor:
    """Factorise a square sparse matrix, to solve with it many times.

    Chapter items: P41.

    Parameters
    ----------
    A
        (n, n) scipy sparse matrix or array.
    coordinates
        (n, d) positions of the unknowns, for backends that order by them; SuperLU does not.
    backend
        ``"auto"`` or ``"superlu"``. The one used is told by ``Factor.backend``.

    Raises
    ------
    DimensionError
        If A is not sparse and square, or ``coordinates`` has not n rows.
    NonFiniteError
        If A has entries that are NaN or infinite.
    SingularMatrixError
        If A is singular to working precision.
    UnknownNameError
        If there is no such backend.

    Notes
    -----
    Symmetric matrices are ordered by minimum degree on A' + A. On a surface mesh the cost is
    about n^1.5 operations and n log n memory.

    Examples
    --------
    >>> import scipy.sparse
    >>> factor = factorize(scipy.sparse.csr_array([[4.0, 1.0], [1.0, 3.0]]))
    >>> factor.solve([1.0, 2.0]).round(6).tolist(), factor.backend
    ([0.090909, 0.636364], 'superlu')
    """
    check_name("backend", backend, BACKENDS)
    shape: tuple[int, ...] = getattr(A, "shape", ())
    if not issparse(A) or len(shape) != 2 or shape[0] != shape[1]:
        what = shape or type(A).__name__
        raise DimensionError(f"a square scipy sparse matrix is needed, and this is {what}")
    given: Any = A
    if not shape[0] or given.dtype.kind not in "biuf":
        raise DimensionError("a matrix to factorise is real, and not empty")
    matrix = csc_array(given, dtype=np.float64)
    n = matrix.shape[0]
    if coordinates is not None and len(np.asarray(coordinates)) != n:
        raise DimensionError(f"coordinates have not {n} rows")
    if not np.isfinite(matrix.data).all():
        raise NonFiniteError("the matrix has entries that are NaN or infinite")
    difference = abs(matrix - matrix.T)
    scale = abs(matrix.data).max(initial=0.0)
    symmetric = difference.nnz == 0 or float(difference.max()) <= 1e-14 * scale
    solver = factorize_superlu(matrix, symmetric)
    return Factor(n, "superlu", int(solver.nnz), solver)
