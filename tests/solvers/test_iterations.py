"""Conjugate gradients and minres: one contract for both, and the errors of what does not go."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from scipy.sparse import coo_array, csc_array, csr_array, diags_array

from beltrami.errors import (
    BeltramiError,
    ConvergenceError,
    DimensionError,
    NonFiniteError,
    NotPositiveDefiniteError,
    UnknownNameError,
)
from beltrami.solvers.conjugate_gradients import conjugate_gradients
from beltrami.solvers.factorize import factorize
from beltrami.solvers.minres import minres
from definite_matrices import NAMED, arrow, definite_matrices, grid, path

BOTH = [conjugate_gradients, minres]
WELL = [name for name in NAMED if name != "nearly singular"]


def _relative(A, x, b):
    return np.linalg.norm(b - A @ x, axis=0) / np.linalg.norm(b, axis=0)


def _mixed(n=50):
    """Eigenvalues of both signs, none near zero."""
    signs = np.where(np.arange(n) % 3, 1.0, -1.0)
    return csr_array(path(n) * 0.2 + diags_array(signs * np.linspace(1, 4, n)))


@pytest.mark.parametrize("solve", BOTH)
@pytest.mark.parametrize("name", WELL)
def test_the_true_residual_is_below_the_tolerance(solve, name):
    A = NAMED[name]()
    b = A @ np.random.default_rng(2718281).normal(size=(A.shape[0], 6))
    for tolerance in (1e-4, 1e-10):
        found = solve(A, b, tolerance=tolerance, most_iterations=20_000)
        true = _relative(A, found.solution, b)
        assert (true <= tolerance * (1 + 1e-6)).all()
        assert np.allclose(found.residuals[-1], true, rtol=1e-3, atol=1e-14)
        assert found.residuals.shape == (found.iterations + 1, 6)
        assert np.allclose(found.residuals[0], 1)


@pytest.mark.parametrize("solve", BOTH)
@given(A=definite_matrices())
def test_drawn_matrices(solve, A):
    b = A @ np.random.default_rng(16180).normal(size=(A.shape[0], 2))
    x = solve(A, b, tolerance=1e-8, most_iterations=20_000).solution
    assert (_relative(A, x, b) <= 1e-8 * (1 + 1e-6)).all()


@pytest.mark.parametrize("solve", BOTH)
def test_the_history_is_that_of_the_iterates(solve):
    """Stopped after k iterations, it is the true residual of the k-th iterate."""
    A, b = grid(6, 9), np.random.default_rng(5551212).normal(size=54)
    whole = solve(A, b).residuals
    for k in range(1, len(whole) - 1, 5):
        part = solve(A, b, tolerance=whole[k] * 1.0001)
        assert part.iterations <= k
        k = part.iterations
        assert whole[k] == pytest.approx(_relative(A, part.solution, b), rel=1e-6)
    with pytest.raises(ConvergenceError, match="after 3 iterations") as caught:
        solve(A, b, most_iterations=3)
    assert np.allclose(caught.value.residuals, whole[:4])


@pytest.mark.parametrize("solve", BOTH)
@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 9])
def test_columns_share_products_and_nothing_else(solve, count):
    A, b = grid(8, 7), np.random.default_rng(86028121).normal(size=(56, count))
    b[:, 0] = A @ np.ones(56)
    together = solve(A, b)
    for j in range(count):
        one = solve(A, b[:, j])
        assert one.solution.shape == (56,)
        assert one.residuals.shape == (one.iterations + 1,)
        assert one.solution.tobytes() == np.ascontiguousarray(together.solution[:, j]).tobytes()
        history = together.residuals[:, j]
        assert np.array_equal(history[: one.iterations + 1], one.residuals)
        assert (history[one.iterations :] == history[-1]).all()


@pytest.mark.parametrize("solve", BOTH)
def test_it_is_done_in_as_many_steps_as_there_are_eigenvalues(solve):
    rng = np.random.default_rng(9876543)
    Q = np.linalg.qr(rng.normal(size=(40, 40)))[0]
    values = np.repeat([1.0, 2.0, 5.0, 11.0], 10)
    A = csr_array((Q * values) @ Q.T)
    A = csr_array((A + A.T) / 2)
    found = solve(A, rng.normal(size=40), preconditioner="none", tolerance=1e-12)
    assert found.iterations == 4


@pytest.mark.parametrize("solve", BOTH)
def test_each_minimises_what_it_says(solve):
    """CG the energy of the error over a Krylov space, minres the residual."""
    A = grid(5, 6) if solve is conjugate_gradients else _mixed(30)
    dense, b = A.toarray(), np.random.default_rng(11235).normal(size=30)
    krylov = np.column_stack([np.linalg.matrix_power(dense, k) @ b for k in range(6)])
    Q = np.linalg.qr(krylov)[0]
    if solve is conjugate_gradients:
        best = Q @ np.linalg.solve(Q.T @ dense @ Q, Q.T @ b)
    else:
        best = Q @ np.linalg.lstsq(dense @ Q, b)[0]
    whole = solve(A, b, preconditioner="none")
    assert whole.residuals[6] == pytest.approx(_relative(A, best, b), rel=1e-9)


@pytest.mark.parametrize("solve", BOTH)
@pytest.mark.parametrize("unit", [1e-150, 1e-9, 1e9, 1e150])
def test_units_change_nothing(solve, unit):
    A, b = grid(7, 5), np.random.default_rng(123581321).normal(size=35)
    found = solve(A, b)
    for scaled in (solve(csr_array(A * unit), b * unit), solve(A, b)):
        assert scaled.iterations == found.iterations
        assert np.allclose(scaled.solution, found.solution, rtol=1e-12)
    assert np.allclose(solve(A, b * unit).solution / unit, found.solution, rtol=1e-12)


@pytest.mark.parametrize("solve", BOTH)
def test_shapes_and_small_systems(solve):
    A = grid(3, 4)
    assert solve(A, np.zeros((12, 0))).solution.shape == (12, 0)
    assert solve(A, np.zeros((12, 0))).iterations == 0
    nothing = solve(A, np.zeros(12))
    assert nothing.solution.tolist() == [0] * 12
    assert nothing.iterations == 0
    assert nothing.residuals.tolist() == [0]
    assert solve(csr_array([[4.0]]), [2.0]).solution.tolist() == [0.5]
    for make in (csr_array, csc_array, coo_array):
        assert np.allclose(solve(make(np.diag([2, 4])), [2, 4]).solution, [1, 1])
    mixed = np.zeros((12, 2))
    mixed[:, 1] = A @ np.ones(12)
    found = solve(A, mixed)
    assert (found.solution[:, 0] == 0).all()
    assert np.allclose(found.solution[:, 1], 1)


@pytest.mark.parametrize("solve", BOTH)
def test_a_start_is_used_and_nothing_is_changed(solve):
    A, x = grid(9, 9), np.random.default_rng(4711).normal(size=(81, 2))
    b = A @ x
    for array in (x, b, A.data, A.indices, A.indptr):
        array.flags.writeable = False
    exact = solve(A, b, start=x)
    assert exact.iterations == 0
    assert np.allclose(exact.solution, x, rtol=1e-14)
    near = solve(A, b, start=x + 1e-6)
    assert near.iterations < solve(A, b).iterations
    assert (_relative(A, near.solution, b) <= 1e-10).all()
    with pytest.raises(DimensionError, match="start"):
        solve(A, b, start=x[:, 0])
    with pytest.raises(NonFiniteError, match="start"):
        solve(A, b, start=x + np.inf)


@pytest.mark.parametrize("solve", BOTH)
def test_what_rounding_forbids_is_told(solve):
    A = NAMED["nearly singular"]()
    b = np.random.default_rng(99).normal(size=A.shape[0])
    with pytest.raises(ConvergenceError, match="rounding keeps it there") as caught:
        solve(A, b, tolerance=1e-15, most_iterations=20_000)
    assert caught.value.residuals[-1] > 1e-15
    assert len(caught.value.residuals) > 10


@pytest.mark.parametrize("solve", BOTH)
def test_preconditioners(solve):
    A, b = NAMED["units"](), np.random.default_rng(2).normal(size=(200, 2))
    plain = solve(arrow(60), np.arange(60.0), preconditioner="none")
    assert plain.preconditioner == "none"
    assert solve(arrow(60), np.arange(60.0)).iterations <= plain.iterations
    factor = factorize(A)
    exact = solve(A, A @ b, preconditioner=factor.solve)
    assert exact.iterations <= 3
    assert exact.preconditioner == "Factor.solve"
    with pytest.raises(UnknownNameError, match="jacobi"):
        solve(A, b, preconditioner="jacobbi")
    with pytest.raises(NotPositiveDefiniteError, match="preconditioner"):
        solve(A, b, preconditioner=lambda r: -r)
    with pytest.raises(DimensionError, match="preconditioner"):
        solve(A, b, preconditioner=lambda r: r[1:])
    with pytest.raises(NonFiniteError, match="preconditioner"):
        solve(A, b, preconditioner=lambda r: r * np.nan)
    with pytest.raises(ValueError, match="read-only"):
        solve(A, b, preconditioner=lambda r: np.multiply(r, 2, out=r))


@pytest.mark.parametrize("solve", BOTH)
def test_what_is_refused(solve):
    A = path(5)
    with pytest.raises(BeltramiError, match="symmetric matrix"):
        solve(csr_array(A + diags_array([np.ones(4)], offsets=[1])), np.ones(5))
    for wrong in (np.eye(5), csr_array((5, 4)), csr_array((0, 0)), csr_array(np.eye(5) * 1j)):
        with pytest.raises(DimensionError):
            solve(wrong, np.ones(5))
    for wrong in (np.ones(4), np.ones((5, 1, 1)), 1.0):
        with pytest.raises(DimensionError, match="right-hand side"):
            solve(A, wrong)
    with pytest.raises(NonFiniteError, match="right-hand side"):
        solve(A, [1, 2, np.nan, 4, 5])
    with pytest.raises(NonFiniteError, match="matrix"):
        solve(csr_array(np.diag([1, np.inf])), np.ones(2))
    for wrong in (0, 1, -1e-3, np.nan):
        with pytest.raises(BeltramiError, match="tolerance"):
            solve(A, np.ones(5), tolerance=wrong)
    for wrong in (0, -3, 2.5):
        with pytest.raises(BeltramiError, match="most_iterations"):
            solve(A, np.ones(5), most_iterations=wrong)


@pytest.mark.parametrize("solve", BOTH)
def test_progress_counts_columns(solve):
    told = []
    solve(grid(4, 4), np.eye(16)[:, :7], progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (7, 7)
    assert [done for done, _ in told] == sorted({done for done, _ in told})


@pytest.mark.parametrize("solve", BOTH)
def test_the_result_is_frozen_and_says_what_it_is(solve):
    found = solve(grid(4, 4), np.ones(16))
    assert f"{found.method}, preconditioner jacobi, {found.iterations} iterations" in repr(found)
    with pytest.raises(dataclasses.FrozenInstanceError):
        found.iterations = 3
    again = solve(grid(4, 4), np.ones(16))
    assert again.solution.tobytes() == found.solution.tobytes()


def test_indefinite_matrices_are_for_minres():
    A, b = _mixed(), np.random.default_rng(3).normal(size=(50, 3))
    assert (_relative(A, minres(A, b).solution, b) <= 1e-10).all()
    with pytest.raises(NotPositiveDefiniteError, match="minres") as caught:
        conjugate_gradients(A, b)
    assert caught.value.rows.tolist() == np.flatnonzero(A.diagonal() < 0).tolist()


def test_indefinite_matrices_that_do_not_look_it():
    A = csr_array(path(40) - 0.2 * diags_array(np.ones(40)))
    b = np.random.default_rng(4).normal(size=40)
    with pytest.raises(NotPositiveDefiniteError, match="<Ap, p> = -") as caught:
        conjugate_gradients(A, b)
    assert not len(caught.value.rows)
    assert _relative(A, minres(A, b).solution, b) <= 1e-10
