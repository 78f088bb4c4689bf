"""Substitution in tiles against dense triangles, for every width and height of a panel."""

import numpy as np
import pytest

from beltrami.solvers.many import (
    enter_many,
    leave_many,
    lines_for,
    solve_many,
    solve_many_transposed,
)


def _panel(rng, columns, below, dtype):
    """One panel on top of unknowns of their own: L = [[L11, 0], [L21, 1]]."""
    n = columns + 2 * below  # every other of the unknowns after it is a row
    rows = np.arange(columns + 1, n, 2).astype(np.int32)
    L = np.eye(n)
    L[:columns, :columns] = np.tril(rng.normal(size=(columns, columns))) / columns
    L[np.arange(columns), np.arange(columns)] = rng.uniform(1, 2, columns)
    L[rows, :columns] = rng.normal(size=(len(rows), columns))
    height = columns + len(rows)
    panel = np.full((columns, height), np.nan)  # what is above the diagonal has no meaning
    panel[:, columns:] = L[rows, :columns].T
    inside = L[:columns, :columns].T
    panel[:, :columns] = np.where(np.triu(np.ones_like(inside)) > 0, inside, np.nan)
    singles = n - columns
    starts = np.r_[0, np.arange(columns, n + 1)]
    row_starts = np.r_[0, np.full(singles + 1, len(rows))]
    panels = np.r_[0, columns * height + np.arange(singles + 1)]
    values = np.r_[panel.ravel(), np.ones(singles)].astype(dtype)
    return L.astype(dtype).astype(float), (values, starts, row_starts, rows, panels)


@pytest.mark.parametrize(("dtype", "rounding"), [("f8", 1e-13), ("f4", 1e-4)])
@pytest.mark.parametrize("columns", [1, 2, 3, 7, 8, 15, 16, 17, 35])
@pytest.mark.parametrize("below", [0, 1, 6, 15, 20])
@pytest.mark.parametrize("reordered", [False, True])
def test_a_panel(columns, below, reordered, dtype, rounding):
    """Unknowns stand in their own order, or anywhere."""
    rng = np.random.default_rng(1000 * columns + below)
    L, panel = _panel(rng, columns, below, dtype)
    n = len(L)
    order = rng.permutation(n) if reordered else np.arange(0)
    place = order if reordered else slice(None)
    for count in (1, 5, 9, 40):
        b = rng.normal(size=(n, count))
        x = lines_for(n, count, dtype)
        x[:] = 0
        x[place, :count] = b
        offsets = np.empty(n, np.int64)
        solve_many(*panel, order, x, offsets)
        expected = np.linalg.solve(L, x.dtype.type(1) * b)
        assert np.allclose(
            x[place, :count], expected, rtol=rounding, atol=rounding * abs(expected).max()
        )
        assert (x[:, count:] == 0).all()
        x[:] = 0
        x[place, :count] = b
        solve_many_transposed(*panel, order, x, offsets)
        expected = np.linalg.solve(L.T, b)
        assert np.allclose(
            x[place, :count], expected, rtol=rounding, atol=rounding * abs(expected).max()
        )


def test_small_products_are_summed_before_they_meet_a_large_number():
    """One after the other each would be rounded as the large one is: twenty times as far off."""
    columns, large = 400, 1000.0
    row = np.random.default_rng(0).uniform(0, 1e-3, columns).astype("f4")
    panel = np.c_[np.eye(columns), row]
    values = np.r_[panel.ravel(), 1].astype("f4")
    starts, row_starts, rows = np.array([0, columns, columns + 1]), np.array([0, 1, 1]), [columns]
    panels = np.array([0, panel.size, panel.size + 1])
    x = lines_for(columns + 1, 4, "f4")
    x[:] = 1
    x[columns] = large
    solve_many(
        values, starts, row_starts, np.array(rows, np.int32), panels, np.arange(0), x,
        np.empty(columns + 1, np.int64),
    )  # fmt: skip
    away = np.abs(x[columns].astype(float) - (large - row.astype(float).sum()))
    assert away.max() <= np.spacing(np.float32(large))


@pytest.mark.parametrize("dtype", ["f8", "f4"])
@pytest.mark.parametrize("count", [1, 4, 5, 8, 9, 17])
@pytest.mark.parametrize("reordered", [False, True])
def test_entering_and_leaving(count, reordered, dtype):
    rng = np.random.default_rng(count)
    b, order, scale = rng.normal(size=(11, 30)), np.arange(11), rng.uniform(1, 2, 11)
    if reordered:
        order = rng.permutation(11)
    given = order if reordered else np.arange(0)
    x = lines_for(11, count, dtype)
    assert x.ctypes.data % 64 == 0
    size = count * x.itemsize
    assert x.strides == (32 if size <= 32 else -(-size // 64) * 64, x.itemsize)
    x[:] = np.nan
    enter_many(b, 5, count, given, scale, x)
    assert np.array_equal(x[:, :count], (b * scale[:, None])[order][:, 5 : 5 + count].astype(dtype))
    assert (x[:, count:] == 0).all()
    result = np.full((11, 30), np.inf)
    leave_many(x, count, np.argsort(given), scale, 5, result)
    expected = x[np.argsort(order)][:, :count].astype(float) * scale[:, None]
    assert np.array_equal(result[:, 5 : 5 + count], expected)
    assert np.isinf(np.delete(result, np.s_[5 : 5 + count], axis=1)).all()


def test_leaving_in_place():
    x, scale = lines_for(7, 8, "f8"), np.arange(7.0)
    x[:] = 3
    leave_many(x, 8, np.arange(0), scale, 0, x)
    assert np.array_equal(x, np.repeat(3 * scale[:, None], 8, axis=1))
