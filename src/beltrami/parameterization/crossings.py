"""Crossings: which segments of the plane meet where they should not."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Booleans, Floats, Integers
from beltrami._jit import kernel
from beltrami.parameterization.predicates import orientation


def crossings(points: Floats, segments: Integers) -> Integers:
    """Return the (q, 2) pairs of segments that have more in common than one common end.

    Touching counts. Decided exactly. Cost: O(b log b) for segments whose boxes hardly overlap,
    as those of a boundary; O(b²) at worst.

    Parameters
    ----------
    points
        (n, 2) finite positions.
    segments
        (b, 2) indices of the ends of the segments.

    Examples
    --------
    >>> square = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    >>> crossings(square, np.array([[0, 1], [1, 2], [2, 3], [3, 0]])).tolist()
    []
    >>> crossings(square, np.array([[0, 2], [1, 2], [3, 1]])).tolist()  # the diagonals
    [[0, 2]]
    """
    ends = points[segments]
    low, high = ends.min(axis=1), ends.max(axis=1)
    order = np.argsort(low[:, 0], kind="stable")
    boxes = np.ascontiguousarray(low[order]), np.ascontiguousarray(high[order])
    near = np.empty((4 * len(segments), 2), np.int64)
    found = _near_pairs(*boxes, near)
    if found > len(near):
        near = np.empty((found, 2), np.int64)
        _near_pairs(*boxes, near)
    near = near[:found]
    pairs = np.sort(order[near], axis=1)
    s, t = segments[pairs[:, 0]], segments[pairs[:, 1]]
    meet = _have_common_end(s, t)
    apart = ~meet  # each test where it is needed: a common end would always be in line
    meet[meet], meet[apart] = _overlap(points, s[meet], t[meet]), _cross(points, s[apart], t[apart])
    guilty: Integers = pairs[meet]
    return guilty[np.lexsort(guilty.T[::-1])]


def _have_common_end(s: Integers, t: Integers) -> Booleans:
    return np.asarray((s[:, :, None] == t[:, None, :]).any(axis=(1, 2)))


def _cross(x: Floats, s: Integers, t: Integers) -> Booleans:
    """Say which segments without a common end meet; their boxes do."""
    a, b, c, d = x[s[:, 0]], x[s[:, 1]], x[t[:, 0]], x[t[:, 1]]
    apart_of_s = orientation(a, b, c) * orientation(a, b, d) > 0
    apart_of_t = orientation(c, d, a) * orientation(c, d, b) > 0
    return np.asarray(~apart_of_s & ~apart_of_t)


def _overlap(x: Floats, s: Integers, t: Integers) -> Booleans:
    """Say which segments with a common end leave it in the same direction, or are the same."""
    turned = np.where((s[:, 0] == t[:, 0]) | (s[:, 0] == t[:, 1]), 1, 0)
    rows = np.arange(len(s))
    far_s, at = s[rows, turned], s[rows, 1 - turned]
    far_t = np.where(t[:, 0] == at, t[:, 1], t[:, 0])
    a, b, c = x[far_s], x[at], x[far_t]
    same_way = (np.sign(a - b) == np.sign(c - b)).all(axis=1)
    return np.asarray((far_s == far_t) | ((orientation(a, b, c) == 0) & same_way))


@kernel
def _near_pairs(low: Any, high: Any, pairs: Any) -> int:
    """Write the pairs whose boxes meet, as far as there is room; return how many there are.

    The boxes are sorted by their left sides.
    """
    count, found = low.shape[0], 0
    for i in range(count):
        j = i + 1
        while j < count and low[j, 0] <= high[i, 0]:
            if low[j, 1] <= high[i, 1] and low[i, 1] <= high[j, 1]:
                if found < pairs.shape[0]:
                    pairs[found, 0] = i
                    pairs[found, 1] = j
                found += 1
            j += 1
    return found
