"""The sign of an eigenvector, which mathematics leaves open."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel

_TIE = 1e-6  # entries so nearly as large as the largest would let rounding decide


def fix_signs(X: Floats) -> None:
    """Turn the columns of X in place: of the largest entries (to 1e-6) the first is positive."""
    largest = np.zeros(X.shape[1])
    _largest(X, largest)
    signs = np.zeros(X.shape[1])
    _signs(X, largest * (1 - _TIE), signs)
    X *= signs


@kernel
def _largest(X: Any, largest: Any) -> None:
    for i in range(X.shape[0]):
        x = X[i]
        for j in range(x.size):
            largest[j] = max(largest[j], abs(x[j]))


@kernel
def _signs(X: Any, limit: Any, signs: Any) -> None:
    """Keep the sign of the first entry that reaches the limit; 1 for a column of zeros."""
    for i in range(X.shape[0]):
        x = X[i]
        for j in range(x.size):
            if signs[j] == 0 and abs(x[j]) >= limit[j]:
                signs[j] = -1.0 if x[j] < 0 else 1.0
