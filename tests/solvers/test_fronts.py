"""The parts of the factorisation of one front, against dense matrices."""

import numpy as np
import pytest

from beltrami.solvers.fronts import factorize_narrow, put_away


def _front(rng, columns, below):
    n = columns + below
    root = rng.normal(size=(n, n + 3))
    A = root @ root.T
    panel = np.full((columns, n), np.nan)  # by columns; nobody looks above the diagonal
    for j in range(columns):
        panel[j, j:] = A[j:, j]
    update = np.full((below, below), np.nan)
    for j in range(below):
        update[j, j:] = A[columns + j :, columns + j]
    return A, panel, update


@pytest.mark.parametrize("columns", [1, 2, 5, 11])
@pytest.mark.parametrize("below", [0, 1, 4, 19])
def test_a_narrow_front(columns, below):
    """L11 and L21 of Cholesky, and the Schur complement."""
    A, panel, update = _front(np.random.default_rng(299 + columns), columns, below)
    flat, rest = panel.ravel(), update.ravel()
    assert factorize_narrow(flat, np.uint64(columns), np.uint64(columns + below), rest) == 0
    L = np.linalg.cholesky(A)
    for j in range(columns):
        assert np.allclose(panel[j, j:], L[j:, j], rtol=1e-10)
    schur = L[columns:, columns:] @ L[columns:, columns:].T
    assert np.allclose(update.T[np.tril_indices(below)], schur[np.tril_indices(below)], rtol=1e-9)


@pytest.mark.parametrize("wrong", [-2.0, -1e-6, np.nan])
def test_the_column_without_a_pivot_is_told(wrong):
    A, panel, update = _front(np.random.default_rng(5), 4, 3)
    pivot = A[2, 2] - A[2, :2] @ np.linalg.solve(A[:2, :2], A[:2, 2])
    panel[2, 2] += wrong - pivot
    assert factorize_narrow(panel.ravel(), np.uint64(4), np.uint64(7), update.ravel()) == 3
    if wrong < 0:
        assert panel[2, 2] == pytest.approx(wrong)
    assert factorize_narrow(np.zeros(3), np.uint64(1), np.uint64(3), np.zeros(4)) == 1


@pytest.mark.parametrize("base", [0, 2, 7, 20])
def test_an_update_moves_down_even_into_its_own_place(base):
    """The lower triangle arrives whole, whether or not the places overlap."""
    stack, stack_at = np.arange(60.0), np.zeros(3, np.int64)
    top, below = 20, 5
    update = stack[top : top + below * below]
    before = update.reshape(below, below).copy()
    assert put_away(stack, stack_at, 1, update, np.uint64(below), base, top) == base + 25
    after = stack[base : base + 25].reshape(below, below)
    for j in range(below):
        assert (after[j, j:] == before[j, j:]).all()
    assert stack_at.tolist() == [0, base, 0]
