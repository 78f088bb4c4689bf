"""Definition 19 and theorem 13: the Fourier transform of a mesh, where averaging is diagonal."""

import numpy as np
import pytest

from beltrami.diffusion.smoothing import smooth
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.filtering import filter as filter_function
from beltrami.spectrum.fourier_basis import fourier_basis
from meshes_of_the_errata import IRREGULAR, MESHES

POSITIVE = ["combinatorial", "distance"]


def _pair_and_basis(name, weights):
    pair = laplacian(MESHES[name](), weights, "degree")
    return pair, fourier_basis(pair, pair.n)


@pytest.mark.chapter("D19", "P57")
@pytest.mark.parametrize("weights", [*POSITIVE, "cotangent"])
@pytest.mark.parametrize("name", IRREGULAR)
def test_it_is_u_transposed_root_d_f(name, weights):
    """E72: with f at the end, and back by D^-½ U; each printed or forgotten root is seen."""
    pair, basis = _pair_and_basis(name, weights)
    f = np.random.default_rng(4).normal(size=pair.n)
    root = np.sqrt(pair.degrees)
    U = root[:, None] * basis.eigenvectors
    assert np.abs(U.T @ U - np.eye(pair.n)).max() < 1e-12
    normalised = U.T @ pair.normalized.toarray() @ U
    assert np.abs(normalised - np.diag(basis.eigenvalues)).max() < 1e-12
    found = basis.forward(f)
    np.testing.assert_allclose(found, U.T @ (root * f), atol=1e-11)
    np.testing.assert_allclose((U @ found) / root, f, atol=1e-11)
    assert np.abs(U @ found - f).max() > 1  # without D^-½
    assert np.abs(U.T @ f - found).max() > 1  # without D^½
    energy = (found**2).sum()
    assert energy == pytest.approx((pair.degrees * f**2).sum())
    assert energy != pytest.approx((f**2).sum(), rel=0.5)


@pytest.mark.chapter("D19")
@pytest.mark.parametrize("name", IRREGULAR)
def test_a_constant_has_one_coefficient(name):
    pair, basis = _pair_and_basis(name, "combinatorial")
    found = basis.forward(np.ones(pair.n))
    assert abs(found[0]) == pytest.approx(np.sqrt(pair.degrees.sum()))
    assert np.abs(found[1:]).max() < 1e-11
    U = np.sqrt(pair.degrees)[:, None] * basis.eigenvectors
    assert np.abs((U.T @ np.ones(pair.n))[1:]).max() > 0.1  # plain inner products spread it


@pytest.mark.chapter("T13")
@pytest.mark.parametrize("weights", POSITIVE)
@pytest.mark.parametrize("name", IRREGULAR)
def test_averaging_is_diagonal(name, weights):
    pair, basis = _pair_and_basis(name, weights)
    transformed = basis.forward(pair.averaging @ basis.inverse(np.eye(pair.n)))
    assert np.abs(transformed - np.diag(1 - basis.eigenvalues)).max() < 1e-12
    U = np.sqrt(pair.degrees)[:, None] * basis.eigenvectors
    assert np.abs(U.T @ (pair.averaging @ U) - np.diag(1 - basis.eigenvalues)).max() > 1e-2
    assert np.abs(transformed - np.diag(basis.eigenvalues)).max() > 0.5  # not Λ itself


@pytest.mark.chapter("T13")
@pytest.mark.parametrize("k", [0, 1, 2, 7, 30])
def test_k_rounds_of_averaging_are_one_filter(k):
    """(1 - λ)^k is a polynomial of degree k: Chebyshev needs no more orders than rounds."""
    pair, basis = _pair_and_basis("cur", "distance")
    f = np.random.default_rng(4).normal(size=(pair.n, 2))
    rounds = smooth(pair, f, k)

    def h(x):
        return (1 - x) ** k

    np.testing.assert_allclose(basis.filter(f, h), rounds, atol=1e-11)
    np.testing.assert_allclose(filter_function(pair, f, h, order=max(k, 1)), rounds, atol=1e-11)
    np.testing.assert_allclose(filter_function(pair, f, h), rounds, atol=1e-6)
    if k > 1:
        assert np.abs(basis.filter(f, lambda x: (1 - x) ** (k + 1)) - rounds).max() > 1e-3
        assert np.abs(filter_function(pair, f, h, order=k - 1) - rounds).max() > 1e-9
