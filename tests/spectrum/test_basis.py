"""FourierBasis: transform, energies, filters, approximations and their errors."""

import numpy as np
import pytest

import beltrami as bt
from beltrami.errors import BeltramiError, DimensionError, NonFiniteError
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import MASSES
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.kernels import Heat, LowPass
from meshes_of_the_errata import MESHES


@pytest.fixture(scope="module")
def pair():
    return laplacian(MESHES["bad"](), mass="consistent")


@pytest.fixture(scope="module")
def basis(pair):
    return fourier_basis(pair, 30)


def _rough(n, *columns):
    return np.random.default_rng(0).standard_normal((n, *columns))


@pytest.mark.chapter("U28", "D19")
def test_full_basis_loses_nothing():
    mesh = bt.shapes.icosphere(2)
    basis = bt.fourier_basis(bt.laplacian(mesh), mesh.n_vertices)
    f = _rough(mesh.n_vertices, 2)
    assert np.allclose(basis.inverse(basis.forward(f)), f, atol=1e-12)


@pytest.mark.chapter("U29")
@pytest.mark.parametrize("mass", MASSES)
def test_parseval(mass):
    """Energies in the norm of B, not in the plain one; with λ, the Dirichlet energy."""
    pair = laplacian(MESHES["bad"](), mass=mass)
    basis = fourier_basis(pair, pair.n)
    for f in (_rough(pair.n), _rough(pair.n, 3)):
        energy = basis.energy(f)
        assert energy.shape == f.shape
        assert energy.sum() == pytest.approx(pair.norm(f) ** 2, rel=1e-12)
        assert (basis.eigenvalues @ energy).sum() == pytest.approx(pair.dirichlet_energy(f))
        if mass != "unit":
            assert energy.sum() != pytest.approx((f**2).sum(), rel=1e-2)


def test_filters_by_functions_kernels_and_factors(basis):
    f = _rough(basis.n, 2)
    factors = np.exp(-0.3 * basis.eigenvalues)
    expected = basis.inverse(factors[:, None] * basis.forward(f))
    for h in (Heat(0.3), lambda x: np.exp(-0.3 * x), factors, factors.tolist()):
        np.testing.assert_allclose(basis.filter(f, h), expected, rtol=1e-13, atol=1e-13)
    one = basis.filter(f[:, 0], Heat(0.3))
    assert one.shape == (basis.n,)
    np.testing.assert_allclose(one, expected[:, 0], atol=1e-13)


def test_the_rest_of_a_function_is_dropped_or_kept(basis):
    f = _rough(basis.n)
    inside = basis.inverse(basis.forward(f))
    np.testing.assert_allclose(basis.filter(f, np.ones(30)), inside, atol=1e-12)
    np.testing.assert_allclose(basis.filter(f, np.ones(30), rest=1.0), f, atol=1e-12)
    halved = basis.filter(f, np.zeros(30), rest=0.5)
    np.testing.assert_allclose(halved, (f - inside) / 2, atol=1e-12)


def test_truncation_is_an_ideal_low_pass(basis):
    f = _rough(basis.n, 2)
    cut = (basis.eigenvalues[11] + basis.eigenvalues[12]) / 2
    np.testing.assert_allclose(basis.truncate(f, 12), basis.filter(f, LowPass(cut)), atol=1e-12)
    assert not basis.truncate(f, 0).any()


def test_the_errors_are_those_of_the_truncations(pair, basis):
    f = _rough(pair.n, 2)
    decay = basis.error_decay(f)
    assert decay.shape == (31, 2)
    for m in range(31):
        left = f - basis.truncate(f, m)
        for c in range(2):
            assert decay[m, c] == pytest.approx(pair.norm(left[:, c]), rel=1e-12)
    assert decay[-1].min() > 1e-2  # 30 of 192 terms leave much
    assert basis.error_decay(f[:, 0]).shape == (31,)
    np.testing.assert_allclose(basis.error_decay(f[:, 0]), decay[:, 0], rtol=1e-14)


@pytest.mark.parametrize("scale", [1e-200, 1.0, 1e200])
def test_errors_of_any_size(basis, scale):
    """Their squares are no numbers; differences of energies would be rounding."""
    smooth = basis.inverse(10.0 ** -np.arange(30))
    found = basis.error_decay(scale * smooth) / scale
    np.testing.assert_allclose(found[:13], 10.0 ** -np.arange(13) / np.sqrt(0.99), rtol=1e-3)
    assert found[15:].max() < 1e-13


def test_what_is_refused(basis):
    f = np.ones(basis.n)
    for m in (-1, 31, 2.5, None):
        with pytest.raises(BeltramiError, match="from 0 to 30"):
            basis.truncate(f, m)
    with pytest.raises(DimensionError, match="30"):
        basis.filter(f, np.ones(29))
    with pytest.raises(NonFiniteError):
        basis.filter(f, np.full(30, np.nan))
    with pytest.raises(BeltramiError, match="rest"):
        basis.filter(f, np.ones(30), rest=np.inf)
    for method in (basis.energy, basis.error_decay, lambda g: basis.filter(g, Heat(1.0))):
        with pytest.raises(DimensionError):
            method(f[1:])
        with pytest.raises(NonFiniteError):
            method(f * np.inf)
