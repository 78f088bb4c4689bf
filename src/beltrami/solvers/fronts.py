"""The multifrontal factorisation: each block of columns is a small dense matrix (I. Duff, J. Reid).

The panel of a block takes its entries of the matrix and what its children subtract from it, is
factorised by BLAS-3, and leaves on a stack what it subtracts from the columns after it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel
from beltrami.solvers.blas import N, T, cholesky_in_place, divide_right, subtract_square


@kernel
def factorize_fronts(
    indptr: Any,
    indices: Any,
    data: Any,
    scale: Any,
    order: Any,
    place: Any,
    starts: Any,
    children: Any,
    siblings: Any,
    row_starts: Any,
    rows: Any,
    panels: Any,
    b: Any,
    values: Any,
    stack: Any,
    stack_at: Any,
    local: Any,
    target: Any,
) -> int:
    """Fill ``values`` (zero before) with the Cholesky factor of the scaled, permuted matrix.

    Returns -1, or the column that has no pivot; what would be its square stays on its diagonal.
    Workspace: ``stack``, ``stack_at`` (s,), ``local`` (n,), ``target`` (tallest,).
    """  # fmt: skip
    width = values.itemsize
    top = 0
    for i in range(starts.size - 1):
        first, columns = starts[i], starts[i + 1] - starts[i]
        below = row_starts[i + 1] - row_starts[i]
        height = columns + below
        for t in range(columns):
            local[first + t] = t
        for t in range(below):
            local[rows[row_starts[i] + t]] = columns + t
        panel = values[panels[i] : panels[i + 1]]
        enter(indptr, indices, data, scale, order, place, first, columns, height, local, panel)
        update = stack[top : top + below * below]
        update[:] = 0
        base = top
        child = children[i]
        while child >= 0:
            count = row_starts[child + 1] - row_starts[child]
            for t in range(count):
                target[t] = local[rows[row_starts[child] + t]]
            at = stack_at[child]
            square = stack[at : at + count * count]
            add(
                square,
                np.uint64(count),
                target,
                np.uint64(columns),
                np.uint64(below),
                panel,
                update,
            )
            base = min(base, at)
            child = siblings[child]
        diagonal = panel.ctypes.data
        failed = cholesky_in_place(b, columns, diagonal, height)
        if failed:
            return first + failed - 1
        if below:
            under = diagonal + width * columns
            divide_right(b, T, N, below, columns, diagonal, height, under, height)
            subtract_square(b, below, columns, under, height, update.ctypes.data, below)
        if base < top:
            for t in range(below * below):
                stack[base + t] = update[t]
        stack_at[i] = base
        top = base + below * below
    return -1


@kernel
def enter(
    indptr: Any,
    indices: Any,
    data: Any,
    scale: Any,
    order: Any,
    place: Any,
    first: int,
    columns: int,
    height: int,
    local: Any,
    panel: Any,
) -> None:
    """Add the entries of the matrix on and below the diagonal of a block."""
    begin, one = np.uint64(0), np.uint64(1)
    for t in range(np.uint64(first), np.uint64(first + columns)):
        v = np.uint64(order[t])
        for q in range(np.uint64(indptr[v]), np.uint64(indptr[v + one])):
            w = np.uint64(indices[q])
            p = np.uint64(place[w])
            if p >= t:
                panel[begin + np.uint64(local[p])] += data[q] * scale[v] * scale[w]
        begin += np.uint64(height)


@kernel
def add(
    square: Any, count: Any, target: Any, columns: Any, below: Any, panel: Any, update: Any
) -> None:
    """Add the lower triangle of a child's update to its parent's panel and update.

    Row and column t go to ``target[t]``, which ascends: the panel first, then what is below it.
    """
    height = columns + below
    j = source = np.uint64(0)
    while j < count and target[j] < columns:
        to = target[j] * height
        for i in range(j, count):
            panel[to + target[i]] += square[source + i]
        source += count
        j += np.uint64(1)
    for i in range(j, count):
        target[i] -= columns
    while j < count:
        to = target[j] * below
        for i in range(j, count):
            update[to + target[i]] += square[source + i]
        source += count
        j += np.uint64(1)
