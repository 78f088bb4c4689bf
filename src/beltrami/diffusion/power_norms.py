"""The norms of the rows of the powers of a sparse matrix, without the powers."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats
from beltrami._jit import kernel, unsigned


def power_norms(K: csr_array, most: int) -> Floats:
    r"""Return :math:`|K^k_{i \cdot}|` for k = 1, ..., ``most``; (most, n).

    Row by row, so that nothing but the norms is kept: the cube of Id - W̃ has some forty entries
    for each vertex of a mesh. Cost: what the products would take, without their memory.

    Examples
    --------
    >>> K = csr_array([[1.0, -1.0], [0.0, 2.0]])
    >>> (power_norms(K, 2) ** 2).round(9).tolist()
    [[2.0, 4.0], [10.0, 16.0]]
    """
    norms = np.empty((most, K.shape[0]))
    _norms(unsigned(K.indptr), unsigned(K.indices), K.data, norms)
    return norms


@kernel
def _norms(indptr: Any, indices: Any, data: Any, norms: Any) -> None:
    """Multiply each row of the identity by K again and again; a stamp says what is in it."""
    one, n = np.uint64(1), np.uint64(norms.shape[1])
    values, sums = np.empty(n), np.empty(n)
    columns, coming, stamps = np.empty(n, np.uint32), np.empty(n, np.uint32), np.zeros(n, np.uint64)
    stamp = np.uint64(0)
    for i in range(n):
        columns[0], values[0], count = i, 1.0, one
        for k in range(norms.shape[0]):
            stamp += one
            size = np.uint64(0)
            for s in range(count):
                j, value = np.uint64(columns[s]), values[s]
                for q in range(np.uint64(indptr[j]), np.uint64(indptr[j + one])):
                    c = np.uint64(indices[q])
                    if stamps[c] != stamp:
                        stamps[c], sums[c] = stamp, 0.0
                        coming[size] = c
                        size += one
                    sums[c] += value * data[q]
            total = 0.0
            for s in range(size):
                c = np.uint64(coming[s])
                columns[s], values[s] = c, sums[c]
                total += sums[c] * sums[c]
            norms[k, i] = np.sqrt(total)
            count = size
