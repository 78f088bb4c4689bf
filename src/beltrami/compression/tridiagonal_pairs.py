"""The lowest eigenpairs of tridiagonal matrices: bisection, then inverse iteration."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel
from beltrami.compression.tables import whole

_HALVINGS = 52
_ROUNDS = 3
_CLOSE = 1e-5  # times the spread: nearer eigenvalues need vectors made orthogonal
_TINY = 1e-300
_LANES = 8  # vectors that are solved for together


@kernel
def lowest_eigenvalues(d: Any, e: Any, values: Any) -> float:
    """Write the lowest eigenvalues, ascending; return the width of the interval of all of them.

    By Sturm's count: the pivots of T - x that are negative are as many as the eigenvalues below
    x. All eigenvalues are halved for together; 52 n k divisions.
    """
    n, m = d.size, values.size
    low = high = d[0]
    for i in range(n):
        reach = (abs(e[i - 1]) if i else 0.0) + (abs(e[i]) if i + 1 < n else 0.0)
        low, high = min(low, d[i] - reach), max(high, d[i] + reach)
    width = high - low
    below, above, middle = np.full(m, low), np.full(m, high), np.zeros(m)
    pivot, count = np.zeros(m), np.zeros(m)
    for _ in range(_HALVINGS):
        for j in range(m):
            middle[j] = 0.5 * (below[j] + above[j])
            pivot[j], count[j] = 1.0, 0.0
        for i in range(n):
            square, diagonal = e[i - 1] * e[i - 1] if i else 0.0, d[i]
            for j in range(m):
                q = pivot[j]
                q = _TINY if q == 0.0 else q
                q = diagonal - middle[j] - square / q
                pivot[j] = q
                count[j] += 1.0 if q < 0.0 else 0.0
        for j in range(m):
            if count[j] > j:
                above[j] = middle[j]
            else:
                below[j] = middle[j]
    for j in range(m):
        values[j] = 0.5 * (below[j] + above[j])
    return width


@kernel
def tridiagonal_vectors(d: Any, e: Any, values: Any, width: float, vectors: Any) -> None:
    """Write the eigenvectors of ascending eigenvalues as columns of ``vectors`` (n, m).

    Three solves each from numbers that look like chance; those of eigenvalues closer to each
    other than 1e-5 of the width are made orthogonal. Eight at a time, but for such neighbours: each
    of the eight goes its own way, and the processor waits for none of them.
    """
    n, m = vectors.shape
    x, work = np.zeros((n + 2, _LANES)), np.zeros((5, n, _LANES))
    shifts = np.zeros(_LANES)
    seed, first, j = whole(1), 0, 0
    while j < m:
        if j == 0 or values[j] - values[j - 1] > _CLOSE * width:
            first = j
        lanes = 1
        while first == j and lanes < _LANES and j + lanes < m:
            if not values[j + lanes] - values[j + lanes - 1] > _CLOSE * width:
                break
            lanes += 1
        for lane in range(lanes):
            shifts[lane] = values[j + lane]
            for i in range(n):
                seed = (seed * 1103515245 + 12345) % 2147483648
                x[i, lane] = seed / 1073741824.0 - 1.0
        _factorise(d, e, shifts, width, work)
        for _ in range(_ROUNDS):
            _solve(work, x)
            _orthogonalise(vectors, first, j, x)
        for i in range(n):
            for lane in range(lanes):
                vectors[i, j + lane] = x[i, lane]
        first = j + lanes - 1 if lanes > 1 else first
        j += lanes


@kernel
def _factorise(d: Any, e: Any, shifts: Any, width: float, work: Any) -> None:
    """Eliminate T - shift with row exchanges: rows of U in work[0:3], factors, exchanges."""
    n = d.size
    least = max(width, 1.0) * 2.0**-52
    a, b = np.empty(_LANES), np.empty(_LANES)
    for lane in range(_LANES):
        a[lane], b[lane] = d[0] - shifts[lane], e[0] if n > 1 else 0.0
    for i in range(n - 1):
        below, beyond = e[i], e[i + 1] if i + 2 < n else 0.0
        u, v, w, factors, swaps = work[0, i], work[1, i], work[2, i], work[3, i], work[4, i]
        for lane in range(_LANES):
            swap = abs(below) > abs(a[lane])
            own = a[lane] if abs(a[lane]) > least else least
            here, there = b[lane], d[i + 1] - shifts[lane]
            f = (a[lane] if swap else below) / (below if swap else own)
            u[lane] = below if swap else own
            v[lane] = there if swap else here
            w[lane] = beyond if swap else 0.0
            factors[lane], swaps[lane] = f, 1.0 if swap else 0.0
            a[lane] = (here if swap else there) - f * (there if swap else here)
            b[lane] = -f * beyond if swap else beyond
    for lane in range(_LANES):
        work[0, n - 1, lane] = a[lane] if abs(a[lane]) > least else least
        work[1, n - 1, lane] = work[2, n - 1, lane] = 0.0


@kernel
def _solve(work: Any, x: Any) -> None:
    """Solve, and divide by the largest entry; the last two rows of x are zero."""
    n = work.shape[1]
    x[n:] = 0.0
    for i in range(n - 1):
        factors, swaps, here, there = work[3, i], work[4, i], x[i], x[i + 1]
        for lane in range(_LANES):
            one, two = here[lane], there[lane]
            swap = swaps[lane] > 0.0
            here[lane] = two if swap else one
            there[lane] = (one if swap else two) - factors[lane] * (two if swap else one)
    largest = np.zeros(_LANES)
    for i in range(n - 1, -1, -1):
        u, v, w = work[0, i], work[1, i], work[2, i]
        here, there, beyond = x[i], x[i + 1], x[i + 2]
        for lane in range(_LANES):
            y = here[lane] - v[lane] * there[lane] - w[lane] * beyond[lane]
            y = y / u[lane]
            here[lane] = y
            largest[lane] = abs(y) if abs(y) > largest[lane] else largest[lane]
    for i in range(n):
        row = x[i]
        for lane in range(_LANES):
            row[lane] = row[lane] / largest[lane] if largest[lane] > 0.0 else 1.0


@kernel
def _orthogonalise(vectors: Any, first: int, last: int, x: Any) -> None:
    """Take the columns first..last-1 out of the first of x, twice; make the lengths of all 1."""
    n = vectors.shape[0]
    for _ in range(2):
        for j in range(first, last):
            s = 0.0
            for i in range(n):
                s += vectors[i, j] * x[i, 0]
            for i in range(n):
                x[i, 0] -= s * vectors[i, j]
    sums = np.zeros(_LANES)
    for i in range(n):
        row = x[i]
        for lane in range(_LANES):
            sums[lane] += row[lane] * row[lane]
    for lane in range(_LANES):
        sums[lane] = np.sqrt(sums[lane])
    for i in range(n):
        row = x[i]
        for lane in range(_LANES):
            row[lane] = row[lane] / sums[lane]
