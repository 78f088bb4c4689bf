"""Symmetric matrices to tridiagonal ones and vectors back, in a fixed order of operations.

Whatever a compressed file means depends on every bit of the eigenvectors. So no BLAS: sums have
the order of these loops, in which each entry of a row goes its own way (compilers may take several
at a time, and change nothing by it).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel


@kernel
def tridiagonalise(A: Any, d: Any, e: Any, reflectors: Any, scales: Any) -> None:
    """Find T = QᵀAQ by reflections: (n,) diagonal d, (n - 1,) beside it e; A is used up.

    Q is the product of the Id - s v vᵀ, with v in ``reflectors[k]``, zero up to k, and s in
    ``scales[k]``. 2 n³ operations.
    """
    n = d.size
    p = np.zeros(n)
    for k in range(n - 2):
        v = reflectors[k]
        s = _reflector(A[k], k + 1, v)
        scales[k] = s
        d[k] = A[k, k]
        e[k] = A[k, k + 1]
        if s == 0.0:
            continue
        _times(A, v, k + 1, p)
        half = 0.0
        for i in range(k + 1, n):
            p[i] *= s
            half += v[i] * p[i]
        half *= 0.5 * s
        for i in range(k + 1, n):
            p[i] -= half * v[i]
        _subtract(A, v, p, k + 1)
    if n > 1:
        d[n - 2], e[n - 2] = A[n - 2, n - 2], A[n - 2, n - 1]
    d[n - 1] = A[n - 1, n - 1]


@kernel
def _reflector(row: Any, first: int, v: Any) -> float:
    """Write v of the reflection that clears row[first + 1:], and its row; return its scale."""
    n = row.size
    rest = 0.0
    for i in range(first + 1, n):
        rest += row[i] * row[i]
    v[:] = 0.0
    if rest == 0.0:
        return 0.0
    x = row[first]
    length = np.sqrt(x * x + rest)
    tip = x + length if x > 0.0 else x - length
    for i in range(first + 1, n):
        v[i] = row[i] / tip
        row[i] = 0.0
    v[first] = 1.0
    row[first] = -length if x > 0.0 else length
    return 2.0 / (1.0 + rest / (tip * tip))


@kernel
def _times(A: Any, v: Any, first: int, out: Any) -> None:
    """Write A[first:, first:] v[first:] to out[first:]; A is symmetric."""
    sums = out[first:]
    sums[:] = 0.0
    for j in range(first, v.size):
        row, factor = A[j, first:], v[j]
        for i in range(sums.size):
            sums[i] += factor * row[i]


@kernel
def _subtract(A: Any, v: Any, w: Any, first: int) -> None:
    """Subtract v wᵀ + w vᵀ from A[first:, first:]."""
    a, b = v[first:], w[first:]
    for j in range(first, v.size):
        row, f, g = A[j, first:], v[j], w[j]
        for i in range(a.size):
            row[i] -= f * b[i] + g * a[i]


@kernel
def turn_back(reflectors: Any, scales: Any, vectors: Any) -> None:
    """Multiply the columns of ``vectors`` (n, m) by Q; 2 n² m operations."""
    n, m = vectors.shape
    sums = np.zeros(m)
    for k in range(n - 3, -1, -1):
        v = reflectors[k]
        sums[:] = 0.0
        for i in range(k + 1, n):
            row, f = vectors[i], v[i]
            for j in range(m):
                sums[j] += f * row[j]
        for i in range(k + 1, n):
            row, f = vectors[i], scales[k] * v[i]
            for j in range(m):
                row[j] -= f * sums[j]
