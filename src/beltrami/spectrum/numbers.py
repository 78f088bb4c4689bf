"""Numbers at the door: counts, and lists of times or energies."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_function, rectangular
from beltrami.errors import BeltramiError


def as_samples(samples: ArrayLike, what: str, *, positive: bool = False) -> Floats:
    """Check one number or a list of finite numbers, which must be >= 0 if they are positive."""
    given = np.atleast_1d(rectangular(samples)).astype(np.float64)
    if given.ndim != 1 or not len(given):
        raise BeltramiError(f"{what} must be a number or a list of numbers")
    values = as_function(given, len(given), what)
    if positive and values.min() < 0:
        raise BeltramiError(f"{what} must be >= 0, not {values.min():g}")
    return values


def as_count(count: int, what: str, least: int = 1) -> int:
    """Check a whole number from ``least`` on."""
    whole = rectangular(count)
    if whole.ndim or whole.dtype.kind not in "iu" or whole < least:
        raise BeltramiError(f"{what} must be a whole number >= {least}, not {count}")
    return int(whole)
