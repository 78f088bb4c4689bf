"""Half-edges: one pass over the faces pairs their sides into edges."""

from __future__ import annotations

from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Integers, read_only
from beltrami._jit import kernel, unsigned
from beltrami.errors import MeshError

BOUNDARY = -1  # the twin of a side that no other face shares
NOT_MANIFOLD = -2  # the twin of a side that more than two faces share
_MOST = 2**31 - 1  # half-edges or vertices


class HalfEdges(NamedTuple):
    """The sides of the faces, paired.

    Side ``c`` of a face is the one opposite its corner ``c``: it runs from corner ``c + 1`` to
    corner ``c + 2``, and its half-edge has the number ``3 f + c``.

    Chapter items: P9.

    Attributes
    ----------
    edges : (p, 2) int
        Each edge once, as (i, j) with i < j, in lexicographic order.
    face_edges : (m, 3) int32
        The edge of each side; -1 in a face that names a vertex twice, which has no sides.
    twins : (m, 3) int32
        The half-edge on the other side; ``BOUNDARY`` or ``NOT_MANIFOLD`` where there is not one.
    n_boundary : int
        How many edges have one face.
    n_crowded : int
        How many edges have more than two faces.
    disoriented : int
        How many edges with two faces are run through in the same direction by both.
    complete : bool
        Whether every face has its three sides, that is, names no vertex twice.
    """

    edges: Integers
    face_edges: NDArray[np.int32]
    twins: NDArray[np.int32]
    n_boundary: int
    n_crowded: int
    disoriented: int
    complete: bool


