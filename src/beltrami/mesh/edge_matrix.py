"""Symmetric sparse matrices with one value for each edge: the shape of A, W and L."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel


def symmetric_matrix(
    edges: Integers, values: Floats, n: int, diagonal: Floats | None = None
) -> csr_array:
    """Return the symmetric (n, n) matrix with these values on the edges and on the diagonal.

    The edges come once each, i < j, in lexicographic order; then the rows are sorted without
    sorting anything. Without ``diagonal``, no diagonal is stored. Cost: O(n + p).

    Examples
    --------
    >>> edges = np.array([[0, 1], [1, 2]])
    >>> symmetric_matrix(edges, np.array([5.0, 7.0]), 3, np.ones(3)).toarray()
    array([[1., 5., 0.],
           [5., 1., 7.],
           [0., 7., 1.]])
    """
    own = 0 if diagonal is None else 1
    indptr = np.zeros(n + 1, np.int32)
    size = 2 * len(edges) + own * n
    indices, data = np.empty(size, np.int32), np.empty(size)
    _fill(edges, values, np.zeros(0) if diagonal is None else diagonal, own, indptr, indices, data)
    return csr_array((data, indices, indptr), shape=(n, n))


def edge_sums(edges: Integers, values: Floats, n: int) -> Floats:
    """Return, for each of n vertices, the sum of the values of its edges; O(n + p).

    Examples
    --------
    >>> edge_sums(np.array([[0, 1], [1, 2]]), np.array([5.0, 7.0]), 3).tolist()
    [5.0, 12.0, 7.0]
    """
    sums = np.zeros(n)
    _add_to_ends(edges, values, sums)
    return sums


@kernel
def _add_to_ends(edges: Any, values: Any, sums: Any) -> None:
    """Add the value of each edge at both of its ends."""
    for e in range(edges.shape[0]):
        sums[edges[e, 0]] += values[e]
        sums[edges[e, 1]] += values[e]


@kernel
def _fill(
    edges: Any, values: Any, diagonal: Any, own: int, indptr: Any, indices: Any, data: Any
) -> None:
    """Fill the CSR arrays: in each row the smaller neighbours, the diagonal, the larger ones."""
    n = indptr.size - 1
    p = edges.shape[0]
    for e in range(p):
        indptr[edges[e, 0] + 1] += 1
        indptr[edges[e, 1] + 1] += 1
    for i in range(n):
        indptr[i + 1] += indptr[i] + own
    place = indptr[:n].copy()
    for e in range(p):
        j = edges[e, 1]
        indices[place[j]] = edges[e, 0]
        data[place[j]] = values[e]
        place[j] += 1
    e = 0
    for i in range(n):
        q = place[i]
        if own:
            indices[q] = i
            data[q] = diagonal[i]
            q += 1
        while e < p and edges[e, 0] == i:
            indices[q] = edges[e, 1]
            data[q] = values[e]
            q += 1
            e += 1
