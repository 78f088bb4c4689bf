"""The order inside a leaf, against elimination of a dense pattern."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltrami.solvers.dissection import dissect
from beltrami.solvers.elimination import eliminate
from beltrami.solvers.leaves import MOST, count_bits, lowest_bit, order_leaf
from definite_matrices import as_columns, definite_matrices, grid


@given(st.integers(1, 2**64 - 1))
def test_bits(x):
    assert count_bits(np.uint64(x)) == x.bit_count()
    assert lowest_bit(np.uint64(x)) == (x & -x).bit_length() - 1


def _ordered(A, low, high):
    n = A.shape[0]
    order, slot = np.arange(n).astype(np.uint64), np.full(n, -1)
    ends, parents = np.empty(MOST, np.int64), np.empty(MOST, np.int64)
    count = order_leaf(
        as_columns(A).indptr.astype(np.uint64), as_columns(A).indices.astype(np.uint32),
        order, low, high, slot, ends, parents,
    )  # fmt: skip
    assert (slot == -1).all()
    assert sorted(order[low:high].tolist()) == list(range(low, high))
    assert (order[:low] == np.arange(low)).all()
    assert (order[high:] == np.arange(high, n)).all()
    return order.astype(int), ends[:count], parents[:count]


def _degrees(A, order, m):
    """The oracle: the degree at each elimination of the first m, and the least one there was."""
    full = A[order][:, order].toarray() != 0
    np.fill_diagonal(full, False)
    found = []
    for t in range(m):
        degrees = full[t:m, t:].sum(axis=1)
        found.append((int(degrees[0]), int(degrees.min())))
        later = np.flatnonzero(full[t, t + 1 :]) + t + 1
        full[np.ix_(later, later)] = True
        np.fill_diagonal(full, False)
    return found


def test_a_tree_is_eliminated_without_fill():
    """Leaves first: minimum degree finds that, and blocks may store some zeros only."""
    n = 63
    children = np.arange(1, n)
    A = np.eye(n) * 4
    A[children, (children - 1) // 2] = A[(children - 1) // 2, children] = -1
    order, _, _ = _ordered(as_columns(A), 0, n)
    filled = np.linalg.cholesky(A[np.ix_(order, order)])
    assert (abs(filled) > 1e-12).sum() == 2 * n - 1


@pytest.mark.parametrize(("low", "high"), [(0, 64), (0, 20), (30, 80)])
def test_degrees_are_small_and_blocks_are_a_tree(low, high):
    A = grid(10, 9)
    order, ends, parents = _ordered(A, low, high)
    m = high - low
    assert ends[-1] == m
    assert (np.diff(ends) > 0).all()
    own = np.arange(len(parents))
    assert ((parents > own) | (parents == -1)).all()
    rest = np.r_[order[low:high], order[:low], order[high:]]
    mine, given_order = (
        sum(one for one, _ in _degrees(A, way, m))
        for way in (rest, np.r_[low:high, 0:low, high : A.shape[0]])
    )
    assert mine < given_order


@given(definite_matrices())
def test_blocks_of_leaves_hold_what_they_fill(A):
    """Columns of different blocks of a leaf meet only if one block is above the other."""
    m = min(A.shape[0], MOST)
    order, ends, parents = _ordered(A, 0, m)
    full = A[order][:, order].toarray() != 0
    for t in range(m):
        later = np.flatnonzero(full[t + 1 :, t]) + t + 1
        full[np.ix_(later, later)] = True
    block = np.repeat(np.arange(len(ends)), np.diff(ends, prepend=0))
    for i, j in np.argwhere(np.tril(full[:m, :m])):
        k = block[j]
        while k >= 0 and k != block[i]:
            k = parents[k]
        assert k == block[i]


def test_few_zeros_are_stored():
    """Of 64 x 64 unknowns few entries are stored in vain."""
    A = as_columns(grid(64, 64))
    pattern = A.indptr.astype(np.int64), A.indices.astype(np.int32)
    blocks = eliminate(*pattern, dissect(*pattern, None))
    full = A[blocks.order][:, blocks.order]
    rows = [set() for _ in range(4096)]
    parent = np.full(4096, -1)
    for t in range(4096):
        rows[t] |= {int(i) for i in full.indices[full.indptr[t] : full.indptr[t + 1]] if i > t}
        if rows[t]:
            parent[t] = min(rows[t])
            rows[parent[t]] |= rows[t] - {int(parent[t])}
    needed = sum(len(one) + 1 for one in rows)
    assert needed <= blocks.entries < 1.5 * needed
