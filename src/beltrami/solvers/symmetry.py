"""Is a matrix symmetric, and may it be positive definite? What its entries alone can tell."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import csc_array

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel, unsigned

_EQUAL = 1e-14  # relative difference of a_ij and a_ji that counts as rounding


def is_symmetric(matrix: csc_array) -> bool:
    """Check a_ij = a_ji to rounding, beside the largest entry."""
    difference = abs(matrix - matrix.T)
    scale = abs(matrix.data).max(initial=0.0)
    return difference.nnz == 0 or float(difference.max()) <= _EQUAL * scale


def rows_against_definite(matrix: csc_array) -> Integers:
    """Return rows that show that a matrix is not symmetric positive definite, or none.

    Such a matrix has a_ii > 0, a_ij = a_ji (to rounding, beside the diagonal, so that units do not
    count) and a_ij² <= a_ii a_jj. The first that fail are told: (i,) or (i, j). The rows of each
    column are sorted, and none stands twice. Cost: one pass.
    """
    diagonal = matrix.diagonal()
    wrong = np.flatnonzero(~(diagonal > 0))
    if len(wrong):
        return wrong[:1]
    return _misfit(matrix, np.sqrt(diagonal), True)


def rows_against_symmetric(matrix: csc_array) -> Integers:
    """Return the first pair (i, j) with different a_ij and a_ji, or none.

    The difference counts beside the largest entries of row i and row j.
    """
    return _misfit(matrix, np.sqrt(largest_entries(matrix)), False)


def largest_entries(matrix: csc_array) -> Floats:
    """Return the largest absolute value of each row; 1 where there is none."""
    largest = np.zeros(matrix.shape[0])
    np.maximum.at(largest, matrix.indices, np.abs(matrix.data))
    largest[largest == 0] = 1
    return largest


def _misfit(matrix: csc_array, root: Floats, definite: bool) -> Integers:
    starts = matrix.indptr.astype(np.uint64)
    i, j = _first_misfit(
        starts, unsigned(matrix.indices), matrix.data, root, starts[:-1].copy(), definite
    )
    return np.array([i, j] if i >= 0 else [], np.int64)


@kernel
def _first_misfit(indptr: Any, indices: Any, data: Any, root: Any, at: Any, definite: bool) -> Any:
    """Walk down each column; its entries meet their mirror images in the order of the columns.

    ``at[i]`` is the next entry of column i that has not been met.
    """
    one = np.uint64(1)
    for j in range(np.uint64(at.size)):
        for q in range(indptr[j], indptr[j + one]):
            i = np.uint64(indices[q])
            p = at[i]
            at[i] = p + one
            if p == indptr[i + one] or np.uint64(indices[p]) != j:
                return np.int64(i), np.int64(j)
            scale = root[i] * root[j]
            large = definite and abs(data[q]) > (1 + 1e-12) * scale
            if large or abs(data[p] - data[q]) > _EQUAL * scale:
                return np.int64(i), np.int64(j)
    return np.int64(-1), np.int64(-1)
