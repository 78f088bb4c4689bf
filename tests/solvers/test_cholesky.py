import threading

import numpy as np
import pytest
from scipy.sparse import csr_array, diags_array

from beltrami.errors import (
    BeltramiError,
    ConvergenceError,
    NotPositiveDefiniteError,
    SingularMatrixError,
)
from beltrami.operators.laplacian import laplacian
from beltrami.solvers.cholesky import factorize_cholesky
from beltrami.solvers.factorize import SMALL, factorize
from beltrami.solvers.ordering import order
from definite_matrices import NAMED, as_columns, grid, pieces
from meshes_of_the_errata import MESHES


def _lower(factor):
    """The factor as a dense matrix, in the order of elimination."""
    shape = factor.elimination
    L = np.zeros((len(shape.order),) * 2)
    for i in range(len(shape.starts) - 1):
        first, last = shape.starts[i], shape.starts[i + 1]
        rows = np.r_[first:last, shape.rows[shape.row_starts[i] : shape.row_starts[i + 1]]]
        panel = factor.values[shape.panels[i] : shape.panels[i + 1]]
        L[rows, first:last] = panel.reshape(last - first, len(rows)).T
    return np.tril(L)


@pytest.mark.parametrize("name", NAMED)
def test_the_factor_is_that_of_the_scaled_permuted_matrix(name):
    A = as_columns(NAMED[name]())
    factor = factorize_cholesky(A, order(A, None, "graph"))
    assert (np.log2(factor.scale) == np.round(np.log2(factor.scale))).all()
    scaled = (factor.scale * A.toarray()).T * factor.scale
    assert (np.diag(scaled) <= 2).all()
    assert (np.diag(scaled) >= 0.5).all()
    way = factor.elimination.order
    assert np.allclose(_lower(factor), np.linalg.cholesky(scaled[way][:, way]), atol=1e-7)
    assert np.allclose(factor.pivots, np.diag(_lower(factor)) ** 2, rtol=1e-14)


@pytest.mark.parametrize("row", [0, 17, 89])
@pytest.mark.parametrize("wrong", [-1.0, 0.0, 1e-3])
def test_the_row_without_a_pivot_is_named(row, wrong):
    """The rest is definite; the pivot of this row is ``wrong`` less what the others take."""
    A = grid(9, 10).tolil()
    A[row, row] = wrong
    with pytest.raises(NotPositiveDefiniteError) as caught:
        factorize(csr_array(A), backend="cholesky")
    assert row in caught.value.rows


def test_an_indefinite_matrix_that_its_entries_do_not_tell():
    A = csr_array(np.ones((3, 3)) * -0.9 + 1.9 * np.eye(3))  # eigenvalues 1.9, 1.9, -0.8
    with pytest.raises(NotPositiveDefiniteError) as caught:
        factorize(A, backend="cholesky")
    assert len(caught.value.rows) == 1
    assert factorize(A).backend == "superlu"
    zero = csr_array([[1.0, 1, 0], [1, 1, 1], [0, 1, 1]])  # a pivot of 0, determinant -1
    with pytest.raises(NotPositiveDefiniteError):
        factorize(zero, backend="cholesky")


def test_unsymmetric_matrices_are_refused_with_the_pair():
    A = grid(6, 6).tolil()
    A[3, 4] = -0.5
    with pytest.raises(NotPositiveDefiniteError) as caught:
        factorize(csr_array(A), backend="cholesky")
    assert sorted(caught.value.rows.tolist()) == [3, 4]
    A[3, 4] = 0
    with pytest.raises(NotPositiveDefiniteError) as caught:
        factorize(csr_array(A), backend="cholesky")
    assert set(caught.value.rows.tolist()) & {3, 4}
    tiny = csr_array([[1e-16, 1e-30], [0.0, 1e-16]])  # small beside 1, but not beside its diagonal
    with pytest.raises(NotPositiveDefiniteError):
        factorize(tiny, backend="cholesky")


@pytest.mark.parametrize("name", ["closed", "bad", "obt", "tor"])
def test_a_stiffness_alone_is_singular(name):
    with pytest.raises(SingularMatrixError, match="nothing is left for the pivot of row") as caught:
        factorize(laplacian(MESHES[name]()).stiffness, backend="cholesky")
    assert 0 <= caught.value.rows[0] < MESHES[name]().n_vertices


def test_auto_takes_cholesky_where_it_is_faster_and_possible():
    size = int(np.ceil(np.sqrt(SMALL)))
    A = grid(size, size)
    assert factorize(A).backend == "cholesky"
    assert factorize(grid(size - 2, size - 2)).backend == "superlu"
    unsymmetric = csr_array(A + diags_array(np.full(size**2 - 1, 0.3), offsets=1))
    indefinite = csr_array(A - 3 * diags_array(np.ones(size**2)))
    b = np.ones(size**2)
    for matrix, backend in ((unsymmetric, "superlu"), (indefinite, "ldl")):
        factor = factorize(matrix)
        assert factor.backend == backend
        assert abs(matrix @ factor.solve(b) - b).max() < 1e-9


def test_explicit_zeros_and_entries_given_twice():
    A = as_columns(grid(7, 7))
    coo = A.tocoo()
    twice = csr_array(
        (
            np.r_[coo.data / 2, coo.data / 2, 0.0],
            (np.r_[coo.row, coo.row, 0], np.r_[coo.col, coo.col, 40]),
        ),
        shape=A.shape,
    )
    b = np.arange(49.0)
    expected = factorize(A, backend="cholesky").solve(b)
    assert np.allclose(factorize(twice, backend="cholesky").solve(b), expected, rtol=1e-13)


def test_float32_takes_half_and_is_refined():
    A, b = grid(40, 40), np.random.default_rng(271).normal(size=(1600, 9))
    whole, half = (factorize(A, backend="cholesky", dtype=kind) for kind in ("f8", "f4"))
    assert (whole.refined, half.refined) == (False, True)
    assert half.memory < 0.62 * whole.memory
    assert np.allclose(half.solve(b), whole.solve(b), rtol=1e-11, atol=1e-13)
    assert half._solver.solve(b).dtype == np.float64
    raw = abs(half._solver.solve(b) - whole.solve(b)).max() / abs(whole.solve(b)).max()
    assert 1e-9 < raw < 1e-4
    assert factorize(grid(3, 3), dtype="f4").backend == "cholesky"


def test_float32_refuses_what_it_cannot_refine():
    A = csr_array(laplacian(MESHES["closed"]()).stiffness + 1e-10 * diags_array(np.ones(300)))
    with pytest.raises((ConvergenceError, SingularMatrixError, NotPositiveDefiniteError)):
        factorize(A, dtype="f4").solve(np.ones(300))
    assert np.allclose(factorize(A).solve(np.ones(300)), 1e10, rtol=1e-5)
    with pytest.raises(BeltramiError, match="float64 only"):
        factorize(A, backend="superlu", dtype="f4")
    with pytest.raises(BeltramiError, match="float64 or float32"):
        factorize(A, dtype="i4")


def test_threads_share_a_factor():
    """The workspace belongs to each call."""
    A = pieces(np.random.default_rng(4), 0)
    factor = factorize(A, backend="cholesky")
    b = np.random.default_rng(5).normal(size=(8, A.shape[0], 20))
    found = [np.empty(0)] * 8

    def work(k):
        for _ in range(30):
            found[k] = factor.solve(b[k])

    threads = [threading.Thread(target=work, args=(k,)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for k in range(8):
        assert found[k].tobytes() == factor.solve(b[k]).tobytes()
