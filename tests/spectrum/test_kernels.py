"""Kernels: their formulas, what they refuse, and how they combine."""

import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltrami.errors import BeltramiError, DimensionError, NonFiniteError
from beltrami.spectrum.kernel import Kernel, evaluate
from beltrami.spectrum.kernels import (
    BandPass,
    Heat,
    HighPass,
    LowPass,
    Tikhonov,
    Wave,
    WaveImpulse,
    smooth_step,
)

X = np.array([0.0, 0.3, 1.0, 2.5, 40.0])


@pytest.mark.parametrize(
    ("kernel", "formula"),
    [
        (Heat(0.7), lambda x: np.exp(-0.7 * x)),
        (Tikhonov(0.7), lambda x: 1 / (1 + 0.7 * x)),
        (Wave(0.7), lambda x: np.cos(0.7 * np.sqrt(x))),
        (Heat(0.0), lambda x: 1 + 0 * x),
        (LowPass(1.0), lambda x: np.where(x <= 1, 1.0, 0.0)),
        (HighPass(1.0), lambda x: np.where(x <= 1, 0.0, 1.0)),
        (BandPass(0.3, 2.5), lambda x: np.where((x > 0.3) & (x <= 2.5), 1.0, 0.0)),
    ],
)
def test_formulas(kernel, formula):
    np.testing.assert_allclose(kernel(X), formula(X), rtol=1e-15)
    assert kernel(X.reshape(5, 1)).shape == (5, 1)
    assert kernel(2.5) == pytest.approx(formula(np.array(2.5)))


def test_the_impulse_of_a_wave():
    """h(λ) = sin(t √λ) / √λ, and t where λ = 0: the derivative in t of it is the other wave."""
    t = 1.3
    root = np.sqrt(X[1:])
    np.testing.assert_allclose(WaveImpulse(t)(X[1:]), np.sin(t * root) / root, rtol=1e-13)
    assert WaveImpulse(t)(0.0) == t
    step = 1e-5
    slope = (WaveImpulse(t + step)(X) - WaveImpulse(t - step)(X)) / (2 * step)
    np.testing.assert_allclose(slope, Wave(t)(X), atol=1e-8)


def test_waves_at_negative_eigenvalues_grow():
    """cos(i y) = cosh y: weights of either sign may have such eigenvalues."""
    assert Wave(2.0)(-4.0) == pytest.approx(np.cosh(4.0))
    assert WaveImpulse(2.0)(-4.0) == pytest.approx(np.sinh(4.0) / 2)


@given(st.floats(-2, 3))
def test_the_step_is_odd_about_its_middle_and_rises(x):
    x = np.array([x])
    assert smooth_step(x) + smooth_step(1 - x) == pytest.approx(1, abs=1e-12)
    assert 0 <= smooth_step(x)[0] <= smooth_step(x + 1e-3)[0] <= 1


def test_the_step_is_flat_at_its_ends():
    """All derivatives vanish there: it is below any power."""
    x = np.array([1e-3, 1e-2, 2e-2])
    assert (smooth_step(x) <= x**8).all()
    assert (1 - smooth_step(1 - x) <= x**8 + 1e-16).all()


@pytest.mark.parametrize("width", [0.0, 0.5, 1e-320])
def test_passes_split_the_spectrum(width):
    x = np.linspace(0, 10, 2001)
    passes = [LowPass(2, width), BandPass(2, 5, width), HighPass(5, width)]
    np.testing.assert_allclose(sum(h(x) for h in passes), 1, atol=1e-15)
    np.testing.assert_allclose((1 - LowPass(2, width))(x), HighPass(2, width)(x), atol=1e-15)
    away = np.abs(x - 2) > width / 2
    assert set(LowPass(2, width)(x[away]).tolist()) == {0.0, 1.0}


def test_jumps_are_told_and_inherited():
    assert LowPass(2).jumps == (2,)
    assert LowPass(2, 0.1).jumps == ()
    assert (Heat(1) * LowPass(2) + BandPass(2, 4)).jumps == (2, 4)
    assert (Heat(1) - Tikhonov(1)).jumps == ()


def test_combinations_are_those_of_their_values():
    g, h = Heat(0.4), Tikhonov(2.0)
    for kernel, values in [
        (g + h, g(X) + h(X)),
        (g - h, g(X) - h(X)),
        (g * h, g(X) * h(X)),
        (g / h, g(X) / h(X)),
        (2 + g, 2 + g(X)),
        (2 - g, 2 - g(X)),
        (2 * g, 2 * g(X)),
        (2 / g, 2 / g(X)),
        (g - 2, g(X) - 2),
    ]:
        np.testing.assert_array_equal(kernel(X), values)
    assert repr(1 - Heat(0.5) * 3) == "(1.0 - (Heat(time=0.5) * 3.0))"
    again = pickle.loads(pickle.dumps(g * h))  # noqa: S301
    assert again == g * h
    assert again != h * g


@pytest.mark.parametrize("other", ["a", None, np.inf, np.array([1.0, 2.0])])
def test_what_does_not_combine(other):
    with pytest.raises(BeltramiError, match="combines with"):
        Heat(1.0) * other


@pytest.mark.parametrize(
    "make",
    [
        lambda: Heat(-1.0),
        lambda: Heat(np.nan),
        lambda: Wave(np.inf),
        lambda: WaveImpulse("1"),
        lambda: Tikhonov(None),
        lambda: LowPass(-1.0),
        lambda: LowPass(1.0, -0.1),
        lambda: BandPass(2.0, 2.0),
        lambda: BandPass(2.0, 3.0, 1.5),
        lambda: HighPass(1j),
    ],
)
def test_parameters_that_make_no_kernel(make):
    with pytest.raises(BeltramiError):
        make()


def test_functions_of_users_are_checked():
    assert evaluate(lambda x: 3.0, X).tolist() == [3.0] * 5
    assert evaluate(lambda x: x > 1, X).tolist() == [0, 0, 0, 1, 1]
    with pytest.raises(DimensionError, match="real number for each"):
        evaluate(lambda x: np.exp(1j * x), X)
    with pytest.raises(DimensionError, match="real number for each"):
        evaluate(lambda x: x[:2], X)
    with pytest.raises(NonFiniteError, match=r"eigenvalue 1$"):
        evaluate(lambda x: np.where(x == 1, np.nan, x), X)
    with pytest.raises(BeltramiError, match="function of the eigenvalues"):
        evaluate(3.0, X)
    for h in (lambda x: 1 if x < 1 else 0, lambda x: math.exp(-x), lambda x, y: x):
        with pytest.raises(BeltramiError, match=r"with an array of eigenvalues.*numpy.where"):
            evaluate(h, X)


def test_a_kernel_without_a_formula_has_no_values():
    with pytest.raises(NotImplementedError):
        Kernel()(1.0)


def test_the_smooth_step_takes_lists_and_single_precision():
    x = np.linspace(-0.5, 1.5, 41)
    assert smooth_step(x.tolist()).tolist() == smooth_step(x).tolist()
    short = x.astype(np.float32)
    assert np.array_equal(smooth_step(short), smooth_step(short.astype(float)))
