"""What comes into a front, and where it leaves its update: the entries of the matrix and the stack.

Each block of columns takes its entries of the matrix, and the updates that its children left on a
stack; its own update takes their place there.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel
from beltrami.solvers.elimination import stride


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
    step = stride(below)
    for t in range(columns):
        local[first + t] = t
    for t in range(below):
        local[rows[row_starts[i] + t]] = columns + t
        update[t * step + t : t * step + below] = 0  # above the diagonal nobody looks
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
            stack[at : at + count * stride(count)], np.uint64(count), np.uint64(stride(count)),
            target, np.uint64(columns), np.uint64(columns + below), np.uint64(step), panel, update,
        )  # fmt: skip
        top = min(top, at)
        child = siblings[child]
    return top


@kernel
def put_away(
    stack: Any, stack_at: Any, i: int, update: Any, below: int, base: int, top: int
) -> int:
    """Move the lower triangle of the update of block i to ``base``; return the top after it."""
    step = np.uint64(stride(below))
    to, source = np.uint64(base), np.uint64(0)
    if base < top:
        for c in range(np.uint64(below)):
            for r in range(c, np.uint64(below)):
                stack[to + r] = update[source + r]
            to += step
            source += step
    stack_at[i] = base
    return int(base + below * stride(below))


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
    square: Any,
    count: Any,
    across: Any,
    target: Any,
    columns: Any,
    height: Any,
    step: Any,
    panel: Any,
    update: Any,
) -> None:
    """Add the lower triangle of a child's update to its parent's panel and update.

    Row and column t go to ``target[t]``, which ascends: the panel first, then what is below it.
    """
    j = source = np.uint64(0)
    while j < count and target[j] < columns:
        to = target[j] * height
        for i in range(j, count):
            panel[to + target[i]] += square[source + i]
        source += across
        j += np.uint64(1)
    for i in range(j, count):
        target[i] -= columns
    while j < count:
        to = target[j] * step
        for i in range(j, count):
            update[to + target[i]] += square[source + i]
        source += across
        j += np.uint64(1)
