"""Forward and backward substitution for many right-hand sides at once, by BLAS-3."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel
from beltrami.solvers.blas import N, T, divide_right, multiply

_ONE, _MINUS, _ZERO = range(3)  # places of the scalars


@kernel
def enter_many(b: Any, j: int, order: Any, scale: Any, x: Any) -> None:
    """Bring columns of b (n, c), from j on, into the order of elimination, scaled: x (n, k)."""
    for t in range(x.shape[0]):
        i = np.uint64(order[t])
        source, to, s = b[i], x[t], scale[i]
        for k in range(x.shape[1]):
            to[k] = source[np.uint64(j + k)] * s


@kernel
def leave_many(x: Any, place: Any, scale: Any, j: int, result: Any) -> None:
    """Bring x (n, k) back, into the columns of the result (n, c) from j on."""
    for i in range(place.size):
        source, to, s = x[np.uint64(place[i])], result[i], scale[i]
        for k in range(x.shape[1]):
            to[np.uint64(j + k)] = source[k] * s


@kernel
def solve_many(
    values: Any, starts: Any, row_starts: Any, rows: Any, panels: Any, b: Any, x: Any, work: Any
) -> None:
    """Solve L x = b in place for x (n, c) in the order of elimination; ``work`` (tallest, c)."""
    width, c = values.itemsize, x.shape[1]
    for i in range(starts.size - 1):
        first, columns = starts[i], starts[i + 1] - starts[i]
        below = row_starts[i + 1] - row_starts[i]
        panel = values.ctypes.data + width * panels[i]
        mine = x.ctypes.data + width * first * c
        height = columns + below
        divide_right(b, T, N, c, columns, panel, height, mine, c)
        if below:
            under, there = panel + width * columns, work.ctypes.data
            multiply(b, N, T, c, below, columns, _ONE, _ZERO, mine, c, under, height, there, c)
            for t in range(below):
                row = rows[row_starts[i] + t]
                for j in range(c):
                    x[row, j] -= work[t, j]


@kernel
def solve_many_transposed(
    values: Any, starts: Any, row_starts: Any, rows: Any, panels: Any, b: Any, x: Any, work: Any
) -> None:
    """Solve L' x = b in place, likewise."""
    width, c = values.itemsize, x.shape[1]
    for i in range(starts.size - 2, -1, -1):
        first, columns = starts[i], starts[i + 1] - starts[i]
        below = row_starts[i + 1] - row_starts[i]
        panel = values.ctypes.data + width * panels[i]
        mine = x.ctypes.data + width * first * c
        height = columns + below
        if below:
            for t in range(below):
                row = rows[row_starts[i] + t]
                for j in range(c):
                    work[t, j] = x[row, j]
            under, there = panel + width * columns, work.ctypes.data
            multiply(b, N, N, c, columns, below, _MINUS, _ONE, there, c, under, height, mine, c)
        divide_right(b, N, N, c, columns, panel, height, mine, c)
