"""The parts of the factorisation of one front, against dense matrices."""

import numpy as np
import pytest

from beltrami.solvers.blas import blas
from beltrami.solvers.elimination import stride
from beltrami.solvers.fronts import ROOM, SMALL, WIDTH, descend, put_away, triangle
from beltrami.solvers.fronts import _factorize as factorize
from beltrami.solvers.many import ONE, TWO


def _front(rng, columns, below, dtype="f8"):
    n = columns + below
    root = rng.normal(size=(n, n + 3))
    A = root @ root.T + n * np.eye(n)
    panel = np.zeros((columns, n), dtype)  # by columns; nobody looks above the diagonal
    for j in range(columns):
        panel[j, :j], panel[j, j:] = 1e3, A[j:, j]
    update = np.full((below, stride(below)), 7e3, dtype)
    for j in range(below):
        update[j, j:below] = A[columns + j :, columns + j]
    return A, panel, update


@pytest.mark.parametrize(("dtype", "rounding"), [("f8", 1e-9), ("f4", 1e-3)])
@pytest.mark.parametrize("columns", [1, 2, 5, 8, 11, 12, 20, SMALL, SMALL + 1, WIDTH + 1, 130])
@pytest.mark.parametrize("below", [0, 1, 4, 15, 16, 19, 40])
def test_a_front(columns, below, dtype, rounding):
    """L11 and L21 of Cholesky, and the Schur complement; what follows the panel stays."""
    A, panel, update = _front(np.random.default_rng(299 + columns), columns, below, dtype)
    kept = np.r_[panel.ravel(), np.full(99, 5.0, dtype)]
    flat, rest = kept[: panel.size], update.ravel()
    offsets = np.empty(columns + below + 8, np.int64)
    lines = TWO if dtype == "f8" else ONE
    room = np.zeros(ROOM, dtype)
    assert factorize(blas(dtype), flat, columns, below, rest, offsets, room, lines) == 0
    assert (kept[panel.size :] == 5).all()
    L, panel = np.linalg.cholesky(A), flat.reshape(panel.shape)
    for j in range(columns):
        assert np.allclose(panel[j, j:], L[j:, j], rtol=rounding, atol=rounding)
    schur = L[columns:, columns:] @ L[columns:, columns:].T
    found = rest.reshape(update.shape)[:, :below].T
    lower = np.tril_indices(below)
    assert np.allclose(found[lower], schur[lower], rtol=rounding, atol=rounding * columns)


def test_rows_in_the_middle_of_a_panel():
    """The triangle need not be the first, and there may be no update."""
    rng = np.random.default_rng(8)
    height, corner, rows = 40, 3 * 40 + 3, 21
    panel = rng.uniform(1, 2, 6 * height)
    block = panel.reshape(6, height)[3:6, 3:].T  # a view: columns 3 to 6
    expected = np.linalg.solve(np.tril(block[:3]), block[3 : 3 + rows].T).T
    rest = block[3 + rows :].copy()
    descend(panel, corner, 3, rows, height, 0, 0, np.empty(11, np.int64), np.zeros(ROOM), TWO)
    assert np.allclose(block[3 : 3 + rows], expected, rtol=1e-12)
    assert np.array_equal(block[3 + rows :], rest)


@pytest.mark.parametrize("wrong", [-2.0, -1e-6, np.nan])
def test_the_column_without_a_pivot_is_told(wrong):
    A, panel, _ = _front(np.random.default_rng(5), 4, 3)
    pivot = A[2, 2] - A[2, :2] @ np.linalg.solve(A[:2, :2], A[:2, 2])
    panel[2, 2] += wrong - pivot
    b = blas("f8")
    assert triangle(b, panel.ravel(), 4, 7) == 3
    if wrong < 0:
        assert panel[2, 2] == pytest.approx(wrong)
    assert triangle(b, np.zeros(3), 1, 3) == 1


@pytest.mark.parametrize("columns", [20, SMALL + 3, 2 * WIDTH + 5])
def test_the_failing_column_of_a_larger_front(columns):
    _, panel, update = _front(np.random.default_rng(6), columns, 5)
    panel[columns - 2, columns - 2] = -1
    flat, offsets, room = panel.ravel(), np.empty(columns + 13, np.int64), np.zeros(ROOM)
    assert (
        factorize(blas("f8"), flat, columns, 5, update.ravel(), offsets, room, TWO) == columns - 1
    )
    assert flat.reshape(panel.shape)[columns - 2, columns - 2] < 0


@pytest.mark.parametrize("base", [0, 2, 7, 20])
def test_an_update_moves_down_even_into_its_own_place(base):
    """The lower triangle arrives whole, whether or not the places overlap."""
    below, top = 5, 20
    size = below * stride(below)
    stack, stack_at = np.arange(top + size + 0.0), np.zeros(3, np.int64)
    update = stack[top : top + size]
    before = update.reshape(below, -1)[:, :below].copy()
    assert put_away(stack, stack_at, 1, update, below, base, top) == base + size
    after = stack[base : base + size].reshape(below, -1)[:, :below]
    for j in range(below):
        assert (after[j, j:] == before[j, j:]).all()
    assert stack_at.tolist() == [0, base, 0]
