"""Half-edges: one pass over the faces pairs their sides into edges."""

from __future__ import annotations

from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Integers, read_only, unwritten
from beltrami._jit import kernel, part_of_kernels, unsigned
from beltrami.errors import MeshError
from beltrami.mesh.numbering import BEHIND, number_edges

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


# The sides are counted and filled into the buckets of their smaller vertices, without a comparison
# that the processor could guess wrong; ``numbering`` pairs them there. First touches of memory are
# dear, and the sides lie where the edges will be.


def _paired(corners: Any, n: int, room: int) -> HalfEdges | None:
    """Pair the sides; None if an edge would be written over sides that are not yet read.

    An edge is as long as two sides. The sides begin ``room`` of them behind the edges, which is
    enough if no more edges have one side only.
    """
    m = len(corners)
    scratch = unwritten(3 * n, np.uint32)
    sizes, cursors = scratch[:n], scratch[n:].reshape(n, 2)
    total = int(_count_sides(corners, sizes, cursors))
    room = min(room, total)
    ends = unwritten(room + total + BEHIND, np.int64)
    words = unsigned(ends)
    sides = words[room:]
    of_sides = unwritten((2, m, 3), np.int32)
    complete = total == 3 * m
    if not complete:  # faces that name a vertex twice have no sides
        of_sides[0], of_sides[1] = -1, BOUNDARY
    face_edges, twins = of_sides
    p, boundary, crowded, disoriented = _fill_and_number(
        corners, cursors, sizes, sides, room, words, face_edges.ravel(), twins.ravel()
    )
    if p < 0:
        return None
    edges = ends[: 2 * p].reshape(p, 2)
    arrays = (read_only(edges), read_only(face_edges), read_only(twins))
    return HalfEdges(*arrays, int(boundary), int(crowded), int(disoriented), complete)


@kernel
def _count_sides(faces: Any, sizes: Any, cursors: Any) -> Any:
    """Count the sides by smaller vertex; return their number.

    ``cursors[v]`` are set to the first and the last place of the bucket of v.
    """
    one = np.uint64(1)
    m = np.uint64(faces.shape[0])
    n = np.uint64(sizes.size)
    f = v = total = np.uint64(0)
    while v < n:
        sizes[v] = 0
        v += one
    while f < m:
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        if i != j and j != k and k != i:
            sizes[i if i < j else j] += one
            sizes[j if j < k else k] += one
            sizes[k if k < i else i] += one
        f += one
    v = np.uint64(0)
    while v < n:
        cursors[v, 0] = total
        total += np.uint64(sizes[v])
        cursors[v, 1] = total - one
        v += one
    return total


@kernel
def _fill_and_number(
    faces: Any,
    cursors: Any,
    sizes: Any,
    sides: Any,
    room: Any,
    ends: Any,
    face_edges: Any,
    twins: Any,
) -> Any:
    """Fill the buckets, and number the edges in them: see ``number_edges``."""
    _fill_buckets(faces, cursors, sides)
    return number_edges(sides, cursors, sizes, room, ends, face_edges, twins)


@part_of_kernels
def _fill_buckets(faces: Any, cursors: Any, sides: Any) -> None:
    """Fill the buckets: from the front with sides that run upwards, from the back with others.

    On return ``cursors[v, 0]`` is where the upward sides of v end.
    """
    one, three = np.uint64(1), np.uint64(3)
    m = np.uint64(faces.shape[0])
    f = h = np.uint64(0)
    while f < m:
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        if i != j and j != k and k != i:
            _put(j, k, h, cursors, sides)
            _put(k, i, h + one, cursors, sides)
            _put(i, j, h + one + one, cursors, sides)
        h += three
        f += one


@part_of_kernels
def _put(a: Any, b: Any, h: Any, cursors: Any, sides: Any) -> None:
    """Put the half-edge h from a to b into its bucket."""
    low, high = (b, a) if b < a else (a, b)
    down = np.uint64(b < a)
    place = cursors[low, down]
    sides[np.uint64(place)] = (high << np.uint64(32)) | h
    cursors[low, down] = place + np.uint32(np.uint64(1) - down - down)
