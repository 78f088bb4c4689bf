"""Nested dissection: an order of elimination that fills little (A. George, 1973).

A set of vertices is cut in two halves of equal size; the vertices of one half that have
neighbours in the other separate them and are eliminated last, after both halves have been
treated likewise. Where positions are known a plane across the longest direction cuts; where they
are not, the vertices as near to one end of the graph as to the other do.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel, unsigned
from beltrami.solvers.bisection import compare_steps, project_on_longest_direction, walk

LEAF = 32  # sets of this size are not cut further


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
    order, key = np.arange(n).astype(np.uint64), np.empty(n)
    owner, moved = np.full(n, -1, np.int64), np.empty(n, np.uint64)
    walks = n if x.shape[0] == 0 else 0
    level, far, value = np.full(walks, -1, np.int64), np.empty(walks, np.int64), np.empty(walks)
    tasks = np.empty((n, 3), np.int64)
    firsts, parents = np.empty(n, np.int64), np.empty(n, np.int64)
    tasks[0] = 0, n, -1
    waiting, blocks, stamp = 1, 0, 0
    while waiting:
        waiting -= 1
        low, high, parent = tasks[waiting]
        if high - low > leaf:
            stamp += 2
            for t in range(low, high):
                owner[order[t]] = stamp
            if walks:
                end = walk(indptr, indices, order[low], owner, stamp, level, moved, low)
                if end < high:
                    waiting = _part(
                        indptr, indices, order, low, high, owner, stamp, level, moved, end,
                        leaf, tasks, waiting, parent,
                    )  # fmt: skip
                    continue
                compare_steps(
                    indptr, indices, order, low, high, owner, stamp, level, far, moved, key, value
                )
            else:
                project_on_longest_direction(x, order, low, high, key)
            middle = (low + high) // 2
            _select(key, order, low, high, middle)
            left, right = _separate(indptr, indices, order, low, middle, high, owner, stamp, moved)
            if right < high:
                firsts[blocks], parents[blocks] = right, parent
                blocks += 1
                parent = right
            for begin, end in ((left, right), (low, left)):
                if begin < end:
                    tasks[waiting] = begin, end, parent
                    waiting += 1
            continue
        firsts[blocks], parents[blocks] = low, parent
        blocks += 1
    return order, firsts[:blocks], parents[:blocks]


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
            tasks[waiting] = begin, part, parent
            waiting += 1
            begin = part
        if end == high:
            break
        while level[order[t]] >= 0:
            t += 1
        part, end = end, walk(indptr, indices, order[t], owner, mine, level, moved, end)
    tasks[waiting] = begin, high, parent
    for t in range(low, high):
        order[t] = moved[t]
        level[moved[t]] = -1
    return waiting + 1


@kernel
def _select(key: Any, order: Any, low: int, high: int, place: int) -> None:
    """Reorder both arrays so that keys before the place are <= those from it on (C. Hoare)."""
    one = np.uint64(1)
    first, last, at = np.uint64(low), np.uint64(high - 1), np.uint64(place)
    while first < last:
        a, b, c = key[first], key[(first + last) // np.uint64(2)], key[last]
        pivot = max(min(a, b), min(max(a, b), c))
        i, j = first, last + one  # j is one more than the place it stands for: it may pass 0
        while i < j:
            while key[i] < pivot:
                i += one
            while key[j - one] > pivot:
                j -= one
            if i < j:
                k = j - one
                key[i], key[k] = key[k], key[i]
                order[i], order[k] = order[k], order[i]
                i += one
                j -= one
        if at < j:
            last = j - one
        elif at >= i:
            first = i
        else:
            return


@kernel
def _separate(
    indptr: Any,
    indices: Any,
    order: Any,
    low: int,
    middle: int,
    high: int,
    owner: Any,
    mine: int,
    moved: Any,
) -> Any:
    """Move the smaller of the two sides of the cut to the end of order[low:high].

    Returns (left, right): the halves are order[low:left] and order[left:right], and no vertex of
    one is a neighbour of the other.
    """  # fmt: skip
    for t in range(middle, high):
        owner[order[t]] = mine + 1
    here = _cut(indptr, indices, order, low, middle, owner, mine + 1, moved)
    there = _cut(indptr, indices, order, middle, high, owner, mine, moved)
    begin, end, other = (low, middle, mine + 1) if here <= there else (middle, high, mine)
    count = _cut(indptr, indices, order, begin, end, owner, other, moved)
    for t in range(count):
        owner[moved[t]] = -1
    kept = begin
    for t in range(begin, high):
        v = order[t]
        if t < end and owner[v] < 0:
            continue
        order[kept] = v
        kept += 1
    for t in range(count):
        order[kept + t] = moved[t]
    return (middle - count if begin == low else middle), kept


@kernel
def _cut(
    indptr: Any, indices: Any, order: Any, begin: int, end: int, owner: Any, other: int, found: Any
) -> int:
    """List the vertices of order[begin:end] that have a neighbour of another owner."""
    count = 0
    one = np.uint64(1)
    for t in range(np.uint64(begin), np.uint64(end)):
        v = order[t]
        for q in range(indptr[v], indptr[v + one]):
            if owner[np.uint64(indices[q])] == other:
                found[count] = v
                count += 1
                break
    return count
