"""SuperLU, which comes with scipy: the backend that is always there."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import MatrixRankWarning, splu

from beltrami._arrays import Floats
from beltrami.errors import SingularMatrixError
from beltrami.solvers.symmetry import rows_against_definite
from beltrami.solvers.trial import SINGULAR, trial

_BACKWARD_ERROR = 1e-14  # more than this, and pivots were needed


@dataclass(frozen=True, eq=False)
class SuperLU:
    """The factors L and U of the permuted matrix; ``factors`` is scipy's object."""

    factors: Any

    @property
    def fill(self) -> int:
        """Number of entries of L and U."""
        return int(self.factors.nnz)

    @property
    def memory(self) -> int:
        """Bytes of the entries, and of their rows."""
        return 12 * self.fill

    @property
    def inertia(self) -> None:
        """Rows were exchanged: the pivots do not tell."""
        return

    def solve(self, b: Floats) -> Floats:
        """Return x with A x = b, for (n,) or (n, c)."""
        return np.asarray(self.factors.solve(b))

    def logdet(self) -> float:
        """Return log abs det A."""
        return float(np.log(np.abs(self.factors.U.diagonal())).sum())


def factorize_superlu(matrix: csc_array, symmetric: bool) -> SuperLU:
    """Factorise with SuperLU, and try the factors on one right-hand side.

    Symmetric matrices are first factorised with their diagonal as pivots, which keeps the fill
    low and is stable for definite ones; if the trial shows that it was not, rows are exchanged.

    Raises
    ------
    SingularMatrixError
        If a pivot is zero, or the solution of the trial grows as it does only for a singular
        matrix.
    """
    if symmetric and not len(rows_against_definite(matrix)):
        factor = _splu(
            matrix,
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        condition, error = trial(matrix, factor)
        if factor and condition < SINGULAR and error <= _BACKWARD_ERROR:
            return factor
    factor = _splu(matrix)
    if not factor or not trial(matrix, factor)[0] < SINGULAR:
        raise SingularMatrixError(
            "the matrix is singular to working precision: a stiffness alone is, because it maps "
            "constants to zero. Add a mass, or fix a value"
        )
    return factor


def _splu(matrix: csc_array, **options: Any) -> SuperLU | None:
    """Return the factors, or None if a pivot is exactly zero."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", MatrixRankWarning)
            return SuperLU(splu(matrix, **options))
    except (RuntimeError, MatrixRankWarning):
        return None
