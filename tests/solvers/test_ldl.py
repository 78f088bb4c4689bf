import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import eigh
from scipy.sparse import block_array, csr_array, diags_array, eye_array

from beltrami.errors import BeltramiError, SingularMatrixError
from beltrami.operators.laplacian import laplacian
from beltrami.solvers import factorize as rooms
from beltrami.solvers.factorize import factorize
from definite_matrices import NAMED, dense, grid, pieces
from meshes_of_the_errata import IRREGULAR, MESHES


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("mass", ["degree", "barycentric", "consistent"])
def test_the_inertia_counts_the_eigenvalues_below_a_shift(name, mass):
    pair = laplacian(MESHES[name](), mass=mass)
    values = eigh(pair.stiffness.toarray(), pair.mass.toarray(), eigvals_only=True)
    for k in (1, 7, 50, len(values) // 2, len(values) - 1):
        shift = (values[k - 1] + values[k]) / 2
        if values[k] - values[k - 1] < 1e-6 * values[k]:
            continue
        A = csr_array(pair.stiffness - shift * pair.mass)
        factor = factorize(A, pair.domain.vertices, backend="ldl")
        assert factor.inertia == (len(values) - k, k)
        for count in (1, 3, 12):  # each has a substitution of its own
            b = np.random.default_rng(k).normal(size=(pair.n, count))
            x = factor._solver.solve(b)  # before any refinement
            norm = abs(A).sum(axis=1).max() * abs(x).max() + abs(b).max()
            assert abs(A @ x - b).max() < 1e-11 * norm
            x = factor.solve(b)
            assert abs(A @ x - b).max() < 1e-13 * norm
        assert factor.logdet == pytest.approx(np.linalg.slogdet(A.toarray())[1], rel=1e-9)


@given(st.integers(0, 2**63 - 1), st.integers(1, 80))
def test_drawn_indefinite_matrices_are_solved_or_refused(seed, n):
    rng = np.random.default_rng(seed)
    A = csr_array(dense(rng, n) - rng.uniform(0, 3 * n) * eye_array(n))
    values = np.linalg.eigvalsh(A.toarray())
    try:
        factor = factorize(A, backend="ldl")
    except SingularMatrixError:
        assert abs(values).min() < 1e-3 * abs(values).max()
        return
    assert factor.inertia == (int((values > 0).sum()), int((values < 0).sum()))
    b = rng.normal(size=n)
    x = factor.solve(b)
    assert abs(A @ x - b).max() < 1e-12 * (abs(A).sum(axis=1).max() * abs(x).max() + 1)


def test_definite_matrices_have_no_negative_eigenvalue():
    A = pieces(np.random.default_rng(9), 0)
    n = A.shape[0]
    for backend in ("cholesky", "ldl"):
        assert factorize(A, backend=backend).inertia == (n, 0)
    assert factorize(-A, backend="ldl").inertia == (0, n)
    with pytest.raises(BeltramiError, match="inertia"):
        _ = factorize(A, backend="superlu").inertia


def test_matrices_that_need_exchanges_are_refused_and_auto_exchanges(monkeypatch):
    monkeypatch.setattr(rooms, "SMALL", 1)
    n = 30
    swap = block_array([[None, eye_array(n)], [eye_array(n), 1e-3 * eye_array(n)]])
    tiny = csr_array(swap + 1e-12 * eye_array(2 * n))
    for A in (csr_array(swap), tiny):
        b = np.arange(2.0 * n)
        assert abs(A @ factorize(A).solve(b) - b).max() < 1e-10
    with pytest.raises(SingularMatrixError) as caught:
        factorize(csr_array([[0.0, 1.0], [1.0, 0.0]]), backend="ldl")
    assert caught.value.rows[0] in (0, 1)
    with pytest.raises(SingularMatrixError):
        factorize(csr_array(diags_array([1.0, 0.0, -1.0])), backend="ldl")
    with pytest.raises(SingularMatrixError):
        factorize(csr_array(np.ones((4, 4))), backend="ldl")


def test_unsymmetric_matrices_are_refused():
    A = grid(5, 5).tolil()
    A[2, 20] = 1e-30  # in one triangle only: the pattern counts
    for value in (1e-30, 0.5):
        A[2, 20] = value
        with pytest.raises(BeltramiError, match="needs a symmetric matrix"):
            factorize(csr_array(A), backend="ldl")


@pytest.mark.parametrize("name", ["dense", "grid", "scattered", "pieces"])
def test_the_signs_and_the_panels_make_the_matrix(name):
    A = csr_array(NAMED[name]())
    A = csr_array(A - np.median(A.diagonal()) * 1.01 * eye_array(A.shape[0]))
    factor = factorize(A, backend="ldl")._solver
    assert set(np.unique(factor.signs)) == {-1.0, 1.0}
    n = A.shape[0]
    L = np.zeros((n, n))
    shape = factor.elimination
    for i in range(len(shape.starts) - 1):
        first, last = shape.starts[i], shape.starts[i + 1]
        rows = np.r_[first:last, shape.rows[shape.row_starts[i] : shape.row_starts[i + 1]]]
        panel = factor.values[shape.panels[i] : shape.panels[i + 1]]
        L[rows, first:last] = panel.reshape(last - first, len(rows)).T
    L = np.tril(L)
    scaled = ((factor.scale * A.toarray()).T * factor.scale)[shape.order][:, shape.order]
    assert abs(L * factor.signs @ L.T - scaled).max() < 1e-10 * abs(L).max() ** 2
