"""The multifrontal factorisation: each block of columns is a small dense matrix (I. Duff, J. Reid).

The panel of a block takes its entries of the matrix and what its children subtract from it, is
factorised, by BLAS-3 or in tiles where it is small, and leaves on a stack what it subtracts from
the columns after it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel
from beltrami.solvers.assembling import assemble, put_away
from beltrami.solvers.blas import N, T, cholesky_in_place, multiply, subtract_square
from beltrami.solvers.elimination import GROUP, stride
from beltrami.solvers.many import forward
from beltrami.solvers.tiles import BELOW, subtract

NARROW = 12  # columns below which a triangle is factorised by loops
SMALL = 96  # columns up to which a front is treated without BLAS
WIDTH = 64  # columns of a larger one at a time
ROOM = GROUP * (max(SMALL, WIDTH) + 1)  # numbers that are copied, and what is not needed
_MINUS, _ONE = 1, 0  # places of the scalars


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
    offsets: Any,
    room: Any,
    lines: Any,
) -> int:
    """Fill ``values`` (zero before) with the Cholesky factor of the scaled, permuted matrix.

    Returns -1, or the column that has no pivot; what would be its square stays on its diagonal.
    Workspace: ``stack``, ``stack_at`` (s,), ``local`` (n,), ``target`` (tallest,), ``offsets``
    (widest + tallest + 8,), ``room`` (ROOM,). ``lines`` of ``tiles`` that hold GROUP numbers.
    """  # fmt: skip
    top = 0
    for i in range(starts.size - 1):
        first, columns = starts[i], starts[i + 1] - starts[i]
        below = row_starts[i + 1] - row_starts[i]
        panel = values[panels[i] : panels[i + 1]]
        update = stack[top : top + below * stride(below)]
        base = assemble(
            indptr, indices, data, scale, order, place, starts, children, siblings, row_starts,
            rows, stack, stack_at, local, target, i, panel, update, top,
        )  # fmt: skip
        failed = _factorize(b, panel, columns, below, update, offsets, room, lines)
        if failed:
            return first + failed - 1
        top = put_away(stack, stack_at, i, update, below, base, top)
    return -1


@kernel
def _factorize(
    b: Any,
    panel: Any,
    columns: int,
    below: int,
    update: Any,
    offsets: Any,
    room: Any,
    lines: Any,
) -> int:
    """Factorise a panel and subtract from its update; return 0, or the column that fails, from 1.

    Some columns at a time: their triangle, then what is below it. BLAS subtracts, but in small
    fronts, where it would take longer to be called than to work.
    """  # fmt: skip
    height, size = columns + below, panel.itemsize
    start, there = panel.ctypes.data, update.ctypes.data
    if columns <= SMALL:
        failed = triangle(b, panel, columns, height)
        if failed == 0 and below:
            descend(panel, 0, columns, below, height, there, below, offsets, room, lines)
        return failed
    for k in range(0, columns, WIDTH):
        width = min(WIDTH, columns - k)
        corner = start + size * (k + k * height)
        failed = cholesky_in_place(b, width, corner, height)
        if failed:
            return k + failed
        right = columns - k - width
        if right + below:
            descend(
                panel, k + k * height, width, right + below, height, there, 0, offsets, room, lines
            )
        under, rest = corner + size * width, corner + size * (width + width * height)
        if right:
            subtract_square(b, right, width, under, height, rest, height)
        if right and below:
            more = size * right
            multiply(
                b, N, T, below, right, width, _MINUS, _ONE, under + more, height, under, height,
                rest + more, height,
            )  # fmt: skip
    if below:
        under = start + size * columns
        subtract_square(b, below, columns, under, height, there, stride(below))
    return 0


@kernel
def triangle(b: Any, panel: Any, columns: int, height: int) -> int:
    """Factorise the square on top of a panel, by loops if BLAS would be slow."""
    if columns >= NARROW:
        return cholesky_in_place(b, columns, panel.ctypes.data, height)
    end, step, at = np.uint64(columns), np.uint64(height), np.uint64(0)
    for j in range(end):
        for k in range(j):
            other = k * step
            factor = panel[other + j]
            for r in range(j, end):
                panel[at + r] -= factor * panel[other + r]
        pivot = panel[at + j]
        if not pivot > 0:
            return int(j) + 1
        root = np.sqrt(pivot)
        panel[at + j], inverse = root, 1 / root
        for r in range(j + np.uint64(1), end):
            panel[at + r] *= inverse
        at += step
    return 0


@kernel
def descend(
    panel: Any,
    corner: int,
    columns: int,
    rows: int,
    height: int,
    update: int,
    below: int,
    offsets: Any,
    room: Any,
    lines: Any,
) -> None:
    """Divide ``rows`` rows under a triangle by it, and subtract their products from an update.

    It is the substitution of ``many``: a column is an unknown, and GROUP rows are as many
    right-hand sides. The triangle starts at panel[corner]. Of the update, an address, the first
    ``below`` columns are treated; its first row is the first under the triangle.
    """  # fmt: skip
    zero, size, rest = panel[0], panel.itemsize, rows % GROUP
    where, step, start = offsets.ctypes.data, size * height, panel.ctypes.data + size * corner
    x, spare = start + size * columns, room.ctypes.data
    for t in range(columns):
        offsets[t] = step * t
    for r in range(0, rows - rest, GROUP):
        forward(zero, x + size * r, where, columns, columns, start, step, lines)
    for t in range(below):
        offsets[columns + t] = update + size * stride(below) * t - x
    for r in range(0, rows - rest if below else 0, GROUP):
        last = min(below, r + GROUP)  # above the diagonal nobody looks
        for t in range(below, last + 7):
            offsets[columns + t] = spare - x - size * r  # eight columns at a time: some are none
        _subtract(zero, x + size * r, where, columns, last, start, step, lines)
    if rest:  # they are copied, for others follow them; an update has room for a whole group
        x += size * (rows - rest)
        at, copies = corner + columns + rows - rest, spare + size * GROUP
        _copy(panel, at, height, columns, rest, room, True)
        for t in range(columns):
            offsets[t] = copies + size * GROUP * t - x
        forward(zero, x, where, columns, columns, start, step, lines)
        _copy(panel, at, height, columns, rest, room, False)
        for t in range(below, below + 7 if below else 0):
            offsets[columns + t] = spare - x
        _subtract(zero, x, where, columns, below, start, step, lines)


@kernel
def _subtract(
    zero: Any, x: int, where: int, columns: int, last: int, panel: int, step: int, lines: Any
) -> None:
    """Subtract from the first columns of an update, eight at a time."""
    for t in range(0, last, 8):
        subtract(zero, x, where, columns + t, 0, columns, panel, step, lines, 8, BELOW)


@kernel
def _copy(
    panel: Any, at: int, height: int, columns: int, rows: int, room: Any, there: bool
) -> None:
    """Copy some rows of a panel into the room, where zeros follow them, or back.

    The first GROUP numbers of the room are left out.
    """
    source, to = np.uint64(at), np.uint64(GROUP)
    for _ in range(columns):
        if there:
            for r in range(np.uint64(rows)):
                room[to + r] = panel[source + r]
            for r in range(np.uint64(rows), np.uint64(GROUP)):
                room[to + r] = 0
        else:
            for r in range(np.uint64(rows)):
                panel[source + r] = room[to + r]
        source += np.uint64(height)
        to += np.uint64(GROUP)
