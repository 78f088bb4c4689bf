"""Where in their cells of the grid positions are likely to be: the smoothest surface there.

The decoder knows a cell for each coordinate. Among all surfaces near the middles q of the cells it
takes the one that minimises |x - q|² + μ |P x|², where P x are the departures of neighbouring
faces from parallelograms, and moves no coordinate out of its cell: the maximum a posteriori where
departures are normal. The encoder tries every μ, and tells the best one.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel
from beltrami.compression.neighbourhood import Neighbourhood
from beltrami.compression.tables import whole

# How much smoothness counts, for the numbers 1, 2, ... of the file; 0 is none.
WEIGHTS = (0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)


def smoothed(numbers: Integers | Floats, near: Neighbourhood, choice: int) -> Floats:
    """Return positions (n, d) in steps of the grid, each within half a step of its number.

    Chebyshev's iteration with a fixed number of rounds solves (Id + μ PᵀP / 6) x = q: sums,
    products and quotients in a fixed order, so that every machine gets the same bits. O(m) for
    each of about 10 + 5 sqrt(1 + 8 μ) rounds.
    """
    q = numbers.astype(np.float64)
    if not choice:
        return q
    x = np.empty_like(q)
    for column in range(q.shape[1]):
        middle = np.ascontiguousarray(q[:, column])
        x[:, column] = _solve(middle, near.corners, near.opposite, WEIGHTS[choice - 1])
    return x


def best_choice(x: Floats, numbers: Integers | Floats, near: Neighbourhood) -> int:
    """Return the choice with the least mean square distance to the true positions, in steps."""
    losses = []
    for choice in range(len(WEIGHTS) + 1):
        losses.append(float(((smoothed(numbers, near, choice) - x) ** 2).sum()))
        if losses[-1] > 1.3 * min(losses):
            break
    return int(np.argmin(losses))


@kernel
def _departures(x: Any, corners: Any, opposite: Any, out: Any) -> int:
    """Write PᵀP x / 6; return the largest number of parallelograms at a vertex."""
    out[:] = 0.0
    count = np.zeros(x.size, np.int32)
    for c in range(corners.size):
        o = whole(opposite[c])
        if o < c:
            continue
        v, w = corners[c], corners[o]
        f = c - c % 3
        a, b = corners[f + (c + 1) % 3], corners[f + (c + 2) % 3]
        r = (x[v] + x[w] - x[a] - x[b]) / 6.0
        out[v] += r
        out[w] += r
        out[a] -= r
        out[b] -= r
        for u in (v, w, a, b):
            count[u] += 1
    most = whole(0)
    for u in range(x.size):
        most = max(most, whole(count[u]))
    return most


@kernel
def _solve(q: Any, corners: Any, opposite: Any, weight: float) -> Any:
    """Solve, and keep each coordinate within half a step of q."""
    d, r, x = np.empty(q.size), np.empty(q.size), q.copy()
    # The spectrum of PᵀP / 6 is within 0 and 4 times the most parallelograms at a vertex, over 6.
    most = _departures(x, corners, opposite, d)
    high = 1.0 + weight * 4.0 * most / 6.0
    centre, half = (high + 1.0) / 2.0, (high - 1.0) / 2.0
    for i in range(q.size):
        r[i] = -weight * d[i]
        d[i] = r[i] / centre
    if most == 0:
        return x
    ratio = centre / half
    rho = 1.0 / ratio
    product = np.empty(q.size)
    for _ in range(10 + whole(5.0 * np.sqrt(high))):
        _departures(d, corners, opposite, product)
        following = 1.0 / (2.0 * ratio - rho)
        for i in range(q.size):
            x[i] += d[i]
            r[i] -= d[i] + weight * product[i]
            d[i] = following * rho * d[i] + 2.0 * following / half * r[i]
        rho = following
    for i in range(q.size):
        x[i] = min(max(x[i], q[i] - 0.5), q[i] + 0.5)
    return x
