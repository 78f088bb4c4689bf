"""Forward and backward substitution for one right-hand side, by loops of our own.

BLAS would take longer to be called than to work. Two columns of the factor go together, so that
the right-hand side is read and written half as often. Indices are unsigned: see ``_jit.unsigned``.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel, summing_kernel


@kernel
def gather(x: Any, first: Any, columns: Any, rows: Any, low: Any, height: Any, work: Any) -> None:
    """Collect the values of a block's columns, and of the rows below them."""
    for t in range(columns):
        work[t] = x[first + t]
    for t in range(height - columns):
        work[columns + t] = x[np.uint64(rows[low + t])]


@kernel
def scatter(x: Any, first: Any, columns: Any, rows: Any, low: Any, height: Any, work: Any) -> None:
    """Put them back."""
    for t in range(columns):
        x[first + t] = work[t]
    for t in range(height - columns):
        x[np.uint64(rows[low + t])] = work[columns + t]


@summing_kernel
def solve_one(
    values: Any, starts: Any, row_starts: Any, rows: Any, panels: Any, x: Any, u: Any
) -> None:
    """Solve L x = b in place for x (n,) in the order of elimination; ``u`` (widest + tallest,)."""
    zero, one, two = np.uint64(0), np.uint64(1), np.uint64(2)
    for i in range(np.uint64(starts.size - 1)):
        first, low = np.uint64(starts[i]), np.uint64(row_starts[i])
        columns = np.uint64(starts[i + one]) - first
        height = columns + np.uint64(row_starts[i + one]) - low
        gather(x, first, columns, rows, low, height, u)
        at, t = np.uint64(panels[i]), zero
        while t < columns:
            p = u[t] / values[at + t]
            u[t] = p
            if t + one < columns:
                second = at + height
                q = (u[t + one] - values[at + t + one] * p) / values[second + t + one]
                u[t + one] = q
                for k in range(t + two, height):
                    u[k] -= values[at + k] * p + values[second + k] * q
            else:
                for k in range(t + one, height):
                    u[k] -= values[at + k] * p
            at += two * height
            t += two
        scatter(x, first, columns, rows, low, height, u)


@summing_kernel
def solve_one_transposed(
    values: Any, starts: Any, row_starts: Any, rows: Any, panels: Any, x: Any, u: Any
) -> None:
    """Solve L' x = b in place, likewise."""
    zero, one, two = np.uint64(0), np.uint64(1), np.uint64(2)
    blocks = np.uint64(starts.size - 1)
    for back in range(blocks):
        i = blocks - one - back
        first, low = np.uint64(starts[i]), np.uint64(row_starts[i])
        columns = np.uint64(starts[i + one]) - first
        height = columns + np.uint64(row_starts[i + one]) - low
        gather(x, first, columns, rows, low, height, u)
        t = columns
        if columns % two == one:
            t -= one
            at = np.uint64(panels[i]) + t * height
            p = u[zero] * 0
            for k in range(t + one, height):
                p += values[at + k] * u[k]
            u[t] = (u[t] - p) / values[at + t]
        while t > zero:
            t -= two
            at = np.uint64(panels[i]) + t * height
            second = at + height
            p = q = u[zero] * 0
            for k in range(t + two, height):
                p += values[at + k] * u[k]
                q += values[second + k] * u[k]
            u[t + one] = (u[t + one] - q) / values[second + t + one]
            u[t] = (u[t] - p - values[at + t + one] * u[t + one]) / values[at + t]
        for k in range(columns):
            x[first + k] = u[k]
