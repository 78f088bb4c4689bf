"""Drawings by Schnyder woods: every triangulated disk, without a fold, in whole numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel
from beltrami.errors import MeshError, NotADiskError
from beltrami.mesh.topology import Topology

LARGEST = 1 << 24  # vertices up to which the determinants of whole numbers are exact in doubles


def draw(disk: Topology) -> Floats:
    r"""Return a bijection of a disk to the plane, at points with whole coordinates below 2n.

    A wood is three trees: every inner edge of a triangulation of a triangle belongs to one of
    them, and three paths from each vertex, to the three corners, cut the triangle into three
    regions. The numbers of faces in these are barycentric coordinates of an embedding (W.
    Schnyder, Embedding planar graphs on the grid, 1990). No geometry enters, so no geometry can
    make it fail, and nothing is rounded; it is as ugly as that sounds. A boundary of more than
    three vertices is closed by one more vertex outside, which is then left out: the boundary
    of the image is simple, not convex.

    Parameters
    ----------
    disk
        The faces of an oriented disk, each vertex in one of them.

    Returns
    -------
    (n, 2) positions.

    Raises
    ------
    NotADiskError
        If the surface is none.
    MeshError
        If it has more than 2²⁴ vertices: determinants would no longer be exact.

    Notes
    -----
    Vertices are taken away from the outer boundary one by one, those without a chord first, which
    gives the wood (E. Brehm, 3-orientations and Schnyder 3-tree-decompositions, 2000); regions
    are sums over the trees. Cost: O(n).

    Examples
    --------
    >>> draw(Topology([[0, 1, 3], [1, 2, 3], [2, 0, 3]])).tolist()
    [[0.0, 0.0], [3.0, 0.0], [0.0, 3.0], [1.0, 1.0]]
    """
    if len(disk.boundary_loops) != 1 or disk.euler_characteristic != 1 or disk.n_components != 1:
        raise NotADiskError("a drawing needs a disk")
    if disk.n_vertices > LARGEST:
        raise MeshError(f"drawings of more than {LARGEST} vertices would not be exact")
    n, loop = disk.n_vertices, disk.boundary_loops[0]
    if len(loop) == 3:
        size, outside = n, loop[[0, 2, 1]][None]
    else:
        size = n + 1
        outside = np.stack([np.roll(loop, -1), loop, np.full(len(loop), n)], axis=1)
    closed = Topology(np.concatenate([disk.faces, outside]), size)
    corners = np.array([loop[0], loop[1], loop[2] if size == n else n])
    twins = closed.twins.astype(np.int64)
    twins = 3 * (twins // 3) + (twins % 3 + 1) % 3  # from sides to the corners where they begin
    parents = np.full((3, size), -1, np.int64)
    order = _shell(closed.faces, np.roll(twins, -2, axis=1).ravel(), corners, parents)
    regions = _regions(order, parents, corners)
    return np.ascontiguousarray(regions[1:, :n].T, dtype=np.float64)


@kernel
def _shell(faces: Any, twins: Any, corners: Any, parents: Any) -> Any:
    """Take vertices away from the outer path, from corner 0 to corner 1; fill the parents.

    Side h = 3 f + c goes from corner c of face f to the next; ``twins[h]`` comes back. The path
    is kept as the side from each of its vertices to the one before. Returns the vertices in the
    order in which they went; the parents 0 and 1 of a vertex go later, the parent 2 went earlier.
    """
    n = parents.shape[1]
    start, end, top = corners[0], corners[1], corners[2]
    outside = np.zeros(n, np.bool_)
    outside[corners] = True
    chords = np.zeros(n, np.int64)
    to_left = np.full(n, -1, np.int64)
    after, fresh = np.full(n, -1, np.int64), np.full(n, -1, np.int64)
    for h in range(faces.size):
        i, j = faces[h // 3, h % 3], faces[h // 3, (h + 1) % 3]
        if (i == top and j == start) or (i == end and j == top):
            to_left[i] = h
    after[start], after[top] = top, end
    waiting = np.empty(4 * n, np.int64)
    waiting[0], count = top, 1
    order, gone = np.empty(n - 2, np.int64), 0
    while count:
        count -= 1
        v = waiting[count]
        if not outside[v] or chords[v] or v in (start, end):
            continue
        order[gone] = v
        outside[v] = False
        left, right = faces[twins[to_left[v]] // 3, twins[to_left[v]] % 3], after[v]
        if v != top:
            parents[0, v], parents[1, v] = left, right
        h, u, added = to_left[v], left, 0
        while u != right:  # the neighbours below, from the left to the right
            f, c = h // 3, h % 3
            w = faces[f, (c + 2) % 3]
            to_left[w] = twins[3 * f + (c + 1) % 3]
            after[u] = w
            if w != right:
                parents[2, w], outside[w], fresh[w] = v, True, gone
                added += 1
            h, u = twins[3 * f + (c + 2) % 3], w
        if added == 0:  # the chord from the left to the right is a part of the path now
            for w in (left, right):
                chords[w] -= 1
                if chords[w] == 0:
                    waiting[count] = w
                    count += 1
        w = after[left]
        while w != right:
            before = faces[twins[to_left[w]] // 3, twins[to_left[w]] % 3]
            g = first = to_left[w]
            while True:
                x = faces[twins[g] // 3, twins[g] % 3]
                if outside[x] and x != before and x != after[w]:
                    chords[w] += 1
                    chords[x] += 0 if fresh[x] == gone else 1
                g = twins[3 * (g // 3) + (g + 2) % 3 if g % 3 != 2 else g - 1]
                if g == first:
                    break
            if chords[w] == 0:
                waiting[count] = w
                count += 1
            w = after[w]
        gone += 1
    return order[:gone]


@kernel
def _regions(order: Any, parents: Any, corners: Any) -> Any:
    """Count the faces in the three regions of each vertex, by sums over the trees."""
    n = parents.shape[1]
    inner = n - 3
    weight = np.ones((3, n), np.int64)  # of the subtree at a vertex, itself included
    for q in range(1, inner + 1):
        for tree in range(3):
            v = order[q] if tree < 2 else order[inner + 1 - q]
            weight[tree, parents[tree, v]] += weight[tree, v]
    depth = np.ones((3, n), np.int64)  # vertices on the path to the corner, with both ends
    along = np.zeros((3, 3, n), np.int64)  # [i, j]: weights in tree i, along the path in tree j
    for j in range(3):
        for i in range(3):
            along[i, j, corners[j]] = 1
        for q in range(1, inner + 1):
            v = order[q] if j == 2 else order[inner + 1 - q]
            up = parents[j, v]
            depth[j, v] += depth[j, up]
            for i in range(3):
                along[i, j, v] = along[i, j, up] + weight[i, v]
    faces = np.zeros((3, n), np.int64)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        for q in range(1, inner + 1):
            v = order[q]
            vertices = along[i, j, v] + along[i, k, v] - weight[i, v]
            faces[i, v] = 2 * vertices - (depth[j, v] + depth[k, v] - 1) - 2
        faces[i, corners[i]] = 2 * n - 5
    return faces
