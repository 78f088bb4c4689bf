"""Other equations with the Laplacian (l. 421) are functions of it: waves, Poisson, Schrödinger."""

import numpy as np
import pytest

from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.filtering import filter as filter_function
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.kernels import Heat, Wave, WaveImpulse
from meshes_of_the_errata import MESHES

pytestmark = pytest.mark.chapter("P46")


@pytest.fixture(scope="module")
def pair():
    return laplacian(MESHES["cur"](), mass="degree")


@pytest.fixture(scope="module")
def functions(pair):
    return np.random.default_rng(3).normal(size=(2, pair.n))


@pytest.mark.parametrize("method", ["chebyshev", "lanczos", "exact"])
def test_waves(pair, functions, method):
    """F = cos(t√λ) f + sin(t√λ)/√λ g: the second difference in t is -B⁻¹L F, by 3.8."""
    f, g = functions

    def wave(t):
        start = filter_function(pair, f, Wave(t), method, tolerance=1e-12)
        return start + filter_function(pair, g, WaveImpulse(t), method, tolerance=1e-12)

    step = 1e-3
    before, now, after = (wave(1.5 + k * step) for k in (-1, 0, 1))
    second = (after - 2 * now + before) / step**2
    np.testing.assert_allclose(second, -pair.apply(now), atol=1e-4)
    assert np.abs(second - pair.apply(now)).max() > 1  # the other sign
    np.testing.assert_allclose(wave(0.0), f, atol=1e-11)
    np.testing.assert_allclose((wave(step) - wave(0)) / step, g, atol=1e-2)

    def energy(t):
        speed = (wave(t + step) - wave(t - step)) / (2 * step)
        return pair.norm(speed) ** 2 + pair.dirichlet_energy(wave(t))

    assert energy(4.0) == pytest.approx(energy(1.5), rel=1e-5)


def test_poisson(pair, functions):
    """1/λ, but 0 at 0, solves Lu = Bf for f of mean 0; a screened one needs no gap."""
    f = functions[0] - pair.mean(functions[0])
    basis = fourier_basis(pair, pair.n)
    gap = basis.eigenvalues[1] / 2

    def inverse(x):
        return np.where(x > gap, 1 / np.maximum(x, gap), 0)

    u = basis.filter(f, inverse)
    np.testing.assert_allclose(pair.stiffness @ u, pair.mass @ f, atol=1e-10)
    assert abs(pair.mean(u)) < 1e-12
    u = filter_function(pair, f, lambda x: 1 / (x + 0.5))
    np.testing.assert_allclose(pair.apply(u) + 0.5 * u, f, atol=1e-6)


def test_schroedinger(pair, functions):
    """Ψ = exp(-itλ) f, by its real and imaginary parts, keeps the norm; heat does not."""
    f = functions[0]
    t = 2.0
    real = filter_function(pair, f, lambda x: np.cos(t * x))
    imaginary = -filter_function(pair, f, lambda x: np.sin(t * x))
    assert pair.norm(real) ** 2 + pair.norm(imaginary) ** 2 == pytest.approx(pair.norm(f) ** 2)
    assert pair.norm(filter_function(pair, f, Heat(t))) < 0.8 * pair.norm(f)
    step = 1e-4
    later = filter_function(pair, f, lambda x: np.cos((t + step) * x), tolerance=1e-12)
    rate = (later - filter_function(pair, f, lambda x: np.cos(t * x), tolerance=1e-12)) / step
    np.testing.assert_allclose(rate, pair.apply(imaginary), atol=1e-3)  # i Ψ' = B⁻¹L Ψ
