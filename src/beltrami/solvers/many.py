"""Forward and backward substitution for several right-hand sides at once, in tiles.

The right-hand sides of one unknown stand together, in whole lines of the cache; eight unknowns are
treated at a time (``tiles``), so that a number of L is loaded once for two lines of them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from beltrami._jit import kernel
from beltrami.solvers.tiles import BACKWARD, BELOW, FORWARD, LINE, fetch, subtract

_STRIP = 16  # columns of a panel at a time: as many streams of memory as processors foresee
HALF = LINE // 2
_LINE = (0, 0, 0, 0)
ONE, TWO, _HALF = (_LINE,), (_LINE, _LINE), ((0, 0),)


def lines_for(n: int, count: int, dtype: DTypeLike) -> NDArray[Any]:
    """Return room (n, at least ``count``); a row is half a line of the cache, or whole ones."""
    size = np.dtype(dtype).itemsize
    row = HALF if count * size <= HALF else -(-count * size // LINE) * LINE
    room = np.empty(n * row + LINE, np.uint8)
    start = -room.ctypes.data % LINE
    return room[start : start + n * row].view(dtype).reshape(n, -1)


@kernel
def enter_many(b: Any, j: int, count: int, order: Any, scale: Any, x: Any) -> None:
    """Write columns j to j + count of b (n, c) into x, scaled; then zeros.

    Row t of x is row ``order[t]`` of b, or row t if the order is empty.
    """
    for t in range(x.shape[0]):
        i = np.uint64(order[t] if order.size else t)
        source, to, s = b[i], x[np.uint64(t)], scale[i]
        for k in range(count):
            to[k] = source[np.uint64(j + k)] * s
        for k in range(count, x.shape[1]):
            to[k] = 0


@kernel
def leave_many(x: Any, count: int, place: Any, scale: Any, j: int, result: Any) -> None:
    """Write x, scaled, into columns j to j + count of the result (n, c).

    Row ``place[i]`` of x is row i of the result; if there are no places they may be one array.
    """
    for i in range(x.shape[0]):
        source = x[np.uint64(place[i] if place.size else i)]
        to, s = result[np.uint64(i)], scale[i]
        for k in range(count):
            to[np.uint64(j + k)] = source[k] * s


@kernel
def solve_many(
    values: Any,
    starts: Any,
    row_starts: Any,
    rows: Any,
    panels: Any,
    order: Any,
    x: Any,
    offsets: Any,
) -> None:
    """Solve L x = b in place for x of ``lines_for``; ``offsets`` (widest + tallest,).

    Unknown t stands in row ``order[t]`` of x, or in row t if the order is empty.
    """
    zero, step = values[0], values.itemsize
    right, row = x.ctypes.data, x.shape[1] * x.itemsize
    for i in range(starts.size - 1):
        first, columns = starts[i], starts[i + 1] - starts[i]
        below = rows[row_starts[i] : row_starts[i + 1]]
        panel, height = values.ctypes.data + step * panels[i], columns + below.size
        _prepare(first, columns, below, order, right, row, offsets, panel, step)
        where, line = offsets.ctypes.data, 0
        while line + 2 * LINE <= row:
            _fetch_rows(offsets, height, right + line + 2 * LINE, row - line - 2 * LINE)
            forward(zero, right + line, where, columns, height, panel, step * height, TWO)
            line += 2 * LINE
        if line + LINE <= row:
            forward(zero, right + line, where, columns, height, panel, step * height, ONE)
        elif line < row:
            forward(zero, right + line, where, columns, height, panel, step * height, _HALF)


@kernel
def solve_many_transposed(
    values: Any,
    starts: Any,
    row_starts: Any,
    rows: Any,
    panels: Any,
    order: Any,
    x: Any,
    offsets: Any,
) -> None:
    """Solve L' x = b in place, likewise."""
    zero, step = values[0], values.itemsize
    right, row = x.ctypes.data, x.shape[1] * x.itemsize
    for i in range(starts.size - 2, -1, -1):
        first, columns = starts[i], starts[i + 1] - starts[i]
        below = rows[row_starts[i] : row_starts[i + 1]]
        panel, height = values.ctypes.data + step * panels[i], columns + below.size
        _prepare(first, columns, below, order, right, row, offsets, panel, step)
        where, line = offsets.ctypes.data, 0
        while line + 2 * LINE <= row:
            _fetch_rows(offsets, height, right + line + 2 * LINE, row - line - 2 * LINE)
            _backward(zero, right + line, where, columns, height, panel, step * height, TWO)
            line += 2 * LINE
        if line + LINE <= row:
            _backward(zero, right + line, where, columns, height, panel, step * height, ONE)
        elif line < row:
            _backward(zero, right + line, where, columns, height, panel, step * height, _HALF)