def pair_sides(faces: Integers, n: int) -> HalfEdges:
    """Pair the sides of the faces of a mesh with n vertices; O(n + m) for bounded valence.

    Chapter items: U3, U8, U17, P6, P9.

    Raises
    ------
    MeshError
        If there are 2³¹ half-edges or vertices, or more: their numbers have 32 bits.

    Examples
    --------
    >>> import numpy as np
    >>> sides = pair_sides(np.array([[0, 1, 2], [2, 1, 3]]), 4)
    >>> sides.edges.tolist()
    [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]]
    >>> sides.twins.tolist()  # side 0 of face 0 is side 2 of face 1
    [[5, -1, -1], [-1, -1, 0]]
    """
    m = len(faces)
    if max(3 * m, n) > _MOST:
        raise MeshError(f"{m:,} faces and {n:,} vertices have numbers of more than 32 bits")
    boundary = max(2 * n - m, 0)  # as many edges as a disk of these counts has there
    corners = unsigned(faces)
    paired = _paired(corners, n, boundary + m // 5 + 2)
    if paired is None:
        paired = cast(HalfEdges, _paired(corners, n, 3 * m))  # room for all sides is enough
    return paired


# The sides are sorted by (smaller vertex, larger vertex) with two stable counting sorts, the
# larger first: no comparison, and hardly a branch that the processor guesses wrong. A side is
# packed into one integer: the vertex that still has to be sorted by (after that, the other one)
# times 2³², plus twice its half-edge, plus 1 if it runs from the smaller to the larger vertex.
# First touches of memory are dear, and the results have room for the sides: once sorted by the
# larger vertex they lie where face_edges and twins will be, then where the edges will be.


def _paired(corners: Any, n: int, room: int) -> HalfEdges | None:
    """Pair the sides; None if an edge would be written over sides that are not yet read.

    An edge is as long as two sides. The sorted sides begin ``room`` of them behind the edges,
    which is enough if no more edges have one side only.
    """
    m = len(corners)
    by_low, by_high = np.zeros((2, n), np.uint32)
    total = int(_count_sides(corners, by_low, by_high))
    room = min(room, total)
    edges = np.empty((total, 2), np.int64)  # the pages beyond the last edge are never touched
    ends = unsigned(edges).reshape(-1)
    ordered = ends[room : room + total]
    of_sides = np.empty((2, m, 3), np.int32)
    _sort_sides(corners, by_low, by_high, of_sides.reshape(-1).view(np.uint64), ordered)
    complete = total == 3 * m
    if not complete:  # faces that name a vertex twice have no sides
        of_sides[0], of_sides[1] = -1, BOUNDARY
    face_edges, twins = of_sides
    p, boundary, crowded, disoriented = _number_edges(
        ordered, by_low, room, ends, face_edges.ravel(), twins.ravel()
    )
    if p < 0:
        return None
    arrays = (read_only(edges[:p]), read_only(face_edges), read_only(twins))
    return HalfEdges(*arrays, int(boundary), int(crowded), int(disoriented), complete)


@kernel
def _count_sides(faces: Any, by_low: Any, by_high: Any) -> Any:
    """Count the sides by smaller and by larger vertex, then turn the counts into starts."""
    one = np.uint64(1)
    m = np.uint64(faces.shape[0])
    f = np.uint64(0)
    while f < m:
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        if i != j and j != k and k != i:
            by_low[min(i, j)] += 1
            by_low[min(j, k)] += 1
            by_low[min(k, i)] += 1
            by_high[max(i, j)] += 1
            by_high[max(j, k)] += 1
            by_high[max(k, i)] += 1
        f += one
    low = high = 0
    for v in range(by_low.size):
        of_low, of_high = by_low[v], by_high[v]
        by_low[v], by_high[v] = low, high
        low += of_low
        high += of_high
    return low


@kernel
def _sort_sides(faces: Any, by_low: Any, by_high: Any, sides: Any, ordered: Any) -> None:
    """Sort the sides; on return ``by_low[v]`` is the end of the bucket of v."""
    one, two, four = np.uint64(1), np.uint64(2), np.uint64(4)
    six, half = np.uint64(6), np.uint64(32)
    m = np.uint64(faces.shape[0])
    f = h = np.uint64(0)
    while f < m:
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        if i != j and j != k and k != i:
            high = max(j, k)
            sides[np.uint64(by_high[high])] = (min(j, k) << half) | h | np.uint64(j < k)
            by_high[high] += 1
            high = max(k, i)
            sides[np.uint64(by_high[high])] = (min(k, i) << half) | (h + two) | np.uint64(k < i)
            by_high[high] += 1
            high = max(i, j)
            sides[np.uint64(by_high[high])] = (min(i, j) << half) | (h + four) | np.uint64(i < j)
            by_high[high] += 1
        h += six
        f += one
    n = np.uint64(by_high.size)
    high = q = np.uint64(0)
    while high < n:
        end = np.uint64(by_high[high])
        while q < end:
            low = sides[q] >> half
            ordered[np.uint64(by_low[low])] = (high << half) | (sides[q] & np.uint64(0xFFFFFFFF))
            by_low[low] += 1
            q += one
        high += one


@kernel
def _number_edges(
    ordered: Any, by_low: Any, room: Any, ends: Any, face_edges: Any, twins: Any
) -> Any:
    """Run through the sorted sides: neighbours with the same ends are the sides of one edge.

    Returns -1 as the number of edges if their ends would come to lie on sides not yet read.
    """
    one, half, code = np.uint64(1), np.uint64(32), np.uint64(0xFFFFFFFF)
    n, free = np.uint64(by_low.size), np.uint64(room)
    low = p = q = np.uint64(0)
    boundary = crowded = disoriented = 0
    while low < n:
        end = np.uint64(by_low[low])
        while q < end:
            high = ordered[q] >> half
            first = ordered[q] & code
            face_edges[first >> one] = p
            begin = q
            q += one
            if q < end and ordered[q] >> half == high:
                second = ordered[q] & code
                face_edges[second >> one] = p
                twins[first >> one] = second >> one
                twins[second >> one] = first >> one
                q += one
                if q < end and ordered[q] >> half == high:
                    crowded += 1
                    while q < end and ordered[q] >> half == high:
                        face_edges[(ordered[q] & code) >> one] = p
                        q += one
                    for s in range(begin, q):
                        twins[(ordered[s] & code) >> one] = -2
                else:
                    disoriented += int((first ^ second ^ one) & one)
            else:
                boundary += 1
                twins[first >> one] = -1
            if p + p + one >= free + q:
                return -1, 0, 0, 0
            ends[p + p] = low
            ends[p + p + one] = high
            p += one
        low += one
    return np.int64(p), boundary, crowded, disoriented
