"""Equation 3.8 and section 3.3.4: the wave, its start, its longest step, its drift (E57 to E60)."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.diffusion.wave import wave
from beltrami.errors import StepTooLongError
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES


def spectrum(pair):
    values, U = np.linalg.eigh(pair.normalized.toarray())
    root = np.sqrt(pair.degrees)
    return values.clip(0), U.T * root, U / root[:, None]


def start(name):
    f, g = oracle.rough_functions(MESHES[name](), 2).T
    return f + 1, g + 0.5


@pytest.mark.chapter("U33")
@pytest.mark.parametrize("name", IRREGULAR)
def test_each_frequency_swings_by_itself(name):
    """F̂ = cos(√λ t) f̂ + sin(√λ t)/√λ ĝ, with the factor t at λ = 0 (E60)."""
    pair = laplacian(MESHES[name](), "cotangent", "degree")
    values, transform, _ = spectrum(pair)
    w = np.sqrt(values)
    f, g = start(name)
    f_hat, g_hat = transform @ f, transform @ g
    times = np.array([0, 0.7, 5.0, 40.0])

    def check(factor):
        for time, frame in wave(pair, f, g, times, "spectral"):
            with np.errstate(invalid="ignore", divide="ignore"):
                expected = np.cos(w * time) * f_hat + factor(time) * g_hat
            assert np.allclose(transform @ frame, expected, atol=1e-9)

    check(lambda t: t * np.sinc(w * t / np.pi))
    w_zero = np.where(values < 1e-12, 0, w)
    for wrong in (
        lambda t: np.sin(w_zero * t) / w_zero,  # as printed: 0/0
        lambda t: np.where(w_zero > 0, np.sin(w * t) / np.where(w > 0, w, 1), 0),  # no drift
        lambda t: np.sin(w * t),
        lambda t: t * np.sinc(values * t / np.pi),
    ):
        with pytest.raises(AssertionError):
            check(wrong)


@pytest.mark.chapter("Q3.8", "U33")
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_mean_drifts(name):
    """E60 by number: mean(f) + t mean(g), by the degrees and not the plain ones."""
    pair = laplacian(MESHES[name](), "cotangent", "degree")
    f, g = start(name)

    def check(mean):
        for method in ("leapfrog", "implicit", "spectral"):
            for time, frame in wave(pair, f, g, [0, 5, 10], method):
                assert mean(frame) == pytest.approx(mean(f) + time * mean(g), abs=1e-12)

    check(pair.mean)
    with pytest.raises(AssertionError):
        check(np.mean)


@pytest.mark.chapter("Q3.8")
@pytest.mark.parametrize("mass", ["degree", "voronoi", "consistent"])
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_equation_itself(name, mass):
    """The second difference of close frames is -B⁻¹L F; the first, at 0, is g."""
    pair = laplacian(MESHES[name](), mass=mass)
    f, g = start(name)
    w = np.sqrt(pair.spectral_bound())
    h, time = 1e-3 / w, 3 / w
    times = [h, time - h, time, time + h]
    first, a, b, c = (frame for _, frame in wave(pair, f, g, times, "spectral"))
    scale = np.abs(pair.stiffness @ f).max()
    force = pair.mass @ ((a - 2 * b + c) / h**2)
    assert np.allclose(force, -(pair.stiffness @ b), atol=1e-4 * scale)
    assert not np.allclose(force, pair.stiffness @ b, atol=1e-2 * scale)
    assert np.allclose((first - f) / h, g, atol=1e-2 * w * np.abs(f).max())


@pytest.mark.chapter("U26")
@pytest.mark.parametrize("weights", ["combinatorial", "cotangent"])
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_longest_step(name, weights):
    """E59: 2/√λ_n; the proven bound stays below it, and above what the errata promise."""
    pair = laplacian(MESHES[name](), weights, "degree")
    values, _, _ = spectrum(pair)
    limit = 2 / np.sqrt(values[-1])
    with pytest.raises(StepTooLongError) as caught:
        wave(pair, np.zeros(pair.n), None, [1.0], step=1e6)
    promised = np.sqrt(2) if weights == "combinatorial" else 2 / np.sqrt(3)
    assert promised * (1 - 1e-5) <= caught.value.longest < limit
    f, _ = start(name)
    _, up, down = spectrum(pair)

    def largest(delta):
        f_hat = up @ f
        before, now = f_hat, f_hat - delta**2 / 2 * values * f_hat
        for _ in range(500):
            before, now = now, 2 * now - before - delta**2 * values * now
        return np.abs(down @ now).max()

    assert largest(0.98 * limit) < 1e3
    assert largest(1.02 * limit) > 1e20
    times = 0.98 * caught.value.longest * np.arange(0, 1000, 50)
    frames = [F for _, F in wave(pair, f, None, times, step=0.98 * caught.value.longest)]
    assert np.abs(frames).max() < 100
