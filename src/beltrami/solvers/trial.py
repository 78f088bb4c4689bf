"""Is a factor worth anything? One solve tells: the residual, and how the solution grows."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import csc_array

SINGULAR = 2e14  # a condition above this, and the matrix is singular to working precision
_SEED = 306_519_227


def trial(matrix: csc_array, factor: Any) -> tuple[float, float]:
    """Solve for a random right-hand side: a bound from below on the condition, backward error.

    Both are for the matrix scaled to a diagonal of ones, so that units do not count, and infinite
    where there is no factor.
    """
    if factor is None:
        return np.inf, np.inf
    n = matrix.shape[0]
    diagonal = np.abs(matrix.diagonal())
    scale = np.sqrt(np.where(diagonal > 0, diagonal, 1))
    b = 1 + np.random.default_rng(_SEED).standard_normal(n) / 2  # rich in constants
    with np.errstate(all="ignore"):
        x = factor.solve(scale * b)
        largest = float(np.abs(x * scale).max())
        norm = float((abs(matrix) @ (1 / scale) / scale).max())
        residual = float(np.abs((matrix @ x) / scale - b).max())
        return norm * largest / float(np.abs(b).max()), residual / (norm * largest)
