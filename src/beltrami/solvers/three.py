"""Substitution like ``one``, for three right-hand sides: each number of L is loaded once."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel, summing_kernel
from beltrami.solvers.one import gather, scatter


@kernel
def enter(b: Any, order: Any, scale: Any, x: Any) -> None:
    """Bring b (n, 3) into the order of elimination, scaled: x (3, n)."""
    p, q, r = x[0], x[1], x[2]
    for t in range(np.uint64(order.size)):
        i = np.uint64(order[t])
        s = scale[i]
        p[t] = b[i, 0] * s
        q[t] = b[i, 1] * s
        r[t] = b[i, 2] * s


@kernel
def leave(x: Any, place: Any, scale: Any, result: Any) -> None:
    """Bring x (3, n) back, into the result (n, 3)."""
    for i in range(np.uint64(place.size)):
        t, s = np.uint64(place[i]), scale[i]
        result[i, 0] = x[0, t] * s
        result[i, 1] = x[1, t] * s
        result[i, 2] = x[2, t] * s


@summing_kernel
def solve_three(
    values: Any, starts: Any, row_starts: Any, rows: Any, panels: Any, x: Any, work: Any
) -> None:
    """Solve L x = b in place for x (3, n) in the order of elimination; ``work`` (3, as above)."""
    zero, one, two = np.uint64(0), np.uint64(1), np.uint64(2)
    u, v, w = work[0], work[1], work[2]
    for i in range(np.uint64(starts.size - 1)):
        first, low = np.uint64(starts[i]), np.uint64(row_starts[i])
        columns = np.uint64(starts[i + one]) - first
        height = columns + np.uint64(row_starts[i + one]) - low
        for j in range(3):
            gather(x[j], first, columns, rows, low, height, work[j])
        at, t = np.uint64(panels[i]), zero
        while t < columns:
            d = values[at + t]
            p, q, r = u[t] / d, v[t] / d, w[t] / d
            u[t], v[t], w[t] = p, q, r
            if t + one < columns:
                s, second = t + one, at + height
                c, d = values[at + s], values[second + s]
                p2, q2, r2 = (u[s] - c * p) / d, (v[s] - c * q) / d, (w[s] - c * r) / d
                u[s], v[s], w[s] = p2, q2, r2
                for k in range(t + two, height):
                    c, d = values[at + k], values[second + k]
                    u[k] -= c * p + d * p2
                    v[k] -= c * q + d * q2
                    w[k] -= c * r + d * r2
            else:
                for k in range(t + one, height):
                    c = values[at + k]
                    u[k] -= c * p
                    v[k] -= c * q
                    w[k] -= c * r
            at += two * height
            t += two
        for j in range(3):
            scatter(x[j], first, columns, rows, low, height, work[j])


@summing_kernel
def solve_three_transposed(
    values: Any, starts: Any, row_starts: Any, rows: Any, panels: Any, x: Any, work: Any
) -> None:
    """Solve L' x = b in place, likewise."""
    zero, one, two = np.uint64(0), np.uint64(1), np.uint64(2)
    u, v, w = work[0], work[1], work[2]
    blocks = np.uint64(starts.size - 1)
    for back in range(blocks):
        i = blocks - one - back
        first, low = np.uint64(starts[i]), np.uint64(row_starts[i])
        columns = np.uint64(starts[i + one]) - first
        height = columns + np.uint64(row_starts[i + one]) - low
        for j in range(3):
            gather(x[j], first, columns, rows, low, height, work[j])
        t = columns
        if columns % two == one:
            t -= one
            at = np.uint64(panels[i]) + t * height
            p = q = r = u[zero] * 0
            for k in range(t + one, height):
                c = values[at + k]
                p, q, r = p + c * u[k], q + c * v[k], r + c * w[k]
            d = values[at + t]
            u[t], v[t], w[t] = (u[t] - p) / d, (v[t] - q) / d, (w[t] - r) / d
        while t > zero:
            t -= two
            at = np.uint64(panels[i]) + t * height
            second, s = at + height, t + one
            p = q = r = p2 = q2 = r2 = u[zero] * 0
            for k in range(t + two, height):
                c, d = values[at + k], values[second + k]
                p, q, r = p + c * u[k], q + c * v[k], r + c * w[k]
                p2, q2, r2 = p2 + d * u[k], q2 + d * v[k], r2 + d * w[k]
            d = values[second + s]
            u[s], v[s], w[s] = (u[s] - p2) / d, (v[s] - q2) / d, (w[s] - r2) / d
            c, d = values[at + s], values[at + t]
            u[t] = (u[t] - p - c * u[s]) / d
            v[t] = (v[t] - q - c * v[s]) / d
            w[t] = (w[t] - r - c * w[s]) / d
        for j in range(3):
            for k in range(columns):
                x[j, first + k] = work[j, k]
