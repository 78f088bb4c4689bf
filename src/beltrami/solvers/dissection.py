"""Nested dissection: an order of elimination that fills little (A. George, 1973).

A set of vertices is cut in two; few vertices separate the sides, and are eliminated last, after
both sides have been treated likewise. Where positions are known a plane across the longest
direction cuts, at its thinnest place (``cutting``); where they are not, the vertices about as near
to one end of the graph as to the other do. Then the separator is made smaller (``refinement``).
Sets of few vertices are ordered by their degrees (``leaves``).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel, unsigned
from beltrami.solvers.bisection import compare_steps, project_on_longest_direction, walk
from beltrami.solvers.cutting import PLACES, cut
from beltrami.solvers.leaves import MOST, order_leaf
from beltrami.solvers.refinement import refine

LEAF = MOST  # sets of this size are not cut further


@dataclass(frozen=True, eq=False)
class Dissection:
    """An order of elimination, in blocks of consecutive unknowns that form a tree.

    Attributes
    ----------
    order
        (n,) int: the unknown eliminated t-th.
    starts
        (s + 1,) int: block i holds order[starts[i] : starts[i + 1]].
    parents
        (s,) int: the smallest block that separates block i from the rest, or -1. Later than i.
    """

    order: Integers
    starts: Integers
    parents: Integers

    @property
    def squares(self) -> float:
        """Sum of the squares of the sizes of the blocks: small where the cuts were."""
        return float((np.diff(self.starts).astype(np.float64) ** 2).sum())


def dissect(
    indptr: Integers, indices: NDArray[np.int32], coordinates: Floats | None, leaf: int = LEAF
) -> Dissection:
    """Order the unknowns of a symmetric pattern, by their positions (n, 3) if there are any.

    Cost: O(log n) passes over the matrix.
    """
    n = len(indptr) - 1
    positions = np.zeros((0, 3)) if coordinates is None else coordinates
    order, firsts, parents = _dissect(unsigned(indptr), unsigned(indices), positions, leaf)
    rank = np.argsort(firsts)
    number = np.full(n + 1, -1, np.int64)
    number[firsts[rank]] = np.arange(len(rank))
    # parents are told by their first unknown; -1 reads the last number, which stays -1
    return Dissection(order.view(np.int64), np.append(firsts[rank], n), number[parents[rank]])


@kernel
def _dissect(indptr: Any, indices: Any, x: Any, leaf: int) -> Any:
    """Return the order, and the first unknown of each block and of its parent (-1: none)."""
    n = indptr.size - 1
    order, owner, moved = (
        np.arange(n).astype(np.uint64),
        np.full(n, -1, np.int64),
        np.empty(n, np.uint64),
    )
    key, reach, bins = np.empty(n), np.empty((n, 2)), np.empty((PLACES, 3), np.int64)
    near, state, log, steps = (
        np.empty((n, 2), np.int64),
        np.zeros(n, np.int8),
        np.empty(n, np.uint64),
        np.empty(n, np.int64),
    )
    walks = n if x.shape[0] == 0 else 0
    level, far, value = np.full(walks, -1, np.int64), np.empty(walks, np.int64), np.empty(walks)
    slot, ends, above = np.full(n, -1, np.int64), np.empty(MOST, np.int64), np.empty(MOST, np.int64)
    tasks, sizes = np.empty((n, 3), np.int64), np.empty(3, np.int64)
    firsts, parents = np.empty(n, np.int64), np.empty(n, np.int64)
    tasks[0, 0], tasks[0, 1], tasks[0, 2] = 0, n, -1
    waiting, blocks, mine = 1, 0, 0
    while waiting:
        waiting -= 1
        low, high, parent = tasks[waiting, 0], tasks[waiting, 1], tasks[waiting, 2]
        if high - low <= leaf:
            count = order_leaf(indptr, indices, order, low, high, slot, ends, above)
            begin = low
            for k in range(count):
                firsts[blocks + k] = begin
                begin = low + ends[k]
                parents[blocks + k] = parent if above[k] < 0 else low + ends[above[k] - 1]
            blocks += count
            continue
        mine += 3
        for t in range(np.uint64(low), np.uint64(high)):
            owner[order[t]] = mine
        if walks:
            end = walk(indptr, indices, order[low], owner, mine, level, moved, low)
            if end < high:
                waiting = _part(
                    indptr, indices, order, low, high, owner, mine, level, moved, end,
                    leaf, tasks, waiting, parent,
                )  # fmt: skip
                continue
            compare_steps(
                indptr, indices, order, low, high, owner, mine, level, far, moved, key, value
            )
        else:
            project_on_longest_direction(x, order, low, high, key)
        cut(indptr, indices, order, low, high, owner, mine, key, reach, bins)
        _gather(order, low, high, owner, mine, sizes, moved)
        refine(indptr, indices, owner, mine, sizes, moved, near, state, log, steps)
        left, right = _arrange(order, low, high, owner, mine, sizes, moved)
        if right < high:
            firsts[blocks], parents[blocks] = right, parent
            blocks += 1
            parent = right
        for begin, end in ((left, right), (low, left)):
            if begin < end:
                tasks[waiting, 0], tasks[waiting, 1], tasks[waiting, 2] = begin, end, parent
                waiting += 1
    return order, firsts[:blocks], parents[:blocks]


@kernel
def _gather(order: Any, low: int, high: int, owner: Any, mine: int, sizes: Any, found: Any) -> None:
    """List the separator in ``found``, and count it and its sides."""
    sizes[0] = sizes[1] = sizes[2] = 0
    for t in range(np.uint64(low), np.uint64(high)):
        v = order[t]
        at = owner[v] - mine
        if at == 2:
            found[sizes[2]] = v
        sizes[at] += 1


@kernel
def _arrange(order: Any, low: int, high: int, owner: Any, mine: int, sizes: Any, moved: Any) -> Any:
    """Reorder order[low:high]: the larger side, the other, the separator; return where they end.

    The larger first, because its updates need more room than those that wait for it.
    """
    larger = 0 if sizes[0] >= sizes[1] else 1
    left = low + sizes[larger]
    right = left + sizes[1 - larger]
    first, second, third = np.uint64(low), np.uint64(left), np.uint64(right)
    for t in range(np.uint64(low), np.uint64(high)):
        v = order[t]
        at = owner[v] - mine
        if at == 2:
            owner[v] = -1
            moved[third] = v
            third += np.uint64(1)
        elif at == larger:
            moved[first] = v
            first += np.uint64(1)
        else:
            moved[second] = v
            second += np.uint64(1)
    for t in range(np.uint64(low), np.uint64(high)):
        order[t] = moved[t]
    return left, right


@kernel
def _part(
    indptr: Any,
    indices: Any,
    order: Any,
    low: int,
    high: int,
    owner: Any,
    mine: int,
    level: Any,
    moved: Any,
    end: int,
    leaf: int,
    tasks: Any,
    waiting: int,
    parent: int,
) -> int:
    """Make tasks of the connected parts of a set, small ones together; return their number.

    The first part stands in moved[low:end] already.
    """  # fmt: skip
    begin, part = low, low
    t = low
    while True:
        if end - begin > leaf and part > begin:  # what came before this part is full
            tasks[waiting, 0], tasks[waiting, 1], tasks[waiting, 2] = begin, part, parent
            waiting += 1
            begin = part
        if end == high:
            break
        while level[order[t]] >= 0:
            t += 1
        part, end = end, walk(indptr, indices, order[t], owner, mine, level, moved, end)
    tasks[waiting, 0], tasks[waiting, 1], tasks[waiting, 2] = begin, high, parent
    for t in range(low, high):
        order[t] = moved[t]
        level[moved[t]] = -1
    return waiting + 1
