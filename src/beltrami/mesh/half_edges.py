"""Half-edges: one pass over the faces pairs their sides into edges."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Integers, read_only
from beltrami._jit import kernel

BOUNDARY = -1  # the twin of a side that no other face shares
NOT_MANIFOLD = -2  # the twin of a side that more than two faces share


class HalfEdges(NamedTuple):
    """The sides of the faces, paired.

    Side ``c`` of a face is the one opposite its corner ``c``: it runs from corner ``c + 1`` to
    corner ``c + 2``, and its half-edge has the number ``3 f + c``.

    Attributes
    ----------
    edges : (p, 2) int
        Each edge once, as (i, j) with i < j, in lexicographic order.
    face_edges : (m, 3) int32
        The edge of each side; -1 in a face that names a vertex twice, which has no sides.
    twins : (m, 3) int32
        The half-edge on the other side; ``BOUNDARY`` or ``NOT_MANIFOLD`` where there is not one.
    edge_face_count : (p,) int32
        How many faces share each edge.
    disoriented : int
        How many edges with two faces are run through in the same direction by both.
    complete : bool
        Whether every face has its three sides, that is, names no vertex twice.
    """

    edges: Integers
    face_edges: NDArray[np.int32]
    twins: NDArray[np.int32]
    edge_face_count: NDArray[np.int32]
    disoriented: int
    complete: bool


def pair_sides(faces: Integers, n: int) -> HalfEdges:
    """Pair the sides of the faces of a mesh with n vertices; O(n + m) for bounded valence.

    Examples
    --------
    >>> import numpy as np
    >>> sides = pair_sides(np.array([[0, 1, 2], [2, 1, 3]]), 4)
    >>> sides.edges.tolist()
    [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]]
    >>> sides.twins.tolist()  # side 0 of face 0 is side 2 of face 1
    [[5, -1, -1], [-1, -1, 0]]
    """
    by_low = np.zeros(n + 1, np.int32)
    by_high = np.zeros(n + 1, np.int32)
    _count_sides(faces, by_low, by_high)
    total = int(by_low[n])
    sides = np.empty(total, np.int64)
    ordered = np.empty(total, np.int64)
    _sort_sides(faces, by_low, by_high, sides, ordered)
    edges = np.empty((total, 2), np.int64)  # the pages beyond the last edge are never touched
    face_edges = np.empty((len(faces), 3), np.int32)
    twins = np.empty((len(faces), 3), np.int32)
    count = np.empty(total, np.int32)
    complete = total == 3 * len(faces)
    if not complete:  # faces that name a vertex twice have no sides
        face_edges[:], twins[:] = -1, BOUNDARY
    p, disoriented = _number_edges(ordered, by_low, edges, face_edges.ravel(), twins.ravel(), count)
    arrays = (read_only(edges[:p]), read_only(face_edges), read_only(twins), read_only(count[:p]))
    return HalfEdges(*arrays, int(disoriented), complete)


# The sides are sorted by (smaller vertex, larger vertex) with two stable counting sorts, the
# larger first: no comparison, and hardly a branch that the processor guesses wrong. A side is
# packed into one integer: the vertex that still has to be sorted by (after that, the other one)
# times 2³², plus twice its half-edge, plus 1 if it runs from the smaller to the larger vertex.
# The buffers come from numpy, which asks for huge pages: first touches are a third of the cost.


@kernel
def _count_sides(faces: Any, by_low: Any, by_high: Any) -> None:
    """Count the sides of each smaller and of each larger vertex; leave the starts of buckets."""
    n = by_low.size - 1
    for f in range(faces.shape[0]):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        if i != j and j != k and k != i:
            by_low[min(i, j) + 1] += 1
            by_low[min(j, k) + 1] += 1
            by_low[min(k, i) + 1] += 1
            by_high[max(i, j) + 1] += 1
            by_high[max(j, k) + 1] += 1
            by_high[max(k, i) + 1] += 1
    for v in range(n):
        by_low[v + 1] += by_low[v]
        by_high[v + 1] += by_high[v]


@kernel
def _sort_sides(faces: Any, by_low: Any, by_high: Any, sides: Any, ordered: Any) -> None:
    """Sort the sides; on return ``by_low[v]`` is the end of the bucket of v."""
    for f in range(faces.shape[0]):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        if i != j and j != k and k != i:
            h = 6 * f
            high = max(j, k)
            sides[by_high[high]] = (min(j, k) << 32) | (h + (j < k))
            by_high[high] += 1
            high = max(k, i)
            sides[by_high[high]] = (min(k, i) << 32) | (h + 2 + (k < i))
            by_high[high] += 1
            high = max(i, j)
            sides[by_high[high]] = (min(i, j) << 32) | (h + 4 + (i < j))
            by_high[high] += 1
    begin = 0
    for high in range(by_high.size - 1):
        for q in range(begin, by_high[high]):
            low = sides[q] >> 32
            ordered[by_low[low]] = (high << 32) | (sides[q] & 0xFFFFFFFF)
            by_low[low] += 1
        begin = by_high[high]


@kernel
def _number_edges(
    ordered: Any, by_low: Any, edges: Any, face_edges: Any, twins: Any, count: Any
) -> Any:
    """Run through the sorted sides: equal neighbours are the sides of one edge."""
    p = q = disoriented = 0
    for low in range(by_low.size - 1):
        while q < by_low[low]:
            high = ordered[q] >> 32
            begin = q
            while q < by_low[low] and ordered[q] >> 32 == high:
                face_edges[(ordered[q] & 0xFFFFFFFF) >> 1] = p
                q += 1
            first = ordered[begin] & 0xFFFFFFFF
            if q - begin == 2:
                second = ordered[begin + 1] & 0xFFFFFFFF
                twins[first >> 1] = second >> 1
                twins[second >> 1] = first >> 1
                disoriented += (first ^ second ^ 1) & 1
            elif q - begin == 1:
                twins[first >> 1] = -1
            else:
                for s in range(begin, q):
                    twins[(ordered[s] & 0xFFFFFFFF) >> 1] = -2
            edges[p, 0] = low
            edges[p, 1] = high
            count[p] = q - begin
            p += 1
    return p, disoriented
