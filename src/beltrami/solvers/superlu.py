"""SuperLU, which comes with scipy: the backend that is always there."""

from __future__ import annotations

import warnings
from typing import Any

from scipy.sparse import csc_array
from scipy.sparse.linalg import MatrixRankWarning, splu

from beltrami.errors import SingularMatrixError


def factorize_superlu(matrix: csc_array, symmetric: bool) -> Any:
    """Return scipy's SuperLU object; symmetric matrices keep to their diagonal as pivots.

    Raises
    ------
    SingularMatrixError
        If a pivot is exactly zero.
    """
    options: dict[str, Any] = {}
    if symmetric:
        options = {
            "permc_spec": "MMD_AT_PLUS_A",
            "diag_pivot_thresh": 0.0,
            "options": {"SymmetricMode": True},
        }
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", MatrixRankWarning)
            return splu(matrix, **options)
    except (RuntimeError, MatrixRankWarning) as cause:
        raise SingularMatrixError(
            "the matrix is singular: a stiffness alone is, because it maps constants to zero. "
            "Add a mass, or fix a value"
        ) from cause
