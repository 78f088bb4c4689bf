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
    other than 1e-5 of the width are made orthogonal.
    """
    n, m = vectors.shape
    x, work = np.zeros(n), np.zeros((5, n))
    seed, first = whole(1), 0
    for j in range(m):
        if j and values[j] - values[j - 1] > _CLOSE * width:
            first = j
        _factorise(d, e, values[j], width, work)
        for i in range(n):
            seed = (seed * 1103515245 + 12345) % 2147483648
            x[i] = seed / 1073741824.0 - 1.0
        for _ in range(_ROUNDS):
            _solve(work, x)
            _orthogonalise(vectors, first, j, x)
        for i in range(n):
            vectors[i, j] = x[i]


@kernel
def _factorise(d: Any, e: Any, shift: float, width: float, work: Any) -> None:
    """Eliminate T - shift with row exchanges: rows of U in work[0:3], factors, exchanges."""
    n = d.size
    least = max(width, 1.0) * 2.0**-52
    a, b = d[0] - shift, e[0] if n > 1 else 0.0
    for i in range(n - 1):
        below, next_a = e[i], d[i + 1] - shift
        next_b = e[i + 1] if i + 2 < n else 0.0
        if abs(below) > abs(a):
            f = a / below
            work[0, i], work[1, i], work[2, i] = below, next_a, next_b
            work[3, i], work[4, i] = f, 1.0
            a, b = b - f * next_a, -f * next_b
        else:
            a = a if abs(a) > least else least
            f = below / a
            work[0, i], work[1, i], work[2, i] = a, b, 0.0
            work[3, i], work[4, i] = f, 0.0
            a, b = next_a - f * b, next_b
    work[0, n - 1] = a if abs(a) > least else least
    work[1, n - 1] = work[2, n - 1] = 0.0


@kernel
def _solve(work: Any, x: Any) -> None:
    """Solve, and divide by the largest entry."""
    n = x.size
    for i in range(n - 1):
        if work[4, i] > 0.0:
            x[i], x[i + 1] = x[i + 1], x[i]
        x[i + 1] -= work[3, i] * x[i]
    largest = 0.0
    for i in range(n - 1, -1, -1):
        y = x[i]
        if i + 1 < n:
            y -= work[1, i] * x[i + 1]
        if i + 2 < n:
            y -= work[2, i] * x[i + 2]
        x[i] = y / work[0, i]
        largest = max(largest, abs(x[i]))
    for i in range(n):
        x[i] = x[i] / largest if largest > 0.0 else 1.0


@kernel
def _orthogonalise(vectors: Any, first: int, last: int, x: Any) -> None:
    """Take the columns first..last-1 out of x, twice, and make its length 1."""
    n = x.size
    for _ in range(2):
        for j in range(first, last):
            s = 0.0
            for i in range(n):
                s += vectors[i, j] * x[i]
            for i in range(n):
                x[i] -= s * vectors[i, j]
    s = 0.0
    for i in range(n):
        s += x[i] * x[i]
    length = np.sqrt(s)
    for i in range(n):
        x[i] = x[i] / length
