"""The multifrontal factorisation: each block of columns is a small dense matrix (I. Duff, J. Reid).

The panel of a block takes its entries of the matrix and what its children subtract from it, is
factorised by BLAS-3, and leaves on a stack what it subtracts from the columns after it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel
from beltrami.solvers.blas import N, T, cholesky_in_place, divide_right, subtract_square

NARROW = 12  # columns below which a panel is factorised without BLAS


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
    top = 0
    for i in range(starts.size - 1):
        first, columns = starts[i], starts[i + 1] - starts[i]
        below = row_starts[i + 1] - row_starts[i]
        panel = values[panels[i] : panels[i + 1]]
        update = stack[top : top + below * below]
        base = assemble(
            indptr, indices, data, scale, order, place, starts, children, siblings, row_starts,
            rows, stack, stack_at, local, target, i, panel, update, top,
        )  # fmt: skip
        if columns < NARROW:
            failed = factorize_narrow(panel, np.uint64(columns), np.uint64(columns + below), update)
        else:
            failed = _factorize_wide(b, panel, columns, below, update)
        if failed:
            return first + failed - 1
        top = put_away(stack, stack_at, i, update, np.uint64(below), base, top)
    return -1


@kernel
def assemble(
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
    stack: Any,
    stack_at: Any,
    local: Any,
    target: Any,
    i: int,
    panel: Any,
    update: Any,
    top: int,
) -> int:
    """Sum what the matrix and the children of block i put into its panel and its update.

    Returns where the updates of the children start on the stack, or ``top`` if there are none.
    """  # fmt: skip
    first, columns = starts[i], starts[i + 1] - starts[i]
    below = row_starts[i + 1] - row_starts[i]
    for t in range(columns):
        local[first + t] = t
    for t in range(below):
        local[rows[row_starts[i] + t]] = columns + t
        update[t * below + t : (t + 1) * below] = 0  # above the diagonal nobody looks
    enter(
        indptr, indices, data, scale, order, place, first, columns, columns + below, local, panel
    )  # fmt: skip
    child = children[i]
    while child >= 0:
        count = row_starts[child + 1] - row_starts[child]
        for t in range(count):
            target[t] = local[rows[row_starts[child] + t]]
        at = stack_at[child]
        add(
            stack[at : at + count * count], np.uint64(count), target,
            np.uint64(columns), np.uint64(below), panel, update,
        )  # fmt: skip
        top = min(top, at)
        child = siblings[child]
    return top


@kernel
def put_away(
    stack: Any, stack_at: Any, i: int, update: Any, below: Any, base: int, top: int
) -> int:
    """Move the lower triangle of the update of block i to ``base``; return the top after it."""
    to, source = np.uint64(base), np.uint64(0)
    if base < top:
        for c in range(below):
            for r in range(c, below):
                stack[to + r] = update[source + r]
            to += below
            source += below
    stack_at[i] = base
    return int(base + np.int64(below * below))


@kernel
def _factorize_wide(b: Any, panel: Any, columns: int, below: int, update: Any) -> int:
    """Factorise a panel and subtract from the update, by BLAS; return 0 or the column, from 1."""
    diagonal, height = panel.ctypes.data, columns + below
    failed = cholesky_in_place(b, columns, diagonal, height)
    if below and not failed:
        under = diagonal + panel.itemsize * columns
        divide_right(b, T, N, below, columns, diagonal, height, under, height)
        subtract_square(b, below, columns, under, height, update.ctypes.data, below)
    return failed


@kernel
def factorize_narrow(panel: Any, columns: Any, height: Any, update: Any) -> Any:
    """Do the same by loops: BLAS would take longer to be called than to work."""
    one, two = np.uint64(1), np.uint64(2)
    zero: Any = np.uint64(0)
    at = zero
    for j in range(columns):
        for k in range(j):
            other = k * height
            factor = panel[other + j]
            for r in range(j, height):
                panel[at + r] -= factor * panel[other + r]
        pivot = panel[at + j]
        if not pivot > 0:
            return np.int64(j) + 1
        root = np.sqrt(pivot)
        panel[at + j], inverse = root, 1 / root
        for r in range(j + one, height):
            panel[at + r] *= inverse
        at += height
    below = height - columns
    for c in range(below):
        to = c * below
        k = zero
        while k + one < columns:
            first, second = k * height + columns, (k + one) * height + columns
            p, q = panel[first + c], panel[second + c]
            for r in range(c, below):
                update[to + r] -= p * panel[first + r] + q * panel[second + r]
            k += two
        if k < columns:
            first = k * height + columns
            p = panel[first + c]
            for r in range(c, below):
                update[to + r] -= p * panel[first + r]
    return 0


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