@kernel
def _prepare(
    first: int,
    columns: int,
    below: Any,
    order: Any,
    x: int,
    row: int,
    offsets: Any,
    panel: int,
    size: int,
) -> None:
    """Write where the rows of a panel stand in x, in bytes; ask for them, and for the panel.

    The caches are asked at once for all that is needed: waiting for it piece by piece would take
    longer than the arithmetic.
    """  # fmt: skip
    height = columns + below.size
    for at in range(0, size * columns * height, LINE):
        fetch(panel + at)
    if order.size:
        for t in range(columns):
            offsets[t] = row * np.int64(order[first + t])
        for t in range(below.size):
            offsets[columns + t] = row * np.int64(order[np.int64(below[t])])
    else:
        for t in range(columns):
            offsets[t] = row * (first + t)
        for t in range(below.size):
            offsets[columns + t] = row * np.int64(below[t])
    _fetch_rows(offsets, height, x, row)


@kernel
def _fetch_rows(offsets: Any, height: int, x: int, width: int) -> None:
    """Ask for the next two lines, if there are any, of each row."""
    if width >= 2 * LINE:
        for t in range(height):
            fetch(x + offsets[t])
            fetch(x + offsets[t] + LINE)
    elif width > 0:
        for t in range(height):
            fetch(x + offsets[t])


@kernel
def forward(
    zero: Any,
    x: int,
    offsets: int,
    columns: int,
    height: int,
    panel: int,
    step: int,
    lines: Any,
) -> None:
    """Solve with the triangle of a panel, and subtract from the rows below it."""
    for low in range(0, columns, _STRIP):
        high = min(low + _STRIP, columns)
        i = low
        while i + 8 <= high:
            subtract(zero, x, offsets, i, low, i, panel, step, lines, 8, FORWARD)
            i += 8
        if i + 4 <= high:
            subtract(zero, x, offsets, i, low, i, panel, step, lines, 4, FORWARD)
            i += 4
        if i + 2 <= high:
            subtract(zero, x, offsets, i, low, i, panel, step, lines, 2, FORWARD)
            i += 2
        if i < high:
            subtract(zero, x, offsets, i, low, i, panel, step, lines, 1, FORWARD)
            i += 1
        while i + 8 <= height:
            subtract(zero, x, offsets, i, low, high, panel, step, lines, 8, BELOW)
            i += 8
        if i + 4 <= height:
            subtract(zero, x, offsets, i, low, high, panel, step, lines, 4, BELOW)
            i += 4
        if i + 2 <= height:
            subtract(zero, x, offsets, i, low, high, panel, step, lines, 2, BELOW)
            i += 2
        if i < height:
            subtract(zero, x, offsets, i, low, high, panel, step, lines, 1, BELOW)


@kernel
def _backward(
    zero: Any,
    x: int,
    offsets: int,
    columns: int,
    height: int,
    panel: int,
    step: int,
    lines: Any,
) -> None:
    """Subtract the rows below a panel from its columns, and solve with its triangle."""
    i = columns
    if i & 1:
        i -= 1
        subtract(zero, x, offsets, i, i + 1, height, panel, step, lines, 1, BACKWARD)
    if i & 2:
        i -= 2
        subtract(zero, x, offsets, i, i + 2, height, panel, step, lines, 2, BACKWARD)
    if i & 4:
        i -= 4
        subtract(zero, x, offsets, i, i + 4, height, panel, step, lines, 4, BACKWARD)
    while i:
        i -= 8
        subtract(zero, x, offsets, i, i + 8, height, panel, step, lines, 8, BACKWARD)
