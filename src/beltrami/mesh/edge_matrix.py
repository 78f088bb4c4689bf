"""Symmetric sparse matrices with one value for each edge: the shape of A, W and L."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats, Integers, unwritten
from beltrami._jit import kernel, unsigned


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
    return _filled(edges, values, n, np.zeros(0) if diagonal is None else diagonal, False)


def laplacian_matrix(edges: Integers, weights: Floats, n: int) -> csr_array:
    """Return D - W: minus the weights on the edges, their sums on the diagonal; O(n + p).

    Examples
    --------
    >>> laplacian_matrix(np.array([[0, 1], [1, 2]]), np.array([5.0, 7.0]), 3).toarray()
    array([[ 5., -5.,  0.],
           [-5., 12., -7.],
           [ 0., -7.,  7.]])
    """
    return _filled(edges, weights, n, np.zeros(n), True)


def _filled(
    edges: Integers, values: Floats, n: int, diagonal: Floats, laplacian: bool
) -> csr_array:
    """Return the matrix; its diagonal is stored where one of n values is given."""
    indptr = np.zeros(n + 1, np.int32)
    size = 2 * len(edges) + len(diagonal)
    indices, data = unwritten(size, np.int32), unwritten(size, np.float64)
    pattern = (unsigned(indptr), unsigned(indices))
    _fill(unsigned(edges), values, diagonal, laplacian, *pattern, data)
    matrix = csr_array((data, indices, indptr), shape=(n, n))
    matrix.has_canonical_format = True  # known: scipy need not look
    return matrix


@kernel
def _fill(
    edges: Any, values: Any, diagonal: Any, laplacian: bool, indptr: Any, indices: Any, data: Any
) -> None:
    """Fill the CSR arrays: in each row the smaller neighbours, the diagonal, the larger ones.

    ``indptr`` comes as zeros and holds the ends of the rows, until the last loop moves them. When
    row i begins, its smaller neighbours are in it, and in the sum on its diagonal. For a
    Laplacian the values change their sign and are summed into the diagonal.
    """
    one, zero = np.uint64(1), np.uint64(0)
    own = np.uint64(diagonal.size > 0)
    sign = -1.0 if laplacian else 1.0
    n, p = np.uint64(indptr.size) - one, np.uint64(edges.shape[0])
    e = i = start = zero
    while e < p:
        indptr[edges[e, 0]] += one
        indptr[edges[e, 1]] += one
        e += one
    while i < n:  # counts to starts
        size = np.uint64(indptr[i]) + own
        indptr[i] = start
        start += size
        i += one
    e = i = zero
    while i < n:
        place = np.uint64(indptr[i])
        total = diagonal[i] if own else 0.0
        q = place + own
        while e < p and edges[e, 0] == i:
            j, value = edges[e, 1], values[e]
            indices[q], data[q] = j, sign * value
            q += one
            e += one
            there = np.uint64(indptr[j])
            indices[there], data[there] = i, sign * value
            indptr[j] = there + one
            if laplacian:
                total += value
                diagonal[j] += value
        if own:
            indices[place], data[place] = i, total
        indptr[i] = q
        i += one
    while i > zero:  # ends to starts
        indptr[i] = indptr[i - one]
        i -= one
    indptr[zero] = 0
