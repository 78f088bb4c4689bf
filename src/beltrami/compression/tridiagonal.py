"""Symmetric matrices to tridiagonal ones and vectors back, in a fixed order of operations.

Whatever a compressed file means depends on every bit of the eigenvectors. So no BLAS: sums have
the order of these loops, in which each entry of a row goes its own way (compilers may take several
at a time, and change nothing by it).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel, plain_kernel


@kernel
def tridiagonalise(A: Any, d: Any, e: Any, reflectors: Any, scales: Any) -> None:
    """Find T = QᵀAQ by reflections: (n,) diagonal d, (n - 1,) beside it e; A is used up.

    Q is the product of the Id - s v vᵀ, with v in ``reflectors[k]``, zero up to k, and s in
    ``scales[k]``. 2 n³ operations, in one walk over A for each k: it subtracts v pᵀ + p vᵀ of the
    reflection before, and multiplies by the next v, of the row that is ready first.
    """
    n = d.size
    work = np.zeros((3, n))  # v and p of the reflection before, and the next p
    pending = False
    for k in range(n - 2):
        v = reflectors[k]
        if pending:
            _subtract(A, work, k, k, k + 1)
        s = _reflector(A[k], k + 1, v)
        scales[k] = s
        d[k] = A[k, k]
        e[k] = A[k, k + 1]
        if pending and s != 0.0:
            _subtract_and_multiply(A, work, v, k + 1)
        elif pending:
            _subtract(A, work, k + 1, k + 1, n)
        elif s != 0.0:
            _multiply(A, work, v, k + 1)
        pending = s != 0.0
        if pending:
            _prepare(work, v, s, k + 1)
    if pending:
        _subtract(A, work, n - 2, n - 2, n)
    if n > 1:
        d[n - 2], e[n - 2] = A[n - 2, n - 2], A[n - 2, n - 1]
    d[n - 1] = A[n - 1, n - 1]


@plain_kernel
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


@plain_kernel
def _prepare(work: Any, v: Any, s: float, first: int) -> None:
    """Make p = s Av - (s/2)(v · sAv) v of the product Av, and keep v beside it."""
    p = work[2]
    half = 0.0
    for i in range(first, v.size):
        p[i] *= s
        half += v[i] * p[i]
    half *= 0.5 * s
    for i in range(first, v.size):
        work[1, i] = p[i] - half * v[i]
        work[0, i] = v[i]


@plain_kernel
def _multiply(A: Any, work: Any, v: Any, first: int) -> None:
    """Write A[first:, first:] v[first:] to work[2, first:]; A is symmetric."""
    sums = work[2, first:]
    sums[:] = 0.0
    for j in range(first, v.size):
        row, factor = A[j, first:], v[j]
        for i in range(sums.size):
            sums[i] += factor * row[i]


@plain_kernel
def _subtract(A: Any, work: Any, low: int, first: int, high: int) -> None:
    """Subtract v pᵀ + p vᵀ from A[low:high, first:]."""
    v, p = work[0, first:], work[1, first:]
    for j in range(low, high):
        row, f, g = A[j, first:], work[0, j], work[1, j]
        for i in range(row.size):
            row[i] -= f * p[i] + g * v[i]


@plain_kernel
def _subtract_and_multiply(A: Any, work: Any, v: Any, first: int) -> None:
    """Subtract as above from A[first:, first:], then multiply it by the next v, two rows a time."""
    n = v.size
    b, a, sums = work[0, first:], work[1, first:], work[2, first:]
    sums[:] = 0.0
    even = first + (n - first) // 2 * 2
    for j in range(first, even, 2):
        row, below = A[j, first:], A[j + 1, first:]
        f, g, h = work[0, j], work[1, j], v[j]
        k, m, q = work[0, j + 1], work[1, j + 1], v[j + 1]
        for i in range(sums.size):
            x = row[i] - (f * a[i] + g * b[i])
            y = below[i] - (k * a[i] + m * b[i])
            row[i], below[i] = x, y
            sums[i] = (sums[i] + h * x) + q * y
    for j in range(even, n):
        _subtract(A, work, j, first, j + 1)
        row, h = A[j, first:], v[j]
        for i in range(sums.size):
            sums[i] += h * row[i]


@plain_kernel
def turn(reflectors: Any, scales: Any, x: Any) -> None:
    """Multiply the columns of ``x`` (n, d) by Qᵀ; 4 n² d operations."""
    n, d = x.shape
    for k in range(n - 2):
        v = reflectors[k]
        for q in range(d):
            s = 0.0
            for i in range(k + 1, n):
                s += v[i] * x[i, q]
            s *= scales[k]
            for i in range(k + 1, n):
                x[i, q] -= s * v[i]


_COLUMNS = 64  # that are turned together, so that they stay near


@kernel
def turn_back(reflectors: Any, scales: Any, vectors: Any) -> None:
    """Multiply the columns of ``vectors`` (n, m) by Q; 2 n² m operations."""
    m = vectors.shape[1]
    for first in range(0, m, _COLUMNS):
        last = min(first + _COLUMNS, m)
        part = np.ascontiguousarray(vectors[:, first:last])
        _turn(reflectors, scales, part)
        vectors[:, first:last] = part


@kernel
def _turn(reflectors: Any, scales: Any, part: Any) -> None:
    """Multiply by Q: a walk over the rows for each reflection, which sums up for the next one."""
    n, m = part.shape
    sums = np.zeros((2, m))
    for i in range(max(n - 2, 0), n if n > 2 else 0):
        _gather(part[i], reflectors[n - 3, i], sums[0])
    for k in range(n - 3, -1, -1):
        old, new = sums[(n - 3 - k) % 2], sums[(n - 2 - k) % 2]
        new[:] = 0.0
        v, w, s = reflectors[k], reflectors[max(k - 1, 0)], scales[k]
        if k > 0:
            _gather(part[k], w[k], new)
        even = k + 1 + (n - k - 1) // 2 * 2
        for i in range(k + 1, even, 2):
            row, below = part[i], part[i + 1]
            f, g, h, q = s * v[i], s * v[i + 1], w[i], w[i + 1]
            for j in range(m):
                x, y = row[j] - f * old[j], below[j] - g * old[j]
                row[j], below[j] = x, y
                new[j] = (new[j] + h * x) + q * y
        for i in range(even, n):
            row, f, h = part[i], s * v[i], w[i]
            for j in range(m):
                row[j] -= f * old[j]
                new[j] += h * row[j]


@plain_kernel
def _gather(row: Any, factor: float, sums: Any) -> None:
    for j in range(row.size):
        sums[j] += factor * row[j]
