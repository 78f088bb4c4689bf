"""CHOLMOD (T. Davis), through scikit-sparse and the SuiteSparse of the system, where they are."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.sparse import csc_array, csc_matrix

from beltrami._arrays import Floats
from beltrami._optional import require
from beltrami.errors import NotPositiveDefiniteError
from beltrami.solvers.symmetry import rows_against_definite


@dataclass(frozen=True, eq=False)
class Cholmod:
    """The factors L D L' of the permuted matrix; ``factor`` is scikit-sparse's object."""

    factor: Any
    pivots: Floats

    @cached_property
    def fill(self) -> int:
        """Number of entries of L; its panels are unpacked to count them."""
        if hasattr(self.factor, "nnz"):
            return int(self.factor.nnz)
        return int(self.factor.L().nnz)

    @property
    def memory(self) -> None:
        """Not told: its panels hold zeros that it does not count."""

    @property
    def inertia(self) -> tuple[int, int]:
        """All are positive, or there would be no factor."""
        return len(self.pivots), 0

    def solve(self, b: Floats) -> Floats:
        """Return x with A x = b, for (n,) or (n, c)."""
        if not b.size:
            return np.zeros(b.shape)
        solve = self.factor.solve if hasattr(self.factor, "solve") else self.factor.solve_A
        return np.ascontiguousarray(solve(b))

    def logdet(self) -> float:
        """Return log abs det A."""
        return float(np.log(self.pivots).sum())


def factorize_cholmod(matrix: csc_array) -> Cholmod:
    """Factorise a symmetric positive definite matrix; who calls must try the factor.

    scikit-sparse has no wheels: it is compiled against the SuiteSparse of the system, parts of
    which are under the GPL. Both of its interfaces are known, that of 0.4 and that of 0.5.

    Raises
    ------
    MissingExtraError
        If scikit-sparse is not installed.
    NotPositiveDefiniteError
        If the matrix is not definite; ``error.rows`` names the row of the pivot.
    """
    library = require("sksparse.cholmod", "cholmod", 'backend="cholmod"')
    against = rows_against_definite(matrix)
    if len(against):
        raise NotPositiveDefiniteError(against)
    if hasattr(library, "CholeskyFactor"):
        return _with_classes(library, matrix)
    return _with_functions(library, matrix)


def _with_functions(library: Any, matrix: csc_array) -> Cholmod:
    """Factorise through scikit-sparse 0.4."""
    try:
        factor = library.cholesky(csc_matrix(matrix, copy=True))
    except library.CholmodNotPositiveDefiniteError as cause:
        raise NotPositiveDefiniteError(cause.factor.P()[[cause.column]]) from cause
    pivots = np.asarray(factor.D(), dtype=np.float64)
    if not pivots.min() > 0:  # small matrices are factorised without roots, of any signs
        raise NotPositiveDefiniteError(factor.P()[[np.argmin(pivots)]])
    return Cholmod(factor, pivots)


def _with_classes(library: Any, matrix: csc_array) -> Cholmod:
    """Factorise through scikit-sparse 0.5."""
    given = matrix.copy()  # it refuses read-only arrays
    factor = library.CholeskyFactor(given, order="default")
    try:
        factor.factorize(given)
    except library.CholmodNotPositiveDefiniteError as cause:
        column = re.search(r"column (\d+)", str(cause))
        rows = factor.perm[[int(column[1])]] if column else ()
        raise NotPositiveDefiniteError(rows) from cause
    return Cholmod(factor, np.asarray(factor.L.diagonal(), dtype=np.float64) ** 2)
