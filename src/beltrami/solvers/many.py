"""Forward and backward substitution for several right-hand sides at once, in tiles.

The right-hand sides of one unknown stand together, in whole lines of the cache; eight unknowns are
treated at a time (``tiles``), so that a number of L is loaded once for two lines of them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from beltrami._jit import kernel
from beltrami.solvers.tiles import BACKWARD, BELOW, FORWARD, LINE, subtract

_STRIP = 16  # columns of a panel at a time: as many streams of memory as processors foresee
_ONE, _TWO = (0,), (0, 0)  # lines that a tile treats at once


def lines_for(n: int, count: int, dtype: DTypeLike) -> NDArray[Any]:
    """Return room (n, at least ``count``) whose rows are whole lines of the cache."""
    size = np.dtype(dtype).itemsize
    row = -(-count * size // LINE) * LINE
    room = np.empty(n * row + LINE, np.uint8)
    start = -room.ctypes.data % LINE
    return room[start : start + n * row].view(dtype).reshape(n, -1)


@kernel
def enter_many(b: Any, j: int, count: int, order: Any, scale: Any, x: Any) -> None:
    """Bring columns j to j + count of b (n, c) in the order of elimination, scaled; then zeros."""
    for t in range(x.shape[0]):
        i = np.uint64(order[t])
        source, to, s = b[i], x[np.uint64(t)], scale[i]
        for k in range(count):
            to[k] = source[np.uint64(j + k)] * s
        for k in range(count, x.shape[1]):
            to[k] = 0


@kernel
def leave_many(x: Any, count: int, place: Any, scale: Any, j: int, result: Any) -> None:
    """Bring x back, into columns j to j + count of the result (n, c)."""
    for i in range(place.size):
        source, to, s = x[np.uint64(place[i])], result[np.uint64(i)], scale[i]
        for k in range(count):
            to[np.uint64(j + k)] = source[k] * s


@kernel
def solve_many(
    values: Any, starts: Any, row_starts: Any, rows: Any, panels: Any, x: Any, offsets: Any
) -> None:
    """Solve L x = b in place for x of ``lines_for``; ``offsets`` (widest + tallest,)."""
    size, row, zero = values.itemsize, x.shape[1] * x.itemsize, values[0]
    right, where = x.ctypes.data, offsets.ctypes.data
    for i in range(starts.size - 1):
        first, columns = starts[i], starts[i + 1] - starts[i]
        height = _place(first, columns, rows[row_starts[i] : row_starts[i + 1]], row, offsets)
        panel, step, line = values.ctypes.data + size * panels[i], size * height, 0
        while line + 2 * LINE <= row:
            _forward(zero, right + line, where, columns, height, panel, step, _TWO)
            line += 2 * LINE
        if line < row:
            _forward(zero, right + line, where, columns, height, panel, step, _ONE)


@kernel
def solve_many_transposed(
    values: Any, starts: Any, row_starts: Any, rows: Any, panels: Any, x: Any, offsets: Any
) -> None:
    """Solve L' x = b in place, likewise."""
    size, row, zero = values.itemsize, x.shape[1] * x.itemsize, values[0]
    right, where = x.ctypes.data, offsets.ctypes.data
    for i in range(starts.size - 2, -1, -1):
        first, columns = starts[i], starts[i + 1] - starts[i]
        height = _place(first, columns, rows[row_starts[i] : row_starts[i + 1]], row, offsets)
        panel, step, line = values.ctypes.data + size * panels[i], size * height, 0
        while line + 2 * LINE <= row:
            _backward(zero, right + line, where, columns, height, panel, step, _TWO)
            line += 2 * LINE
        if line < row:
            _backward(zero, right + line, where, columns, height, panel, step, _ONE)


@kernel
def _place(first: int, columns: int, below: Any, row: int, offsets: Any) -> int:
    """Write where the rows of a panel stand in x, in bytes; return their number."""
    for t in range(columns):
        offsets[t] = (first + t) * row
    for t in range(below.size):
        offsets[columns + t] = np.int64(below[t]) * row
    return columns + below.size


@kernel
def _forward(
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
