"""cholespy (B. Nicolet, W. Jakob): CHOLMOD in a wheel, for definite matrices; extra ``fast``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import csc_array

from beltrami._arrays import Floats
from beltrami._optional import require
from beltrami.errors import NotPositiveDefiniteError
from beltrami.solvers.symmetry import rows_against_definite


@dataclass(frozen=True, eq=False)
class Cholespy:
    """A factor of n unknowns, which solves and tells nothing else; ``factor`` is cholespy's."""

    factor: Any
    n: int

    @property
    def fill(self) -> None:
        """Not told."""

    @property
    def memory(self) -> None:
        """Not told."""

    @property
    def inertia(self) -> tuple[int, int]:
        """All are positive, or there would be no factor."""
        return self.n, 0

    def solve(self, b: Floats) -> Floats:
        """Return x with A x = b, for (n,) or (n, c)."""
        right = np.array(b, dtype=np.float64, order="C")  # a copy: it refuses read-only arrays
        x = np.empty_like(right)
        if right.size:  # it crashes where there is no column
            self.factor.solve(right, x)
        return x

    def logdet(self) -> None:
        """Not told."""


def factorize_cholespy(matrix: csc_array) -> Cholespy:
    """Factorise a symmetric positive definite matrix; who calls must try the factor.

    Raises
    ------
    MissingExtraError
        If cholespy is not installed.
    NotPositiveDefiniteError
        If the matrix is not definite; ``error.rows`` where its entries show it, for cholespy does
        not tell the pivot.
    """
    library = require("cholespy", "fast", 'backend="cholespy"')
    against = rows_against_definite(matrix)  # it would read one triangle, and crash on zeros
    if len(against):
        raise NotPositiveDefiniteError(against)
    starts, rows = matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32)
    n = matrix.shape[0]
    try:
        factor = library.CholeskySolverD(
            n, starts, rows, matrix.data.copy(), library.MatrixType.CSC
        )
    except ValueError as cause:
        raise NotPositiveDefiniteError() from cause
    return Cholespy(factor, n)
