"""scikit-sparse 0.5 cannot be compiled everywhere: a dense double with its interface stands in."""

import sys
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.linalg import solve_triangular
from scipy.sparse import csc_array, csr_array

from beltrami.errors import NotPositiveDefiniteError
from beltrami.solvers.factorize import factorize
from definite_matrices import grid


class NotDefiniteError(Exception):
    pass


class CholeskyFactor:
    """Factorises P A P' = L L' in the reverse order, and counts what it stores."""

    def __init__(self, A, *, order):
        assert isinstance(A, csc_array)
        assert A.data.flags.writeable
        assert order == "default"
        self.perm = np.arange(A.shape[0])[::-1]

    def factorize(self, A):
        permuted = A.toarray()[np.ix_(self.perm, self.perm)]
        for k in range(len(permuted)):
            if np.linalg.eigvalsh(permuted[: k + 1, : k + 1]).min() <= 0:
                raise NotDefiniteError(f"Not positive definite. Failed at column {k}.")
        self.L = csc_array(np.linalg.cholesky(permuted))
        self.nnz = self.L.nnz
        return self

    def solve(self, b):
        L = self.L.toarray()
        y = solve_triangular(L, b[self.perm], lower=True)
        x = np.empty_like(y)
        x[self.perm] = solve_triangular(L.T, y)
        return x


@pytest.fixture
def version_05(monkeypatch):
    library = SimpleNamespace(
        CholeskyFactor=CholeskyFactor, CholmodNotPositiveDefiniteError=NotDefiniteError
    )
    monkeypatch.setitem(sys.modules, "sksparse", SimpleNamespace(cholmod=library))
    monkeypatch.setitem(sys.modules, "sksparse.cholmod", library)


@pytest.mark.usefixtures("version_05")
def test_the_newer_interface():
    A, b = grid(5, 6), np.random.default_rng(57721566).normal(size=(30, 2))
    factor = factorize(A, backend="cholmod")
    assert np.allclose(A @ factor.solve(b), b, rtol=1e-12)
    assert factor.solve(b[:, 0]).shape == (30,)
    assert factor.logdet == pytest.approx(np.linalg.slogdet(A.toarray())[1], rel=1e-12)
    assert factor.inertia == (30, 0)
    assert factor.fill == factor._solver.factor.L.nnz


@pytest.mark.usefixtures("version_05")
def test_the_newer_interface_names_the_row():
    A = csr_array([[1.0, 0.9, 0.9], [0.9, 1.0, -0.9], [0.9, -0.9, 1.0]])
    with pytest.raises(NotPositiveDefiniteError) as caught:
        factorize(A, backend="cholmod")
    assert caught.value.rows.tolist() == [0]  # the last in the reverse order
