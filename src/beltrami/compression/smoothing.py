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
from beltrami._jit import kernel, plain_kernel
from beltrami.compression.descent import downhill
from beltrami.compression.neighbourhood import Neighbourhood
from beltrami.compression.tables import whole

# How much smoothness counts, for the numbers 1, 2, ... of the file; 0 is none.
WEIGHTS = (0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)
_COLUMNS = 3  # coordinates at a time


def smoothed(numbers: Integers | Floats, near: Neighbourhood, choice: int) -> Floats:
    """Return positions (n, d) in steps of the grid, each within half a step of its number.

    Chebyshev's iteration with a fixed number of rounds solves (Id + μ PᵀP / 6) x = q: sums,
    products and quotients in a fixed order, so that every machine gets the same bits. O(m) for
    each of about 10 + 5 sqrt(1 + 8 μ) rounds.
    """
    q = numbers.astype(np.float64)
    if not choice:
        return q
    n, d = q.shape
    sides, most = _parallelograms(near.corners, near.opposite, n)
    x = np.empty_like(q)
    for first in range(0, d, _COLUMNS):
        middle = np.zeros((n, _COLUMNS))
        middle[:, : d - first] = q[:, first : first + _COLUMNS]
        solved = _solve(middle, sides, most, WEIGHTS[choice - 1])
        x[:, first : first + _COLUMNS] = solved[:, : d - first]
    return x


def best_choice(
    x: Floats, numbers: Integers | Floats, near: Neighbourhood, most: float = np.inf
) -> int:
    """Return the choice with the least mean square distance to the true positions, in steps.

    Of those that leave no vertex farther off than ``most``; if there is none, 0.
    """
    losses, kept = [], []
    patience = 1.3 if np.isinf(most) else 1.0  # with a bound the largest smoothings rarely serve
    for choice in range(len(WEIGHTS) + 1):
        squares = ((smoothed(numbers, near, choice) - x) ** 2).sum(axis=1)
        losses.append(float(squares.sum()))
        kept.append(squares.max(initial=0.0) <= most * most)
        if losses[-1] > patience * min(losses):
            break
    return int(np.argmin(np.where(kept, losses, np.inf)))


def choice_near(x: Floats, numbers: Floats, near: Neighbourhood, start: int) -> int:
    """Return the best choice as far as one comes from ``start`` downhill."""

    def loss(choice: int) -> float:
        return float(((smoothed(numbers, near, choice) - x) ** 2).sum())

    return downhill(loss, len(WEIGHTS) + 1, start)


@kernel
def _parallelograms(corners: Any, opposite: Any, n: int) -> Any:
    """Return (v, w, a, b) of each two faces with the side a b, and the most of them at a vertex."""
    sides, count = np.empty((corners.size // 2, 4), np.uint32), np.zeros(n, np.int32)
    size, most = whole(0), whole(0)
    for c in range(corners.size):
        o = whole(opposite[c])
        if o < c:
            continue
        f = c - c % 3
        sides[size, 0], sides[size, 1] = corners[c], corners[o]
        sides[size, 2], sides[size, 3] = corners[f + (c + 1) % 3], corners[f + (c + 2) % 3]
        for u in sides[size]:
            count[u] += 1
        size += 1
    for u in range(n):
        most = max(most, whole(count[u]))
    return sides[:size], most


@plain_kernel
def _departures(x: Any, sides: Any, out: Any) -> None:
    """Write PᵀP x / 6."""
    out[:] = 0.0
    for k in range(sides.shape[0]):
        v, w, a, b = x[sides[k, 0]], x[sides[k, 1]], x[sides[k, 2]], x[sides[k, 3]]
        p, q, r, s = out[sides[k, 0]], out[sides[k, 1]], out[sides[k, 2]], out[sides[k, 3]]
        for c in range(_COLUMNS):
            y = (v[c] + w[c] - a[c] - b[c]) / 6.0
            p[c] += y
            q[c] += y
            r[c] -= y
            s[c] -= y


@kernel
def _solve(q: Any, sides: Any, most: int, weight: float) -> Any:
    """Solve, and keep each coordinate within half a step of q."""
    d, r, x = np.empty_like(q), np.empty_like(q), q.copy()
    if most == 0:
        return x
    # The spectrum of PᵀP / 6 is within 0 and 4 times the most parallelograms at a vertex, over 6.
    high = 1.0 + weight * 4.0 * most / 6.0
    centre, half = (high + 1.0) / 2.0, (high - 1.0) / 2.0
    _departures(x, sides, d)
    for i in range(q.shape[0]):
        for c in range(_COLUMNS):
            r[i, c] = -weight * d[i, c]
            d[i, c] = r[i, c] / centre
    ratio = centre / half
    rho = 1.0 / ratio
    product = np.empty_like(q)
    for _ in range(10 + whole(5.0 * np.sqrt(high))):
        _departures(d, sides, product)
        following = 1.0 / (2.0 * ratio - rho)
        for i in range(q.shape[0]):
            for c in range(_COLUMNS):
                x[i, c] += d[i, c]
                r[i, c] -= d[i, c] + weight * product[i, c]
                d[i, c] = following * rho * d[i, c] + 2.0 * following / half * r[i, c]
        rho = following
    for i in range(q.shape[0]):
        for c in range(_COLUMNS):
            x[i, c] = min(max(x[i, c], q[i, c] - 0.5), q[i, c] + 0.5)
    return x
