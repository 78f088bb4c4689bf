"""Every backend, on every matrix: the residual is at rounding level, and the bits are the same."""

import numpy as np
import pytest
from hypothesis import given

from backends import PACKAGES, backend
from beltrami.errors import BeltramiError
from beltrami.solvers.factorize import factorize
from definite_matrices import NAMED, definite_matrices

BACKENDS = [
    ("ldl", {}),
    ("superlu", {}),
    ("cholesky", {"ordering": "graph"}),
    ("cholesky", {"coordinates": True}),
    ("cholesky", {"coordinates": True, "ordering": "positions"}),
    *[backend(name, {}) for name in PACKAGES],
]
NOT_TOLD = {
    "cholespy": ("logdet", "fill", "memory"),
    "cholmod": ("memory",),
    "pardiso": ("logdet",),
}
COUNTS = (1, 2, 3, 5, 8, 20, 130)  # one, a few and many have loops of their own


def _factor(A, backend, options):
    options = dict(options)
    if "coordinates" in options:
        options["coordinates"] = np.random.default_rng(55).normal(size=(A.shape[0], 2))
    return factorize(A, backend=backend, **options)


def _normwise(A, x, b):
    norm = abs(A).sum(axis=1).max()
    scale = norm * abs(x).max(axis=0) + abs(b).max(axis=0)
    return (abs(A @ x - b).max(axis=0) / scale).max()


@pytest.mark.parametrize(("backend", "options"), BACKENDS)
@pytest.mark.parametrize("name", NAMED)
def test_residuals_are_at_rounding_level(name, backend, options):
    A = NAMED[name]()
    factor = _factor(A, backend, options)
    assert factor.backend == backend
    rng = np.random.default_rng(271828)
    for count in COUNTS:
        b = A @ rng.normal(size=(A.shape[0], count))
        x = factor.solve(b)
        assert x.shape == b.shape
        assert _normwise(A, x, b) < 2e-15
        assert factor.backward_error(x, b).shape == (count,)
    b = A @ rng.normal(size=A.shape[0])
    assert factor.solve(b).shape == b.shape
    assert np.allclose(factor.solve(b[:, None])[:, 0], factor.solve(b), rtol=1e-14, atol=0)


@pytest.mark.parametrize(("backend", "options"), BACKENDS)
@given(A=definite_matrices())
def test_drawn_matrices(backend, options, A):
    x = np.random.default_rng(161803).normal(size=(A.shape[0], 4))
    b = A @ x
    assert _normwise(A, _factor(A, backend, options).solve(b), b) < 2e-15


@pytest.mark.parametrize(("backend", "options"), BACKENDS)
@pytest.mark.parametrize("name", ["grid", "pieces", "units", "dense"])
def test_log_determinant_fill_and_memory(name, backend, options):
    A = NAMED[name]()
    factor = _factor(A, backend, options)
    sign, expected = np.linalg.slogdet(A.toarray())
    assert sign == 1
    told = {
        "logdet": lambda value: value == pytest.approx(expected, rel=1e-12),
        "fill": lambda value: value >= (A.nnz + A.shape[0]) / 2,
        "memory": lambda value: value >= 8 * factor.fill,
    }
    for name, is_right in told.items():
        if name in NOT_TOLD.get(backend, ()):
            with pytest.raises(BeltramiError, match=f"the factors of {backend} do not tell the"):
                getattr(factor, name)
        else:
            assert is_right(getattr(factor, name))


@pytest.mark.parametrize(("backend", "options"), BACKENDS)
def test_the_same_bits_each_time(backend, options):
    A = NAMED["scattered"]()
    b = np.random.default_rng(3).normal(size=(A.shape[0], 11))
    results = [_factor(A, backend, options).solve(b) for _ in range(3)]
    assert results[0].tobytes() == results[1].tobytes() == results[2].tobytes()
    factor = _factor(A, backend, options)
    assert factor.solve(b).tobytes() == factor.solve(b).tobytes()
