"""Theorem 4 and l. 246: convolution, its kernel, its Fourier transform (E32, E34, E36)."""

import numpy as np
import pytest

from beltrami.grids.convolution import convolve, convolve_repeatedly, symbol
from beltrami.grids.transform import dft, idft

RNG = np.random.default_rng(137035999)


def translation_invariant(w):
    """A matrix with W(i + j, k + j) = W(i, k), made of its first column."""
    points = list(np.ndindex(w.shape))
    W = np.array([[w[tuple(np.subtract(i, k) % w.shape)] for k in points] for i in points])
    shifted = [points.index(tuple(np.add(i, 1) % w.shape)) for i in points]
    assert np.array_equal(W[np.ix_(shifted, shifted)], W)
    return W


@pytest.mark.chapter("U16", "P25")
@pytest.mark.parametrize("shape", [(7,), (8,), (4, 5)])
def test_the_kernel_is_the_first_column_and_not_the_first_row(shape):
    W = translation_invariant(RNG.normal(size=shape))
    f = RNG.normal(size=shape)
    true = (W @ f.ravel()).reshape(shape)
    assert np.abs(convolve(f, W[:, 0].reshape(shape)) - true).max() < 1e-13
    assert np.abs(convolve(f, W[0].reshape(shape)) - true).max() > 0.1  # printed (E32)
    even = W + W.T
    true = (even @ f.ravel()).reshape(shape)
    assert np.abs(convolve(f, even[0].reshape(shape)) - true).max() < 1e-13  # hides it


@pytest.mark.chapter("T4")
@pytest.mark.parametrize("shape", [(15,), (16,), (5, 6), (4, 6)])
@pytest.mark.parametrize("k", [1, 2, 3, 50])
def test_powers_multiply_the_transform_by_powers(shape, k):
    w = RNG.random(shape)
    w /= w.sum()
    f = RNG.normal(size=shape)
    W = translation_invariant(w)
    true = f.ravel()
    for _ in range(k):
        true = W @ true
    true = true.reshape(shape)
    n = f.size
    assert np.abs(convolve_repeatedly(f, w, k) - true).max() < 1e-14
    text = float(n) ** k * dft(w, "text") ** k * dft(f, "text")
    assert np.abs(dft(true, "text") - text).max() < 1e-13
    assert np.abs(idft(dft(w, "numpy") ** k * dft(f, "numpy"), "numpy") - true).max() < 1e-13
    root = float(n) ** (k / 2)
    assert np.abs(dft(true) - root * dft(w) ** k * dft(f)).max() < 1e-13
    printed = dft(w, "text") ** k * dft(f, "text")  # E34: n^k is lost
    assert abs(dft(true, "text").flat[0] / printed.flat[0]) == pytest.approx(float(n) ** k)


@pytest.mark.chapter("T4")
def test_the_ratios_of_the_errata():
    w, f = RNG.random(16), RNG.normal(size=16)
    for k, ratio in ((1, 16), (2, 256), (3, 4096)):
        true = dft(convolve_repeatedly(f, w, k), "text")
        assert np.allclose(true / (dft(w, "text") ** k * dft(f, "text")), ratio, rtol=1e-6)


@pytest.mark.chapter("T4")
def test_constants_stay():
    """With f = 1 the printed statement would have W 1 = 1/n."""
    w = RNG.random(16)
    w /= w.sum()
    assert np.allclose(convolve_repeatedly(np.ones(16), w, 7), 1, atol=1e-14)
    assert (dft(w, "text") * dft(np.ones(16), "text"))[0] == pytest.approx(1 / 16)


@pytest.mark.chapter("P26")
@pytest.mark.parametrize("shape", [(7,), (8,), (4, 5)])
def test_translation_invariant_operators_become_diagonal(shape):
    w = RNG.normal(size=shape)
    n = w.size
    F = np.stack([dft(row.reshape(shape)).ravel() for row in np.eye(n)], axis=1)
    assert np.abs(F.conj().T @ F - np.eye(n)).max() < 1e-14
    D = F @ translation_invariant(w) @ F.conj().T
    assert np.abs(D - np.diag(symbol(w).ravel())).max() < 1e-13
    other = F.conj() @ translation_invariant(w) @ F.T
    assert np.abs(other - np.diag(symbol(w).ravel())).max() > 0.1  # the other sign
