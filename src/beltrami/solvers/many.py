"""Forward and backward substitution for many right-hand sides at once, by BLAS-3."""

from __future__ import annotations

from typing import Any

from beltrami._jit import kernel
from beltrami.solvers.blas import N, T, divide_right, multiply

_ONE, _MINUS, _ZERO = range(3)  # places of the scalars


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
