"""Theorem 19 and the atoms of the circle: coefficients of smooth functions (E80, E81)."""

import numpy as np
import pytest

from beltrami.grids.circle import circle_atoms, coefficient_bound, fourier_coefficients_circle

ANGLES = 2 * np.pi * np.arange(64) / 64


@pytest.mark.chapter("U36", "P62")
def test_the_atoms_are_orthonormal_eigenvectors_of_the_second_derivative():
    w = np.arange(-31, 32)
    atoms = circle_atoms(w, ANGLES)
    assert atoms.shape == (64, 63)
    assert np.abs(atoms.conj().T @ atoms * (2 * np.pi / 64) - np.eye(63)).max() < 1e-13
    assert circle_atoms(2, 0.5) == pytest.approx(np.exp(1j) / np.sqrt(2 * np.pi))
    step = 1e-3
    moved = [circle_atoms([1, -3], ANGLES + d) for d in (-step, 0, step)]
    second = (moved[0] - 2 * moved[1] + moved[2]) / step**2
    assert np.allclose(second, -np.array([1, 9]) * moved[1], atol=1e-5)


@pytest.mark.chapter("P62")
def test_the_second_derivative_is_not_bounded():
    """E80: on the atoms its norm grows like ω², so it is not compact; its inverse is."""
    n = 4096
    x = 2 * np.pi * np.arange(n) / n
    for w in (1, 10, 100):
        atom = circle_atoms(w, x)
        derived = np.fft.ifft(-(np.fft.fftfreq(n, 1 / n) ** 2) * np.fft.fft(atom))
        assert np.linalg.norm(derived) / np.linalg.norm(atom) == pytest.approx(w**2, rel=1e-9)


@pytest.mark.chapter("T19", "U36")
@pytest.mark.parametrize("n", [15, 16])
def test_coefficients_of_a_trigonometric_polynomial_are_exact(n):
    x = 2 * np.pi * np.arange(n) / n
    rng = np.random.default_rng(14)
    w = np.arange(-7, 8)
    c = rng.normal(size=15) + 1j * rng.normal(size=15)
    series = fourier_coefficients_circle(circle_atoms(w, x) @ c)
    assert series.frequencies.tolist() == list(range(-(n // 2), (n + 1) // 2))
    kept = np.isin(series.frequencies, w)
    assert np.abs(series.coefficients[kept] - c).max() < 1e-13
    assert np.abs(series.coefficients[~kept]).max(initial=0) < 1e-13
    assert series.error(0) == pytest.approx((np.abs(np.delete(c, 7)) ** 2).sum())


@pytest.mark.chapter("T19")
def test_cos_breaks_the_printed_bound():
    """E81: |f^(1)| = sqrt(π/2) > 1; the bound with its factor holds, and is reached."""
    series = fourier_coefficients_circle(np.cos(ANGLES))
    at_one = abs(series.coefficients[series.frequencies == 1][0])
    assert at_one == pytest.approx(1.2533, abs=5e-5)
    assert at_one > 1.0 * 1**-1  # printed: ||f'|| |w|^-1
    assert at_one <= coefficient_bound(1, 1, 1.0) == pytest.approx(2.5066, abs=5e-5)
    for a in range(4):
        series = fourier_coefficients_circle(np.exp(3j * ANGLES))
        reached = abs(series.coefficients[series.frequencies == 3][0])
        assert coefficient_bound(3, a, 3.0**a) == pytest.approx(reached, rel=1e-12)
        assert coefficient_bound(-3, a, 3.0**a) == pytest.approx(reached, rel=1e-12)


@pytest.mark.chapter("T19")
def test_the_bound_holds_for_a_function_of_finite_smoothness():
    n = 2**14
    x = 2 * np.pi * np.arange(n) / n
    f = np.abs(np.sin(x)) ** 3  # twice differentiable, |f''| <= 6
    series = fourier_coefficients_circle(f)
    some = (np.abs(series.frequencies) > 0) & (np.abs(series.frequencies) < 500)
    bound = coefficient_bound(series.frequencies[some], 2, 6.0)
    assert (np.abs(series.coefficients[some]) <= bound).all()
