"""Definition 12, the discrete Fourier transform: three conventions under one name (E35)."""

import numpy as np
import pytest

from beltrami.grids.grid import Grid
from beltrami.grids.transform import dft, idft

pytestmark = pytest.mark.chapter("D12", "P27")
RNG = np.random.default_rng(602214076)


def as_printed(f):
    n = len(f)
    k = np.arange(n)
    return np.array([(f * np.exp(2j * np.pi / n * k * w)).sum() / n for w in range(n)])


@pytest.mark.parametrize("n", [15, 16])
def test_as_printed_it_is_the_inverse_transform_of_numpy(n):
    f = RNG.normal(size=n) + 1j * RNG.normal(size=n)
    text = dft(f, "text")
    assert np.abs(text - as_printed(f)).max() < 1e-14
    assert np.abs(text - np.fft.ifft(f)).max() < 1e-15
    assert np.abs(text - np.fft.fft(f) / n).max() > 0.1  # the sign of the exponent tells
    assert np.abs(dft(f, "numpy") - np.fft.fft(f)).max() < 1e-13
    assert np.abs(idft(f, "text") - np.fft.fft(f)).max() < 1e-13


@pytest.mark.parametrize("n", [15, 16])
def test_theorem_11_and_definition_19_have_other_factors(n):
    f = RNG.normal(size=n)
    text, unitary = dft(f, "text"), dft(f)
    waves = np.exp(2j * np.pi / n * np.outer(np.arange(n), np.arange(n))) / np.sqrt(n)
    assert np.abs(unitary - waves.conj().T @ f).max() < 1e-14  # <f, u_w> of theorem 11
    assert np.allclose(np.abs(unitary), np.sqrt(n) * np.abs(text), rtol=1e-12)
    assert np.allclose(unitary, np.sqrt(n) * text.conj(), atol=1e-13)
    pair = Grid(n).make_laplacian()
    found = Grid(n).fourier_modes(real=False)
    of_mesh = found.modes.conj().T @ (pair.masses * f)  # definition 19
    order = found.frequencies[:, 0]
    assert np.allclose(of_mesh, np.sqrt(2 * n) * text.conj()[order], atol=1e-13)


@pytest.mark.parametrize("n", [15, 16])
def test_only_the_unitary_one_keeps_the_energy(n):
    f = RNG.normal(size=n)
    energy = f @ f
    ratios = {c: (np.abs(dft(f, c)) ** 2).sum() / energy for c in ("text", "unitary", "numpy")}
    assert ratios == pytest.approx({"text": 1 / n, "unitary": 1, "numpy": n})


def test_in_two_dimensions_it_is_one_axis_after_the_other():
    f = RNG.normal(size=(6, 9)) + 1j * RNG.normal(size=(6, 9))
    for convention in ("text", "unitary", "numpy"):
        rows = np.stack([dft(row, convention) for row in f])
        both = np.stack([dft(column, convention) for column in rows.T], axis=1)
        assert np.abs(dft(f, convention) - both).max() < 1e-12
    assert np.abs(dft(f, "text") - np.fft.ifft2(f)).max() < 1e-14
    assert np.abs(dft(f, "unitary") - np.fft.fft2(f, norm="ortho")).max() < 1e-14
