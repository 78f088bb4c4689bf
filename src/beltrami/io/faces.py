"""Polygons and strips into triangles."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Integers
from beltrami._jit import kernel


def fan(corners: Integers, sizes: Integers) -> Integers:
    """Cut polygons of k >= 3 corners, laid end to end, into k - 2 triangles from the first corner.

    Examples
    --------
    >>> import numpy as np
    >>> fan(np.array([0, 1, 2, 3, 4, 5, 6]), np.array([4, 3])).tolist()
    [[0, 1, 2], [0, 2, 3], [4, 5, 6]]
    """
    return np.asarray(_fan(corners, sizes, int(sizes.sum()) - 2 * len(sizes)))


@kernel
def _fan(corners: Any, sizes: Any, m: int) -> Any:
    faces = np.empty((m, 3), np.int64)
    f = 0
    start = 0
    for size in sizes:
        for c in range(start + 1, start + size - 1):
            faces[f, 0] = corners[start]
            faces[f, 1] = corners[c]
            faces[f, 2] = corners[c + 1]
            f += 1
        start += size
    return faces


def unroll(strip: Integers) -> Integers:
    """Cut triangle strips, parted by -1, into triangles.

    Every second triangle of a strip runs the other way round, so that all have the orientation
    of the first. A triangle that names a vertex twice only serves to turn the strip: it is left
    out, but counted in the alternation.

    Examples
    --------
    >>> import numpy as np
    >>> unroll(np.array([0, 1, 2, 3, 3, 4, -1, 5, 6, 7])).tolist()
    [[0, 1, 2], [2, 1, 3], [5, 6, 7]]
    """
    faces = np.empty((max(len(strip) - 2, 0), 3), np.int64)
    m = _unroll(strip, faces)
    return faces[:m].copy()


@kernel
def _unroll(strip: Any, faces: Any) -> int:
    f = 0
    start = 0  # of the strip we are in
    for c in range(strip.size):
        k = strip[c]
        if k < 0:
            start = c + 1
        elif c - start >= 2:
            i, j = strip[c - 2], strip[c - 1]
            if i != j and j != k and k != i:
                odd = (c - start) % 2 == 1
                faces[f, 0] = j if odd else i
                faces[f, 1] = i if odd else j
                faces[f, 2] = k
                f += 1
    return f


@kernel
def first_outside(corners: Any, n: int) -> int:
    """Return the place of the first index that is not in 0..n-1, or -1.

    Examples
    --------
    >>> import numpy as np
    >>> first_outside(np.array([0, 2, 3, -1]), 3)
    2
    """
    for c in range(corners.size):
        if corners[c] < 0 or corners[c] >= n:
            return c
    return -1
