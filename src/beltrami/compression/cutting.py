"""Cut any faces into closed oriented manifold pieces, and remember how they hung together."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Booleans, Integers
from beltrami._jit import kernel
from beltrami.mesh.fans import group_corners
from beltrami.mesh.topology import Topology


class Pieces(NamedTuple):
    """Closed oriented manifold pieces.

    Attributes
    ----------
    faces : (m', 3) int64
        The faces that have three corners, oriented, then those that close the boundaries.
    twins : (3m',) int64
        The half-edge on the other side of each; half-edge 3f + c is opposite corner c.
    vertex : (n',) int64
        The vertex of the mesh that each vertex of a piece belongs to; -1 for those in the middle
        of a closed boundary.
    source : (k,) int64
        The face of the mesh behind each of the first k faces.
    turned : (k,) bool
        Whether that face was turned over.
    """

    faces: Integers
    twins: Integers
    vertex: Integers
    source: Integers
    turned: Booleans


def cut_into_pieces(topology: Topology) -> Pieces:
    """Cut along edges that do not join exactly two faces, and close every boundary; O(m log m).

    Faces that name a vertex twice are left out. Faces are turned over where that makes the mesh
    oriented. A vertex is in as many pieces as it has fans; each boundary loop gets a vertex of
    its own, and a face from it to each side.

    Examples
    --------
    >>> pieces = cut_into_pieces(Topology([[0, 1, 2], [0, 3, 4]]))  # meet in vertex 0 alone
    >>> len(pieces.faces), pieces.vertex.tolist()
    (8, [0, 1, 2, 0, 3, 4, -1, -1])
    """
    turned = topology.orientation
    turned = np.zeros(topology.n_faces, np.bool_) if turned is None else turned
    proper = topology.face_edges[:, 0] >= 0
    source = np.flatnonzero(proper)
    faces = topology.faces[source]
    turned = turned[source]
    faces[turned] = faces[turned][:, [0, 2, 1]]
    twins = _glue(faces, topology.n_vertices)
    corner, vertex = _number_fans(faces, twins, topology.n_vertices)
    closed, all_twins, loops = _close(corner, twins, len(vertex))
    vertex = np.concatenate([vertex, np.full(loops, -1)])
    return Pieces(closed, all_twins, vertex, source, turned)


def _glue(faces: Integers, n: int) -> NDArray[np.int32]:
    """Return the twin of each side: -1 unless the edge has two sides, in opposite directions."""
    start, end = faces[:, [1, 2, 0]].ravel(), faces[:, [2, 0, 1]].ravel()
    key = np.minimum(start, end) * n + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    ordered = key[order]
    same = ordered[1:] == ordered[:-1]
    alone = np.flatnonzero(
        same & ~np.concatenate([[False], same[:-1]]) & ~np.concatenate([same[1:], [False]])
    )
    a, b = order[alone], order[alone + 1]
    opposite = start[a] == end[b]
    a, b = a[opposite], b[opposite]
    twins = np.full(len(start), -1, np.int32)
    twins[a], twins[b] = b, a
    return twins


def _number_fans(faces: Integers, twins: NDArray[np.int32], n: int) -> tuple[Integers, Integers]:
    """Return (fan of each corner, vertex of each fan), the fans in the order of the corners."""
    root = group_corners(faces, twins.reshape(-1, 3), n).root
    _, first, corner = np.unique(root, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    return rank[corner.ravel()].reshape(-1, 3), faces.ravel()[first[order]]


def _close(faces: Integers, twins: NDArray[np.int32], n: int) -> tuple[Integers, Integers, int]:
    """Put a vertex before each boundary loop, and a face from it to each side."""
    open_sides = np.flatnonzero(twins < 0)
    q, m = len(open_sides), len(faces)
    loop, after = _walk_loops(faces.ravel(), open_sides, n)
    loops = int(loop.max()) + 1 if q else 0
    start = faces[open_sides // 3, (open_sides + 1) % 3]
    end = faces[open_sides // 3, (open_sides + 2) % 3]
    cap = np.stack([n + loop, end, start], axis=1)  # corner 0 is the new vertex
    full = np.concatenate([twins.astype(np.int64), np.empty(3 * q, np.int64)])
    half = 3 * m + 3 * np.arange(q)
    full[open_sides], full[half] = half, open_sides
    full[half + 2] = half[after] + 1  # the side from the new vertex to the end of this one
    full[half[after] + 1] = half + 2
    return np.concatenate([faces, cap]), full, loops


@kernel
def _walk_loops(corners: Any, sides: Any, n: int) -> Any:
    """Follow the boundary: (loop of each open side, the open side after it)."""
    leaving = np.full(n, -1)  # the open side that starts in each vertex: one, in a manifold
    for i in range(sides.size):
        h = sides[i]
        leaving[corners[h - h % 3 + (h + 1) % 3]] = i
    loop = np.full(sides.size, -1)
    after = np.empty(sides.size, np.int64)
    loops = 0
    for first in range(sides.size):
        i = first
        while loop[i] < 0:
            loop[i] = loops
            h = sides[i]
            after[i] = leaving[corners[h - h % 3 + (h + 2) % 3]]
            i = after[i]
        if loop[first] == loops:
            loops += 1
    return loop, after
