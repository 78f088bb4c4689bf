"""The inner loops of iterative solvers: products that share the matrix, updates that share a pass.

The matrix is symmetric, so that its columns are its rows. Sums are formed in lanes: the same bits
on one machine, whatever the number of threads.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import csc_array

from beltrami._arrays import Floats
from beltrami._jit import kernel, summing_kernel, unsigned

AT_ONCE = 4  # vectors that one pass over the matrix multiplies


def multiply(matrix: csc_array, vectors: list[Floats], products: list[Floats]) -> None:
    """Write A p into q for each p and q of two lists of at most four."""
    arrays = unsigned(matrix.indptr), unsigned(matrix.indices), matrix.data
    if len(vectors) == AT_ONCE:
        multiply_four(*arrays, *vectors, *products)
    else:
        for p, q in zip(vectors, products, strict=True):
            multiply_one(*arrays, p, q)


@kernel
def multiply_one(indptr: Any, indices: Any, data: Any, p: Any, q: Any) -> None:
    """Write A p into q."""
    one = np.uint64(1)
    for i in range(np.uint64(p.size)):
        total = 0.0
        for k in range(np.uint64(indptr[i]), np.uint64(indptr[i + one])):
            total += data[k] * p[np.uint64(indices[k])]
        q[i] = total


@kernel
def multiply_four(
    indptr: Any,
    indices: Any,
    data: Any,
    p0: Any,
    p1: Any,
    p2: Any,
    p3: Any,
    q0: Any,
    q1: Any,
    q2: Any,
    q3: Any,
) -> None:
    """Write A p into q for four pairs."""
    one = np.uint64(1)
    for i in range(np.uint64(p0.size)):
        a0 = a1 = a2 = a3 = 0.0
        for k in range(np.uint64(indptr[i]), np.uint64(indptr[i + one])):
            value, j = data[k], np.uint64(indices[k])
            a0 += value * p0[j]
            a1 += value * p1[j]
            a2 += value * p2[j]
            a3 += value * p3[j]
        q0[i], q1[i], q2[i], q3[i] = a0, a1, a2, a3


@summing_kernel
def dot(a: Any, b: Any) -> float:
    """Return <a, b>."""
    total = 0.0
    for i in range(np.uint64(a.size)):
        total += a[i] * b[i]
    return total


@summing_kernel
def turn(p: Any, z: Any, beta: float) -> None:
    """P <- z + β p."""
    for i in range(np.uint64(p.size)):
        p[i] = z[i] + beta * p[i]


@summing_kernel
def descend(x: Any, r: Any, p: Any, q: Any, alpha: float) -> float:
    """X <- x + α p, r <- r - α q; return <r, r>."""
    total = 0.0
    for i in range(np.uint64(x.size)):
        x[i] += alpha * p[i]
        left = r[i] - alpha * q[i]
        r[i] = left
        total += left * left
    return total


@summing_kernel
def recur(older: Any, newer: Any, q: Any, a: float, b: float, scale: float) -> None:
    """Replace ``older`` by (q - a newer - b older) / scale: the recursions of three terms."""
    for i in range(np.uint64(q.size)):
        older[i] = (q[i] - a * newer[i] - b * older[i]) / scale


@summing_kernel
def blend(r: Any, v: Any, a: float, b: float) -> float:
    """R <- a r + b v; return <r, r>."""
    total = 0.0
    for i in range(np.uint64(r.size)):
        left = a * r[i] + b * v[i]
        r[i] = left
        total += left * left
    return total
