"""Theorem 20: how fast the error of M terms decays on the circle (E82)."""

import numpy as np
import pytest

from beltrami.grids.circle import FourierSeries, decay_exponent, fourier_coefficients_circle

pytestmark = pytest.mark.chapter("T20")
TERMS = 2 ** np.arange(4, 10)


def test_a_triangular_wave():
    """Its coefficients decay like ω^-2; E(M) like M^-3, not like M^-1.5 as printed."""
    n = 2**17
    x = 2 * np.pi * np.arange(n) / n
    series = fourier_coefficients_circle(np.abs(x - np.pi))
    slope = decay_exponent(TERMS, series.error(TERMS))
    assert slope == pytest.approx(-3, abs=0.03)
    assert abs(slope + 1.5) > 1.4


@pytest.mark.parametrize("decay", [1.5, 2, 3])
def test_coefficients_that_decay_like_a_power(decay):
    w = np.arange(-(2**16), 2**16 + 1)
    c = np.where(w == 0, 1, np.abs(w).clip(1) ** -float(decay)) + 0j
    slope = decay_exponent(TERMS, FourierSeries(c, w).error(TERMS))
    assert slope == pytest.approx(1 - 2 * decay, abs=0.09)  # decay = a + ½: M^(-2a)


def test_the_terms_kept_are_on_both_sides():
    """M terms are those with |ω| <= M/2: one sided frequencies would keep half of the energy."""
    x = 2 * np.pi * np.arange(64) / 64
    series = fourier_coefficients_circle(np.cos(5 * x) + 2)
    assert series.error([9.9, 10]) == pytest.approx([np.pi, 0], abs=1e-12)
    parts = [series.coefficients[np.abs(series.frequencies) > m / 2] for m in range(20)]
    expected = [(np.abs(part) ** 2).sum() for part in parts]
    assert series.error(range(20)) == pytest.approx(expected, abs=1e-14)
    assert series.error(1000) == 0


def test_a_surface_has_two_dimensions():
    """There the number of frequencies below λ grows like λ: M^-a, where the circle has M^-2a."""
    a = 2
    l = np.arange(1, 2**11)  # noqa: E741
    energies = l ** -(2.0 * a + 1)  # of the 2l+1 harmonics of degree l
    tails = np.cumsum(energies[::-1])[::-1]
    degrees = 2 ** np.arange(3, 8)
    slope = decay_exponent(degrees**2, tails[degrees])
    assert slope == pytest.approx(-a, abs=0.05)
