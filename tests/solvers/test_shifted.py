import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.sparse.linalg import minres

import beltrami as bt
from beltrami.errors import ConvergenceError, SingularMatrixError, UnknownNameError
from beltrami.solvers.shifted import SHIFTED_SOLVERS, shifted_solver
from meshes_of_the_errata import MESHES


def _system(name="obt", mass="voronoi"):
    pair = bt.laplacian(MESHES[name](), mass=mass)
    return pair, eigh(pair.stiffness.toarray(), pair.mass.toarray(), eigvals_only=True)


def _residual(pair, shift, x, b):
    """In the norm that bounds errors of eigenvalues."""
    r = b - (pair.stiffness @ x - shift * (pair.mass @ x))
    return np.linalg.norm(r / np.sqrt(pair.masses)) / np.linalg.norm(b / np.sqrt(pair.masses))


@pytest.mark.parametrize("solver", SHIFTED_SOLVERS)
@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
def test_residuals_are_as_small_as_asked(solver, mass):
    pair, values = _system(mass=mass)
    b = pair.mass @ np.random.default_rng(2).normal(size=pair.n)
    for shift in (-values[3], 0.7 * values[8] + 0.3 * values[9], values[8] * (1 + 1e-5)):
        prepared = shifted_solver(pair.stiffness, pair.mass, shift, solver)
        for tolerance in (1e-2, 1e-5, 1e-8):
            x, steps = prepared.solve(b, tolerance, None)
            found = _residual(pair, shift, x, b)
            assert found <= tolerance
            assert (steps > 0) == (solver == "minres")
            if solver == "minres":
                assert found > 1e-6 * tolerance  # and no better: it stops in time


def test_the_rule_of_scipy_is_too_weak_near_an_eigenvalue():
    """It compares the residual with |A||x|, and |x| is huge there."""
    pair, values = _system()
    shift = values[8] * (1 + 1e-7)
    b = pair.mass @ np.random.default_rng(2).normal(size=pair.n)
    A = pair.stiffness - shift * pair.mass
    theirs, information = minres(A, b, rtol=1e-6)
    assert information == 0
    assert _residual(pair, shift, theirs, b) > 1e-4
    ours, _ = shifted_solver(pair.stiffness, pair.mass, shift, "minres").solve(b, 1e-6, None)
    assert _residual(pair, shift, ours, b) <= 1e-6


def test_rounding_is_no_failure():
    """What |A||x| eps allows is asked for where the guess tells that less cannot be had."""
    pair, values = _system()
    b = pair.mass @ np.random.default_rng(2).normal(size=pair.n)
    solver = shifted_solver(pair.stiffness, pair.mass, values[8] * (1 + 1e-7), "minres")
    x, _ = solver.solve(b, 1e-6, None)
    with pytest.raises(ConvergenceError, match="rounding"):
        solver.solve(b, 1e-15, None)
    better, _ = solver.solve(b, 1e-15, x)
    scale = abs(solver.A) @ abs(better * solver.root)
    found = np.linalg.norm(b / solver.root - solver.A @ (better * solver.root))
    assert found <= 4e-14 * np.linalg.norm(scale)


def test_iterations_that_run_out():
    pair, values = _system()
    b = pair.mass @ np.ones(pair.n)
    few = shifted_solver(
        pair.stiffness, pair.mass, 1.1 * values[8], "minres", max_inner_iterations=7
    )
    with pytest.raises(ConvergenceError, match="after 7 iterations") as caught:
        few.solve(b + np.arange(pair.n) * pair.masses, 1e-9, None)
    assert len(caught.value.residuals) > 7


def test_names():
    pair, values = _system()
    assert shifted_solver(pair.stiffness, pair.mass, -1.0, "lu").name == "lu"
    assert shifted_solver(pair.stiffness, pair.mass, values[3] * 1.1, "ldl").name == "ldl"
    large = bt.laplacian(bt.shapes.icosphere(5))
    x = bt.shapes.icosphere(5).vertices
    assert shifted_solver(large.stiffness, large.mass, -1.0, coordinates=x).name == "cholesky"
    assert shifted_solver(large.stiffness, large.mass, 3.0, coordinates=x).name == "ldl"
    with pytest.raises(UnknownNameError, match="minres"):
        shifted_solver(pair.stiffness, pair.mass, -1.0, "cg")


def test_singular_matrices_are_named_by_their_shift():
    pair, _ = _system()
    with pytest.raises(SingularMatrixError, match=r"L - 0 B has no inverse") as caught:
        shifted_solver(pair.stiffness, pair.mass, 0.0, "ldl")
    assert len(caught.value.rows) == 1
    assert 'solver="lu"' in str(caught.value)


@pytest.mark.parametrize("name", ["open", "closed"])
def test_rows_are_scaled_by_their_largest_entries(name):
    """By nothing, or by the diagonal, which a shift may cancel, takes longer."""
    pair, values = _system(name)
    shift = 0.7 * values[100] + 0.3 * values[101]
    solver = shifted_solver(pair.stiffness, pair.mass, shift, "minres")
    b = pair.mass @ np.random.default_rng(2).normal(size=pair.n)
    _, steps = solver.solve(b, 1e-6, None)
    for other in ("none", "jacobi"):
        longer = bt.minres(
            solver.A, b / solver.root, tolerance=1e-6, kernel=None, preconditioner=other
        )
        assert longer.iterations > 1.3 * steps
