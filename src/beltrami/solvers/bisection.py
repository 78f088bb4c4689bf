"""Numbers that cut a set of vertices in two: along its longest direction, or by its graph."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel

_TURNS = 12  # of the power iteration: the direction need not be exact
_ROUNDS = 3  # of averaging, which breaks the ties of whole numbers of steps


@kernel
def project_on_longest_direction(x: Any, order: Any, low: int, high: int, key: Any) -> None:
    """Write into key[t] the place of vertex order[t] along the first principal axis of its set."""
    count = high - low
    a0 = a1 = a2 = 0.0
    for t in range(low, high):
        v = order[t]
        a0 += x[v, 0]
        a1 += x[v, 1]
        a2 += x[v, 2]
    a0, a1, a2 = a0 / count, a1 / count, a2 / count
    xx = xy = xz = yy = yz = zz = 0.0
    for t in range(low, high):
        v = order[t]
        p, q, r = x[v, 0] - a0, x[v, 1] - a1, x[v, 2] - a2
        xx, xy, xz = xx + p * p, xy + p * q, xz + p * r
        yy, yz, zz = yy + q * q, yz + q * r, zz + r * r
    p, q, r = 1.0, 0.9, 0.8
    for _ in range(_TURNS):
        u, v, w = xx * p + xy * q + xz * r, xy * p + yy * q + yz * r, xz * p + yz * q + zz * r
        length = np.sqrt(u * u + v * v + w * w)
        if length > 0:  # all points in one place: any direction will do
            p, q, r = u / length, v / length, w / length
    for t in range(low, high):
        i = order[t]
        key[t] = p * x[i, 0] + q * x[i, 1] + r * x[i, 2]


@kernel
def walk(
    indptr: Any, indices: Any, start: int, owner: Any, mine: int, level: Any, queue: Any, at: int
) -> int:
    """Visit the part of a set that is connected to ``start``, nearest first.

    The set is where owner == mine, and level < 0 on it. Writes the vertices into queue[at:] and
    their steps from the start into level; returns the end in the queue.
    """
    queue[at] = start
    level[start] = 0
    end = at + 1
    while at < end:
        v = queue[at]
        at += 1
        for q in range(indptr[v], indptr[v + 1]):
            w = indices[q]
            if owner[w] == mine and level[w] < 0:
                level[w] = level[v] + 1
                queue[end] = w
                end += 1
    return end


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
    """Write into key[t] how much farther order[t] is from one end of its set than from the other.

    The set is connected, its vertices have owner == mine, and a walk from anywhere in it stands
    in queue[low:high]. Its last vertex is one end, the other is the last of a walk from there.
    Averaging the differences over the neighbours a few times makes the level lines smooth.
    """  # fmt: skip
    start = queue[high - 1]
    for _ in range(2):
        for t in range(low, high):
            far[order[t]] = level[order[t]]
            level[order[t]] = -1
        walk(indptr, indices, start, owner, mine, level, queue, low)
        start = queue[high - 1]
    for t in range(low, high):
        v = order[t]
        value[v] = far[v] - level[v]
    for _ in range(_ROUNDS):
        for t in range(low, high):
            v = order[t]
            total, count = value[v], 1
            for q in range(indptr[v], indptr[v + 1]):
                w = indices[q]
                if owner[w] == mine and w != v:
                    total += value[w]
                    count += 1
            key[t] = total / count
        for t in range(low, high):
            value[order[t]] = key[t]
    for t in range(low, high):
        level[order[t]] = -1
