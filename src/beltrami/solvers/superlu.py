"""SuperLU, which comes with scipy: the backend that is always there."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import MatrixRankWarning, splu

from beltrami.errors import SingularMatrixError

_BACKWARD_ERROR = 1e-14  # more than this, and pivots were needed
_CONDITION = 2e14  # more than this, and the matrix is singular to working precision
_SEED = 306_519_227


def factorize_superlu(matrix: csc_array, symmetric: bool) -> Any:
    """Return scipy's SuperLU object, tried on one right-hand side.

    Symmetric matrices are first factorised with their diagonal as pivots, which keeps the fill
    low and is stable for definite ones; if the trial shows that it was not, rows are exchanged.

    Raises
    ------
    SingularMatrixError
        If a pivot is zero, or the solution of the trial grows as it does only for a singular
        matrix.
    """
    if symmetric and _may_be_definite(matrix):
        factor = _splu(
            matrix,
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        condition, error = _trial(matrix, factor)
        if condition < _CONDITION and error <= _BACKWARD_ERROR:
            return factor
    factor = _splu(matrix)
    if not _trial(matrix, factor)[0] < _CONDITION:
        raise SingularMatrixError(
            "the matrix is singular to working precision: a stiffness alone is, because it maps "
            "constants to zero. Add a mass, or fix a value"
        )
    return factor


def _may_be_definite(matrix: csc_array) -> bool:
    """Check what every positive definite matrix satisfies: a_ij² <= a_ii a_jj, a_ii > 0."""
    diagonal = matrix.diagonal()
    if not (diagonal > 0).all():
        return False
    entries = matrix.tocoo()
    scale = diagonal[entries.row] * diagonal[entries.col]
    return bool((entries.data**2 <= scale * (1 + 1e-12)).all())


def _splu(matrix: csc_array, **options: Any) -> Any:
    """Return the factors, or None if a pivot is exactly zero."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", MatrixRankWarning)
            return splu(matrix, **options)
    except (RuntimeError, MatrixRankWarning):
        return None


def _trial(matrix: csc_array, factor: Any) -> tuple[float, float]:
    """Solve for a random right-hand side: a bound from below on the condition, backward error.

    Both are infinite where there is no factor.
    """
    if factor is None:
        return np.inf, np.inf
    n = matrix.shape[0]
    diagonal = np.abs(matrix.diagonal())
    scale = np.sqrt(np.where(diagonal > 0, diagonal, 1))  # of the unknowns: units do not count
    b = 1 + np.random.default_rng(_SEED).standard_normal(n) / 2  # rich in constants
    entries = matrix.tocoo()
    scaled = np.abs(entries.data) / scale[entries.row] / scale[entries.col]
    with np.errstate(all="ignore"):
        x = factor.solve(scale * b) * scale
        norm = float(np.bincount(entries.row, scaled, n).max()) * float(np.abs(x).max())
        residual = (matrix @ (x / scale)) / scale - b
        return norm / float(np.abs(b).max()), float(np.abs(residual).max()) / norm
