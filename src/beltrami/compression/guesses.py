"""Guesses of a position from the positions around it: parallelograms and solves of patches."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import plain_kernel
from beltrami.compression.patches import solve
from beltrami.compression.tables import whole

# Solves, for ``solve``: rings, weights of Laplacians, of parallelograms and of edges.
BEST = np.array(
    [
        (3, 1.0, 0.0, 0.0005),
        (4, 1.0, 0.0, 0.0002),
        (2, 0.0, 1.0, 0.0003),
        (3, 0.0, 1.0, 0.0003),
        (3, 1.0, 0.1, 0.0003),
    ]
)
FAST = np.array([(2, 1.0, 0.0, 0.0005), (2, 0.0, 1.0, 0.0003)])


@plain_kernel
def known_mean(v: int, last: int, near: Any, known: Any, x: Any, out: Any) -> None:
    """Write the mean of the known neighbours of v, or the position of ``last`` without any."""
    out[:] = 0.0
    count = 0
    for j in range(near.starts[v], near.starts[v + 1]):
        u = near.around[j]
        if known[u]:
            count += 1
            for q in range(3):
                out[q] += x[u, q]
    for q in range(3):
        out[q] = out[q] / count if count else x[last, q]


@plain_kernel
def parallelograms(v: int, near: Any, known: Any, x: Any, error: Any, out: Any) -> int:
    """Complete parallelograms at v: their mean goes to out[0], the one to trust most to out[1].

    The trust is in those whose corners were themselves guessed well: ``error`` (n,). Returns
    the number of parallelograms; without any, nothing is written.
    """
    corners = near.corners
    count = 0
    least = 0.0
    for t in range(near.corner_starts[v], near.corner_starts[v + 1]):
        c = whole(near.corner_list[t])
        if near.opposite[c] < 0:
            continue
        a, b = corners[c - c % 3 + (c + 1) % 3], corners[c - c % 3 + (c + 2) % 3]
        d = corners[near.opposite[c]]
        if not (known[a] and known[b] and known[d]):
            continue
        if count == 0:
            out[0, :] = 0.0
        loss = error[a] + error[b] + error[d]
        best = count == 0 or loss < least
        if best:
            least = loss
        for q in range(3):
            tip = x[a, q] + x[b, q] - x[d, q]
            out[0, q] += tip
            if best:
                out[1, q] = tip
        count += 1
    for q in range(3):
        out[0, q] = out[0, q] / max(count, 1)
    return count


@plain_kernel
def guess(
    v: int, last: int, solves: Any, near: Any, known: Any, patch: Any, x: Any, error: Any,
    mean: Any, out: Any,
) -> int:  # fmt: skip
    """Write 2 + len(solves) guesses of x[v] to ``out``; return the number of parallelograms."""
    known_mean(v, last, near, known, x, mean)
    count = parallelograms(v, near, known, x, error, out)
    if count == 0:
        _copy(mean, out[0])
        _copy(mean, out[1])
    for z in range(solves.shape[0]):
        _copy(out[0], out[2 + z])
        s = solves[z]
        solve(v, whole(s[0]), s[1], s[2], s[3], near, known, patch, x, out[2 + z])
    return count


@plain_kernel
def _copy(x: Any, out: Any) -> None:
    for q in range(3):
        out[q] = x[q]


@plain_kernel
def frame(v: int, near: Any, known: Any, x: Any, guessed: Any, mean: Any, out: Any) -> None:
    """Write an orthonormal frame at a guessed position: normal, away from the mean, the third."""
    corners = near.corners
    n, t = out[0], out[1]
    n[:] = 0.0
    for k in range(near.corner_starts[v], near.corner_starts[v + 1]):
        c = whole(near.corner_list[k])
        a, b = corners[c - c % 3 + (c + 1) % 3], corners[c - c % 3 + (c + 2) % 3]
        if not (known[a] and known[b]):
            continue
        _add_cross(x[a], x[b], guessed, n)
        if near.opposite[c] >= 0:
            d = corners[near.opposite[c]]
            if known[d]:
                _add_cross(x[b], x[a], x[d], n)
    if not _normalise(n):
        n[2] = 1.0
    for q in range(3):
        t[q] = guessed[q] - mean[q]
    _project(t, n)
    if not _normalise(t):
        t[:] = 0.0
        t[0 if abs(n[0]) < 0.8 else 1] = 1.0
        _project(t, n)
        _normalise(t)
    out[2, 0] = n[1] * t[2] - n[2] * t[1]
    out[2, 1] = n[2] * t[0] - n[0] * t[2]
    out[2, 2] = n[0] * t[1] - n[1] * t[0]


@plain_kernel
def _add_cross(a: Any, b: Any, origin: Any, n: Any) -> None:
    """Add (a - origin) x (b - origin)."""
    p, q, r = a[0] - origin[0], a[1] - origin[1], a[2] - origin[2]
    s, t, u = b[0] - origin[0], b[1] - origin[1], b[2] - origin[2]
    n[0] += q * u - r * t
    n[1] += r * s - p * u
    n[2] += p * t - q * s


@plain_kernel
def _normalise(t: Any) -> bool:
    """Divide by the length; False, and zero, where there is hardly any."""
    length = np.sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2])
    enough = length > 1e-9
    for q in range(3):
        t[q] = t[q] / length if enough else 0.0
    return enough


@plain_kernel
def _project(t: Any, n: Any) -> None:
    """Take away the part along the unit vector n."""
    d = t[0] * n[0] + t[1] * n[1] + t[2] * n[2]
    for q in range(3):
        t[q] -= d * n[q]
