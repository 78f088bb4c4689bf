"""Which entries the factor has: the rows of each block of columns, before any number is known."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Integers
from beltrami._jit import kernel
from beltrami.solvers.dissection import Dissection

GROUP = 16  # rows of a front that are treated together
_FEW = 48  # rows that are sorted by insertion


@dataclass(frozen=True, eq=False)
class Elimination:
    """The shape of a factor: dense panels, one for each block of the dissection.

    Panel i has the columns of block i, and as rows those columns and ``rows`` of it. It is stored
    by columns, from ``panels[i]`` on; the entries above its diagonal are room without meaning.

    Attributes
    ----------
    order : (n,) int, the unknown eliminated t-th; ``place`` : (n,) int, its inverse
    starts : (s + 1,) int, the first column of each block
    children, siblings : (s,) int, the tree as lists: the first child, the next sibling, or -1
    row_starts : (s + 1,) int into rows; rows : int32, ascending within each panel
    panels : (s + 1,) int, where each panel starts in the factor
    widest, tallest : the largest number of columns, and of rows below them
    stack : the numbers that the updates of the children need at most, at one time
    """

    order: Integers
    place: Integers
    starts: Integers
    children: Integers
    siblings: Integers
    row_starts: Integers
    rows: NDArray[np.int32]
    panels: Integers
    widest: int
    tallest: int
    stack: int

    @property
    def entries(self) -> int:
        """Number of entries of the factor on and below its diagonal."""
        columns = np.diff(self.starts)
        return int((columns * (columns + 1) // 2 + columns * np.diff(self.row_starts)).sum())


def eliminate(indptr: Integers, indices: NDArray[np.int32], dissection: Dissection) -> Elimination:
    """Find the rows of each panel: those of its matrix entries, and those left by its children."""
    order, starts, parents = dissection.order, dissection.starts, dissection.parents
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    children, siblings = _lists(parents)
    row_starts, rows = _rows(indptr, indices, order, place, starts, children, siblings)
    columns, below = np.diff(starts), np.diff(row_starts)
    panels = np.concatenate([[0], np.cumsum(columns * (columns + below))])
    return Elimination(
        order, place, starts, children, siblings, row_starts, rows, panels,
        int(columns.max()), int(below.max()), _stack(children, siblings, below),
    )  # fmt: skip


@kernel
def stride(below: Any) -> Any:
    """Return the numbers from one column of an update to the next: whole groups of rows."""
    return -(-below // GROUP) * GROUP


@kernel
def _lists(parents: Any) -> Any:
    """Return the first child of each block, and its next sibling; -1 where there is none."""
    children, siblings = np.full(parents.size, -1, np.int64), np.full(parents.size, -1, np.int64)
    for i in range(parents.size - 1, -1, -1):
        if parents[i] >= 0:
            siblings[i] = children[parents[i]]
            children[parents[i]] = i
    return children, siblings


@kernel
def _rows(
    indptr: Any, indices: Any, order: Any, place: Any, starts: Any, children: Any, siblings: Any
) -> Any:
    """Return where the rows of each panel start, and the rows."""
    blocks = starts.size - 1
    row_starts = np.zeros(blocks + 1, np.int64)
    rows = np.empty(8 * order.size + 1024, np.int32)
    seen = np.full(order.size, -1, np.int64)
    for i in range(blocks):
        first, last = starts[i], starts[i + 1]
        end = row_starts[i]
        most = order.size - last  # rows that this panel can have
        if end + most > rows.size:
            needed = 0
            for t in range(first, last):
                needed += indptr[order[t] + 1] - indptr[order[t]]
            child = children[i]
            while child >= 0:
                needed += row_starts[child + 1] - row_starts[child]
                child = siblings[child]
            if end + min(most, needed) > rows.size:
                larger = np.empty(2 * rows.size + min(most, needed), np.int32)
                for t in range(end):
                    larger[t] = rows[t]
                rows = larger
        for t in range(first, last):
            v = order[t]
            for q in range(indptr[v], indptr[v + 1]):
                p = place[indices[q]]
                if p >= last and seen[p] != i:
                    seen[p] = i
                    rows[end] = p
                    end += 1
        child = children[i]
        while child >= 0:
            for q in range(row_starts[child], row_starts[child + 1]):
                p = rows[q]
                if p >= last and seen[p] != i:
                    seen[p] = i
                    rows[end] = p
                    end += 1
            child = siblings[child]
        _ascend(rows, row_starts[i], end)
        row_starts[i + 1] = end
    return row_starts, rows[: row_starts[blocks]].copy()


@kernel
def _ascend(rows: Any, low: int, high: int) -> None:
    """Sort rows[low:high], which are few most times, in place."""
    if high - low > _FEW:
        rows[low:high] = np.sort(rows[low:high])
        return
    for t in range(np.uint64(low), np.uint64(high)):
        row = rows[t]
        k: Any = t
        while k > np.uint64(low) and rows[k - np.uint64(1)] > row:
            rows[k] = rows[k - np.uint64(1)]
            k -= np.uint64(1)
        rows[k] = row


@kernel
def _stack(children: Any, siblings: Any, below: Any) -> int:
    """Return the room for updates: each block puts its update on top, and takes its children's."""
    top = highest = 0
    for i in range(children.size):
        room = below[i] * stride(below[i])
        highest = max(highest, top + room)
        child = children[i]
        while child >= 0:
            top -= below[child] * stride(below[child])
            child = siblings[child]
        top += room
    return highest
