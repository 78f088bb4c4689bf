import numpy as np
import pytest

from beltrami.solvers.blas import (
    N,
    T,
    U,
    blas,
    cholesky_in_place,
    divide_right,
    multiply,
    subtract_square,
)

KINDS = (("f8", 1e-14), ("f4", 1e-5))


def _lower(rng, n, kind):
    return np.asfortranarray(np.tril(rng.normal(size=(n, n))) + 4 * np.eye(n), kind)


@pytest.mark.parametrize(("kind", "rounding"), KINDS)
def test_products(kind, rounding):
    rng = np.random.default_rng(16180)
    A, B = (np.asfortranarray(rng.normal(size=shape), kind) for shape in ((5, 3), (4, 3)))
    for alpha, beta, expected in ((0, 2, A @ B.T), (1, 0, 1 - A @ B.T)):
        C = np.ones((5, 4), kind, order="F")
        multiply(
            blas(kind), N, T, 5, 4, 3, alpha, beta,
            A.ctypes.data, 5, B.ctypes.data, 4, C.ctypes.data, 5,
        )  # fmt: skip
        assert np.allclose(C, expected, atol=10 * rounding)
    C = np.asfortranarray(rng.normal(size=(5, 5)), kind)
    before = C.copy()
    subtract_square(blas(kind), 5, 3, A.ctypes.data, 5, C.ctypes.data, 5)
    assert np.allclose(np.tril(C), np.tril(before - A @ A.T), atol=10 * rounding)
    assert (np.triu(C, 1) == np.triu(before, 1)).all()


@pytest.mark.parametrize(("kind", "rounding"), KINDS)
def test_triangles(kind, rounding):
    rng = np.random.default_rng(27182)
    L = _lower(rng, 6, kind)
    B = np.asfortranarray(rng.normal(size=(4, 6)), kind)
    for turn, matrix in ((T, L.T), (N, L)):
        X = B.copy(order="F")
        divide_right(blas(kind), turn, N, 4, 6, L.ctypes.data, 6, X.ctypes.data, 4)
        assert np.allclose(X @ matrix, B, atol=50 * rounding)
    X = B.copy(order="F")
    divide_right(blas(kind), N, U, 4, 6, L.ctypes.data, 6, X.ctypes.data, 4)
    unit = np.tril(L, -1) + np.eye(6)
    assert np.allclose(X @ unit, B, atol=1e3 * rounding)


@pytest.mark.parametrize(("kind", "rounding"), KINDS)
def test_cholesky(kind, rounding):
    rng = np.random.default_rng(14142)
    L = _lower(rng, 6, kind)
    A = np.asfortranarray(L @ L.T)
    assert cholesky_in_place(blas(kind), 6, A.ctypes.data, 6) == 0
    assert np.allclose(np.tril(A), L, atol=100 * rounding)
    A = np.asfortranarray(np.diag([1, 2, -3, 4]), kind)
    assert cholesky_in_place(blas(kind), 4, A.ctypes.data, 4) == 3
    assert A[2, 2] == -3
