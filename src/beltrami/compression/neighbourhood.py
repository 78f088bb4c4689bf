"""Who is next to whom, and the order in which positions are coded: of the faces alone."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Integers
from beltrami._jit import kernel
from beltrami.compression.tables import whole

_BUCKETS = 12


class Neighbourhood(NamedTuple):
    """Neighbours of each vertex and the corners at it, as the arrays of CSR matrices.

    Attributes
    ----------
    starts, around : (n + 1,), (2p,) int32
        The vertices next to each vertex, ascending.
    corner_starts, corner_list : (n + 1,), (3m,) int32
        The corners 3f + c at each vertex, ascending.
    corners : (3m,) int32
        The vertex of each corner.
    opposite : (3m,) int32
        The corner on the other side of the side that a corner faces; -1 without.
    """

    starts: NDArray[np.int32]
    around: NDArray[np.int32]
    corner_starts: NDArray[np.int32]
    corner_list: NDArray[np.int32]
    corners: NDArray[np.int32]
    opposite: NDArray[np.int32]


def look_around(faces: Integers, n: int) -> Neighbourhood:
    """Find neighbours and opposite corners of faces with three vertices; O(m log m).

    Where more than two faces share a side, they are paired in the order of the faces.
    """
    corners = faces.astype(np.int64).ravel()
    start, end = faces[:, [1, 2, 0]].ravel(), faces[:, [2, 0, 1]].ravel()
    key = np.minimum(start, end).astype(np.int64) * n + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    ordered = key[order]
    opposite = np.full(len(key), -1, np.int32)
    _pair(ordered, order, opposite)
    edges = ordered[np.concatenate([[True], ordered[1:] != ordered[:-1]])] if len(key) else ordered
    low, high = np.divmod(edges, max(n, 1))
    directed = np.sort(np.concatenate([low * n + high, high * n + low]))
    first, around = np.divmod(directed, max(n, 1))
    return Neighbourhood(
        _starts(first, n),
        around.astype(np.int32),
        _starts(corners, n),
        np.argsort(corners, kind="stable").astype(np.int32),
        corners.astype(np.int32),
        opposite,
    )


def _starts(rows: Integers, n: int) -> NDArray[np.int32]:
    counts = np.bincount(rows, minlength=n)
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)


@kernel
def _pair(ordered: Any, order: Any, opposite: Any) -> None:
    """Pair neighbours in the sorted list of sides that belong to the same edge."""
    i = 0
    while i + 1 < ordered.size:
        if ordered[i] == ordered[i + 1]:
            opposite[order[i]], opposite[order[i + 1]] = order[i + 1], order[i]
            i += 1
        i += 1


def coding_order(near: Neighbourhood) -> NDArray[np.int32]:
    """Order the vertices: next is the one in the most faces whose two others are done; O(m).

    Among equals the one that got there first; without any, a neighbour of the last one, else the
    first one that is left.
    """
    n = len(near.starts) - 1
    order: NDArray[np.int32] = sweep(near, np.zeros(min(n, 1), np.int64), n)
    return order


@kernel
def sweep(near: Any, seeds: Any, each: int) -> Any:
    """Order some vertices as for coding: ``each`` about every seed, as if the others came later."""
    n = near.starts.size - 1
    done = np.zeros(n, np.bool_)
    faces = np.zeros(n, np.int32)
    order = np.empty(min(n, seeds.size * each), np.int32)
    room = near.corners.size + 1
    following, vertex = np.empty(room, np.int32), np.empty(room, np.int32)
    head, tail = np.full(_BUCKETS, -1, np.int64), np.full(_BUCKETS, -1, np.int64)
    used = seed = 0
    for k in range(order.size):
        v = whole(-1)
        if k % each == 0:
            head[:] = -1
            v = whole(seeds[k // each])
            while done[v]:
                v = (v + 1) % n
        else:
            v = _next(head, following, vertex, done, faces)
        if v < 0:
            while done[seed]:
                seed += 1
            v = _near_last(near, order, k, done, seed)
        done[v] = True
        order[k] = v
        for t in range(near.corner_starts[v], near.corner_starts[v + 1]):
            c = whole(near.corner_list[t])
            a, b = near.corners[c - c % 3 + (c + 1) % 3], near.corners[c - c % 3 + (c + 2) % 3]
            if done[a] == done[b]:
                continue
            u = b if done[a] else a
            faces[u] += 1
            q = min(faces[u], _BUCKETS - 1)
            vertex[used], following[used] = u, -1
            if head[q] < 0:
                head[q] = used
            else:
                following[tail[q]] = used
            tail[q] = used
            used += 1
    return order


@kernel
def _near_last(near: Any, order: Any, k: int, done: Any, seed: int) -> int:
    """Return a neighbour of the last vertex that is not done, or else the seed."""
    if k > 0:
        w = order[k - 1]
        for j in range(near.starts[w], near.starts[w + 1]):
            if not done[near.around[j]]:
                return whole(near.around[j])
    return seed


@kernel
def _next(head: Any, following: Any, vertex: Any, done: Any, faces: Any) -> int:
    """Take the first vertex that waits in the highest bucket; -1 if none waits."""
    for b in range(_BUCKETS - 1, 0, -1):
        while head[b] >= 0:
            u = whole(vertex[head[b]])
            head[b] = following[head[b]]
            if not done[u] and min(faces[u], _BUCKETS - 1) == b:
                return u
    return -1
