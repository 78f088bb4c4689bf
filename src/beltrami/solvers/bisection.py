"""Numbers that cut a set of vertices in two: along its longest direction, or by its graph."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel

_TURNS = 12  # of the power iteration: the direction need not be exact
_ROUNDS = 3  # of averaging, which breaks the ties of whole numbers of steps


@kernel
def project_on_longest_direction(x: Any, order: Any, low: int, high: int, key: Any) -> None:
    """Write into key[v] the place of each v in order[low:high] along the set's principal axis."""
    first, last, count = np.uint64(low), np.uint64(high), high - low
    o = order[first]  # near the others, so that squares do not cancel
    a0 = a1 = a2 = xx = xy = xz = yy = yz = zz = 0.0
    for t in range(first, last):
        v = order[t]
        p, q, r = x[v, 0] - x[o, 0], x[v, 1] - x[o, 1], x[v, 2] - x[o, 2]
        a0, a1, a2 = a0 + p, a1 + q, a2 + r
        xx, xy, xz = xx + p * p, xy + p * q, xz + p * r
        yy, yz, zz = yy + q * q, yz + q * r, zz + r * r
    xx, xy, xz = xx - a0 * a0 / count, xy - a0 * a1 / count, xz - a0 * a2 / count
    yy, yz, zz = yy - a1 * a1 / count, yz - a1 * a2 / count, zz - a2 * a2 / count
    p, q, r = 1.0, 0.9, 0.8
    for _ in range(_TURNS):
        u, v, w = xx * p + xy * q + xz * r, xy * p + yy * q + yz * r, xz * p + yz * q + zz * r
        length = np.sqrt(u * u + v * v + w * w)
        if length > 0:  # all points in one place: any direction will do
            p, q, r = u / length, v / length, w / length
    for t in range(first, last):
        i = order[t]
        key[i] = p * x[i, 0] + q * x[i, 1] + r * x[i, 2]


@kernel
def walk(
    indptr: Any, indices: Any, start: int, owner: Any, mine: int, level: Any, queue: Any, at: int
) -> Any:
    """Visit the part of a set that is connected to ``start``, nearest first.

    The set is where owner == mine, and level < 0 on it. Writes the vertices into queue[at:] and
    their steps from the start into level; returns the end in the queue.
    """
    one = np.uint64(1)
    next_, end = np.uint64(at), np.uint64(at) + one
    queue[next_] = start
    level[start] = 0
    while next_ < end:
        v = queue[next_]
        next_ += one
        for q in range(indptr[v], indptr[v + one]):
            w = np.uint64(indices[q])
            if owner[w] == mine and level[w] < 0:
                level[w] = level[v] + 1
                queue[end] = w
                end += one
    return np.int64(end)  # numba would make a float of signed and unsigned


@kernel
def compare_steps(
    indptr: Any,
    indices: Any,
    order: Any,
    low: int,
    high: int,
    owner: Any,
    mine: int,
    level: Any,
    far: Any,
    queue: Any,
    key: Any,
    value: Any,
) -> None:
    """Write into key[v] how much farther v in order[low:high] is from one end than from the other.

    The set is connected, its vertices have owner == mine, and a walk from anywhere in it stands
    in queue[low:high]. Its last vertex is one end, the other is the last of a walk from there.
    Averaging the differences over the neighbours a few times makes the level lines smooth.
    """  # fmt: skip
    one, first, last = np.uint64(1), np.uint64(low), np.uint64(high)
    start = queue[last - one]
    for _ in range(2):
        for t in range(first, last):
            far[order[t]] = level[order[t]]
            level[order[t]] = -1
        walk(indptr, indices, start, owner, mine, level, queue, low)
        start = queue[last - one]
    for t in range(first, last):
        v = order[t]
        key[v] = far[v] - level[v]
        level[v] = -1
    for _ in range(_ROUNDS):
        for t in range(first, last):
            v = order[t]
            total, count = key[v], 1
            for q in range(indptr[v], indptr[v + one]):
                w = np.uint64(indices[q])
                if owner[w] == mine and w != v:
                    total += key[w]
                    count += 1
            value[v] = total / count
        for t in range(first, last):
            key[order[t]] = value[order[t]]
