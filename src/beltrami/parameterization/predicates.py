"""Exact signs: which way three points of the plane turn."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats

_ERROR = (3 + 16 * 2.0**-53) * 2.0**-53  # of the determinant, relative to its two products
_TINY = 1e-280  # below which a product may have lost digits to underflow
_UNIT = 1 << 1074  # every double is an integer times its inverse


def orientation(a: Floats, b: Floats, c: Floats) -> NDArray[np.int8]:
    r"""Return 1 where a, b, c turn left, -1 where they turn right, 0 where they are in line.

    The sign of :math:`(a - c) \times (b - c)` is exact: where the rounding of the products could
    reach it (the filter of J. R. Shewchuk, Adaptive precision floating-point arithmetic, 1997) it
    is computed anew in integers, in which all doubles can be written.

    Parameters
    ----------
    a, b, c
        (q, 2) points, finite.

    Returns
    -------
    (q,) int8. Cost: O(q), and some microseconds for each row that is nearly in line.

    Examples
    --------
    >>> orientation(np.array([[0.1, 0.1]]), np.array([[0.2, 0.2]]), np.array([[0.3, 0.3]])).item()
    0
    >>> orientation(np.array([[0.1, 0.3]]), np.array([[0.2, 0.6]]), np.array([[0.3, 0.9]])).item()
    1
    """
    with np.errstate(all="ignore"):
        left = (a[:, 0] - c[:, 0]) * (b[:, 1] - c[:, 1])
        right = (a[:, 1] - c[:, 1]) * (b[:, 0] - c[:, 0])
        size = np.abs(left) + np.abs(right)
        difference = left - right
        sure = (np.abs(difference) > _ERROR * size) & (size > _TINY) & (size < np.inf)
    signs = np.sign(difference, where=sure, out=np.zeros(len(a))).astype(np.int8)
    for q in np.flatnonzero(~sure):
        signs[q] = _exact(*a[q].tolist(), *b[q].tolist(), *c[q].tolist())
    return signs


def _exact(*coordinates: float) -> int:
    """Return the sign of the determinant in integers."""
    ratios = [x.as_integer_ratio() for x in coordinates]
    ax, ay, bx, by, cx, cy = (p * (_UNIT // q) for p, q in ratios)
    determinant = (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)
    return (determinant > 0) - (determinant < 0)
