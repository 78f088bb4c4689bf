"""Systems that are singular and compatible, and those that are not."""

import numpy as np
import pytest
from scipy.sparse import block_diag, csr_array, diags_array

from beltrami.errors import (
    BeltramiError,
    ConvergenceError,
    DimensionError,
    SingularMatrixError,
    UnknownNameError,
)
from beltrami.operators.laplacian import laplacian
from beltrami.solvers.conjugate_gradients import conjugate_gradients
from beltrami.solvers.factorize import factorize
from beltrami.solvers.minres import minres
from definite_matrices import grid, path
from meshes_of_the_errata import MESHES

BOTH = [conjugate_gradients, minres]


@pytest.mark.parametrize("solve", BOTH)
@pytest.mark.parametrize("name", ["closed", "obt", "open"])
def test_a_stiffness_is_solved_with_mean_zero(solve, name):
    L = laplacian(MESHES[name](), mass="degree").stiffness
    f = np.random.default_rng(31337).normal(size=(L.shape[0], 3))
    f -= f.mean(axis=0)
    found = solve(L, L @ f, tolerance=1e-12)
    assert np.allclose(found.solution, f, atol=1e-8)
    assert np.abs(found.solution.mean(axis=0)).max() < 1e-14
    away = solve(L, L @ f, tolerance=1e-12, start=f + 5.0)
    assert np.abs(away.solution.mean(axis=0)).max() < 1e-14
    b = L @ f
    b[:, 1] = _with_mean(b[:, 1], 0.5)
    for unit in (1.0, 1e-200, 1e150):
        with pytest.raises(SingularMatrixError, match=r"no solution: 5.0e-01 of column 1"):
            solve(csr_array(L * unit), b * unit)
        small = solve(csr_array(L * unit), (L @ f) * unit)
        assert np.allclose(small.solution, f, atol=1e-6)


def _with_mean(b, share):
    """Return a vector of norm 1 of which the constant is a share."""
    n = len(b)
    rest = b - b.mean()
    return share / np.sqrt(n) + np.sqrt(1 - share**2) * rest / np.linalg.norm(rest)


@pytest.mark.parametrize("solve", BOTH)
def test_each_component_has_its_constant(solve):
    parts = [path(k) - diags_array(_ends(k)) for k in (5, 9, 2)]
    A = csr_array(block_diag([*parts, csr_array((1, 1))]))
    f = np.random.default_rng(17).normal(size=17)
    labels = np.repeat([0, 1, 2, 3], [5, 9, 2, 1])
    f -= (np.bincount(labels, f) / np.bincount(labels))[labels]
    assert np.allclose(solve(A, A @ f).solution, f, atol=1e-9)
    b = A @ f
    b[14] += 1.0
    with pytest.raises(SingularMatrixError) as caught:
        solve(A, b)
    assert labels[caught.value.rows].tolist() == [2]


def _ends(n):
    ends = np.zeros(n)
    ends[0] = ends[-1] = 1
    return ends


@pytest.mark.parametrize("solve", BOTH)
def test_a_kernel_that_is_told(solve):
    rng = np.random.default_rng(65537)
    X = rng.normal(size=(20, 18))
    A, K = csr_array(X @ X.T), np.linalg.svd(X)[0][:, 18:]
    b = A @ rng.normal(size=20)
    found = solve(A, b, kernel=K @ rng.normal(size=(2, 2)), tolerance=1e-9)
    assert np.allclose(A @ found.solution, b, atol=1e-8 * abs(b).max())
    assert np.abs(K.T @ found.solution).max() < 1e-12
    with pytest.raises(BeltramiError, match="vector 1 of the kernel is not mapped to zero"):
        solve(A, b, kernel=np.column_stack([K[:, 0], np.ones(20)]))
    with pytest.raises(BeltramiError, match="depend on each other"):
        solve(A, b, kernel=K[:, [0, 0]])
    with pytest.raises(DimensionError, match="kernel"):
        solve(A, b, kernel=np.ones(19))
    with pytest.raises(UnknownNameError, match="constants"):
        solve(A, b, kernel="constant")
    none = solve(grid(2, 3), np.ones(6), kernel=np.zeros((6, 0)))
    assert np.allclose(grid(2, 3) @ none.solution, 1)


@pytest.mark.parametrize("solve", BOTH)
def test_an_untold_kernel_is_no_silent_answer(solve):
    L = laplacian(MESHES["closed"](), mass="degree").stiffness
    b = _with_mean(np.random.default_rng(8).normal(size=L.shape[0]), 0.3)
    with pytest.raises((ConvergenceError, SingularMatrixError)):
        solve(L, b, kernel=None, most_iterations=2000)


@pytest.mark.parametrize("solve", BOTH)
def test_a_preconditioner_may_make_much_of_the_kernel(solve):
    """The factors of L + εB multiply the constants by 1/ε."""
    pair = laplacian(MESHES["obt"](), mass="degree")
    f = np.random.default_rng(6).normal(size=pair.n)
    factor = factorize(csr_array(pair.stiffness + 1e-9 * pair.mass))
    found = solve(pair.stiffness, pair.stiffness @ f, preconditioner=factor.solve)
    assert found.iterations <= 4
    assert np.allclose(found.solution, f - f.mean(), atol=1e-7)


def test_a_direction_that_is_mapped_to_zero():
    A = csr_array(np.ones((2, 2)))
    with pytest.raises(SingularMatrixError, match="maps to zero"):
        conjugate_gradients(A, [1.0, -1.0])
    with pytest.raises(SingularMatrixError, match="maps to zero"):
        minres(A, [1.0, -1.0])
    for solve in BOTH:  # a solution exists, and is found
        assert np.allclose(solve(A, [1.0, 1.0]).solution, [0.5, 0.5])
