"""Fans: the faces around a vertex, joined through the edges they share (the link test)."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Integers, read_only
from beltrami._jit import kernel


class Fans(NamedTuple):
    """The corners of the faces, grouped into fans.

    Two corners at one vertex are in the same fan if their faces share a side that ends there and
    that exactly two faces share. A vertex with one fan and no edge of more than two faces has a
    link that is one cycle (interior) or one path (boundary): the definition of a manifold
    (l. 95 of the chapter, erratum E9).

    Attributes
    ----------
    root : (3m,) int32
        A representative corner of the fan of each corner; -1 in faces that name a vertex twice.
    of_vertex : (n,) int32
        The number of fans of each vertex.
    """

    root: NDArray[np.int32]
    of_vertex: NDArray[np.int32]


def group_corners(faces: Integers, twins: NDArray[np.int32], n: int) -> Fans:
    """Group the corners of the faces into fans; O(m).

    Chapter items: P10.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami.mesh.half_edges import pair_sides
    >>> bow_tie = np.array([[0, 1, 2], [0, 3, 4]])  # two faces that meet in vertex 0 alone
    >>> group_corners(bow_tie, pair_sides(bow_tie, 5).twins, 5).of_vertex.tolist()
    [2, 1, 1, 1, 1]
    """
    root, of_vertex = _group_corners(faces, twins, n)
    return Fans(read_only(root), read_only(of_vertex))


@kernel
def _find(root: Any, x: int) -> int:
    """Follow the links to the representative, halving the path on the way."""
    while root[x] != x:
        root[x] = root[root[x]]
        x = root[x]
    return x


@kernel
def _group_corners(faces: Any, twins: Any, n: int) -> Any:
    """Union the corners across each paired side, at both of its ends."""
    m = faces.shape[0]
    root = np.arange(3 * m).astype(np.int32)
    for f in range(m):
        for c in range(3):
            t = twins[f, c]
            if t <= 3 * f + c:
                continue  # no twin, or a pair already seen
            g = t // 3
            for end in range(1, 3):
                v = faces[f, (c + end) % 3]
                d = (t + 1) % 3 if faces[g, (t + 1) % 3] == v else (t + 2) % 3
                a, b = _find(root, 3 * f + (c + end) % 3), _find(root, 3 * g + d)
                root[max(a, b)] = min(a, b)
    count = np.zeros(n, np.int32)
    for f in range(m):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        whole = i != j and j != k and k != i
        for c in range(3):
            h = 3 * f + c
            root[h] = _find(root, h) if whole else -1
            if root[h] == h:
                count[faces[f, c]] += 1
    return root, count
