"""Theorem 11: the spectrum of a circle of n points (E69, E71), and definition 19 on it (P29)."""

import numpy as np
import pytest

from beltrami.grids.grid import Grid

SIZES = [1, 2, 3, 4, 15, 16]


def residuals(matrix, modes, eigenvalues):
    return np.linalg.norm(matrix @ modes - modes * eigenvalues, axis=0)


@pytest.mark.chapter("T11")
@pytest.mark.parametrize("n", SIZES)
@pytest.mark.parametrize("real", [True, False])
def test_each_mode_of_l(n, real):
    grid = Grid(n)
    L = grid.make_laplacian(mass="unit").stiffness
    found = grid.fourier_modes(mass="unit", real=real)
    assert np.abs(found.modes.conj().T @ found.modes - np.eye(n)).max() < 1e-14  # U*U = Id
    assert residuals(L, found.modes, found.eigenvalues).max() < 2e-14
    w = found.frequencies[:, 0]
    assert np.allclose(found.eigenvalues, 4 * np.sin(np.pi * w / n) ** 2, atol=1e-14)
    if not real:
        waves = np.exp(2j * np.pi / n * np.outer(np.arange(n), w)) / np.sqrt(n)
        assert np.abs(found.modes - waves).max() < 1e-14


@pytest.mark.chapter("T11")
@pytest.mark.parametrize("n", SIZES[1:])
def test_the_normalised_laplacian_has_half(n):
    grid = Grid(n)
    pair = grid.make_laplacian()
    found = grid.fourier_modes(real=False)
    assert np.allclose(found.eigenvalues * 2, grid.fourier_modes(mass="unit").eigenvalues)
    assert found.eigenvalues.max() <= 2
    unit = found.modes * np.sqrt(pair.degrees)[:, None]  # u = D^½ φ
    assert residuals(pair.normalized, unit, found.eigenvalues).max() < 1e-14
    gram = found.modes.conj().T @ (pair.mass @ found.modes)
    assert np.abs(gram - np.eye(n)).max() < 1e-14


@pytest.mark.chapter("T11")
@pytest.mark.parametrize("n", [15, 16])
def test_as_printed_it_fails_mode_by_mode(n):
    """E69: for odd n the printed list is a permutation, so only a test per mode can tell."""
    grid = Grid(n)
    w = np.arange(n)
    printed = 4 * np.sin(2 * np.pi * w / n) ** 2
    L = grid.make_laplacian(mass="unit").stiffness
    modes = np.exp(2j * np.pi / n * np.outer(w, w)) / np.sqrt(n)
    wrong = residuals(L, modes, printed)
    assert np.median(wrong) > 0.5
    true = grid.eigenvalues(mass="unit")
    assert residuals(L, modes, true).max() < 1e-13
    sorted_difference = np.abs(np.sort(printed) - np.sort(true)).max()
    if n == 15:
        assert wrong[2] == pytest.approx(1.547, abs=5e-4)
        half = residuals(grid.make_laplacian().normalized, modes, printed)
        assert half[2] == pytest.approx(1.878, abs=5e-4)
        assert sorted_difference < 1e-14  # the trap
    else:
        assert sorted_difference == pytest.approx(0.765, abs=5e-4)
        assert (printed < 1e-12).sum() == 2
        assert (true < 1e-12).sum() == 1


@pytest.mark.chapter("T11")
def test_the_order_of_the_transform_is_not_the_order_of_the_spectrum():
    """E71, with the numbers of the errata (λ of the normalised Laplacian)."""
    grid = Grid(15)
    by_frequency = [0, 0.0865, 0.3309, 0.6910, 1.1045]
    ascending = [0, 0.0865, 0.0865, 0.3309, 0.3309]
    assert grid.eigenvalues()[:5] == pytest.approx(by_frequency, abs=5e-5)
    found = grid.fourier_modes(real=False)
    assert found.eigenvalues[:5] == pytest.approx(ascending, abs=5e-5)
    assert found.frequencies[:5, 0].tolist() == [0, 1, 14, 2, 13]
    assert (np.diff(found.eigenvalues) >= 0).all()
    u = found.modes[:, 1] * np.sqrt(2)
    assert abs(u @ u) < 1e-15  # without the conjugate, U'U is not Id
    assert np.vdot(u, u).real == pytest.approx(1)


@pytest.mark.chapter("P29", "P56")
@pytest.mark.parametrize("n", [15, 16])
def test_eigenvectors_span_the_same_spaces(n):
    grid = Grid(n)
    values, vectors = np.linalg.eigh(grid.make_laplacian().normalized.toarray())
    real, waves = (grid.fourier_modes(mass="unit", real=flag).modes for flag in (True, False))
    assert np.isrealobj(real)
    starts = np.flatnonzero(np.diff(values, prepend=-1) > 1e-9)
    assert len(starts) == n // 2 + 1
    for space in np.split(np.arange(n), starts[1:]):
        projectors = [b[:, space] @ b[:, space].conj().T for b in (vectors, real, waves)]
        assert np.abs(projectors[0] - projectors[1]).max() < 1e-13
        assert np.abs(projectors[0] - projectors[2]).max() < 1e-13
    assert np.abs(np.abs(vectors) - np.abs(real)).max() > 0.01  # vectors need not agree


@pytest.mark.chapter("P56")
@pytest.mark.parametrize("n", [15, 16])
def test_real_modes_are_cosines_and_sines(n):
    found = Grid(n).fourier_modes(mass="unit")
    k = np.arange(n)
    for mode, w in zip(found.modes.T, found.frequencies[:, 0], strict=True):
        alone = w in (0, n / 2)
        wave = np.cos if w <= n / 2 else np.sin
        exact = wave(2 * np.pi * k * min(w, n - w) / n) * np.sqrt((1 if alone else 2) / n)
        assert np.abs(mode - exact).max() < 1e-14
