"""Chebyshev series: the error that they tell is the error that they have."""

import numpy as np
import pytest

from beltrami.errors import ApproximationError, NonFiniteError
from beltrami.spectrum.chebyshev import chebyshev_series
from beltrami.spectrum.interval import Interval
from beltrami.spectrum.kernels import (
    BandPass,
    Heat,
    HighPass,
    LowPass,
    Tikhonov,
    Wave,
    WaveImpulse,
)

ONE = Interval(0.0, 10.0)
KERNELS = [
    Heat(0.1),
    Heat(30.0),
    Wave(9.0),
    WaveImpulse(9.0),
    Tikhonov(20.0),
    LowPass(4.0, 3.0),
    HighPass(4.0, 3.0),
    BandPass(2.0, 5.0, 2.0),
    Heat(1.0) * HighPass(4.0, 3.0) - 0.5,
]


def _everywhere(interval):
    low, high = interval
    part = np.concatenate([np.linspace(0, 1, 4001), np.geomspace(1e-9, 1, 1000)])
    return low + (high - low) * np.concatenate([part, 1 - part])


@pytest.mark.parametrize("tolerance", [1e-3, 1e-8])
@pytest.mark.parametrize("kernel", KERNELS, ids=repr)
def test_the_error_is_below_what_is_told_and_that_below_what_is_wanted(kernel, tolerance):
    series = chebyshev_series(kernel, ONE, tolerance)
    x = _everywhere(ONE)
    error = np.abs(series(x) - kernel(x)).max()
    assert error <= 1.01 * series.error <= 1.01 * tolerance * series.size
    assert series.size == pytest.approx(np.abs(kernel(x)).max(), rel=1e-3)
    fewer = chebyshev_series(kernel, ONE, order=max(1, int(0.6 * series.order)))
    assert np.abs(fewer(x) - kernel(x)).max() > error  # the order is not wasted


def test_the_order_of_heat_grows_like_the_root_of_the_time():
    orders = [chebyshev_series(Heat(t), ONE).order for t in (10, 1000, 100000)]
    assert orders[1] / orders[0] == pytest.approx(10, rel=0.3)
    assert orders[2] / orders[1] == pytest.approx(10, rel=0.3)


def test_the_interval_may_have_any_unit():
    for scale in (1e-18, 1e18):
        series = chebyshev_series(Heat(3 / scale), Interval(0.0, 10 * scale))
        np.testing.assert_allclose(series.coefficients, chebyshev_series(Heat(3), ONE).coefficients,
                                   atol=1e-15)  # fmt: skip


@pytest.mark.parametrize("time", [1e5, 1e8, 1e11])
def test_heat_that_only_the_smallest_eigenvalues_see(time):
    """At 512 nodes it is 0 wherever it is looked at: not so at 0 itself."""
    try:
        series = chebyshev_series(Heat(time), ONE)
    except ApproximationError:
        assert time > 1e6
        return
    assert series(0.0) == pytest.approx(1, abs=1e-8)


def test_a_bump_between_the_nodes():
    """512 nodes see nothing of it, or little: the probes and the next nodes do."""

    def bump(x):
        return np.exp(-(((x - 4.567) / 0.004) ** 2))

    series = chebyshev_series(bump, ONE)
    x = 4.567 + np.linspace(-0.02, 0.02, 401)
    assert np.abs(series(x) - bump(x)).max() < 1e-7


@pytest.mark.parametrize(
    "kernel", [LowPass(4.0), 0.5 * HighPass(4.0) + Heat(1.0), BandPass(0.0, 4)]
)
def test_jumps_are_refused_and_named(kernel):
    with pytest.raises(ApproximationError, match=r"jumps at λ = [04]"):
        chebyshev_series(kernel, ONE, 0.2)


def test_a_jump_beyond_the_spectrum_is_none():
    assert chebyshev_series(LowPass(10.0), ONE).order == 0
    assert chebyshev_series(LowPass(11.0), ONE)(3.0) == 1


def test_a_jump_that_nothing_tells_of_is_found():
    with pytest.raises(ApproximationError, match=r"error of about 0\.[2-9]"):
        chebyshev_series(lambda x: x > 4, ONE)


def test_a_kink_does_not_converge_in_silence():
    with pytest.raises(ApproximationError, match="order up to 32768"):
        chebyshev_series(lambda x: np.abs(x - 4.0), ONE, 1e-10)
    assert chebyshev_series(lambda x: np.abs(x - 4.0), ONE, 1e-2).error < 1e-1


def test_with_an_order_of_ones_own_the_error_is_told():
    for order in (0, 1, 7, 300, 3000):
        series = chebyshev_series(LowPass(4.0), ONE, order=order)
        assert series.order == order
        assert series.error > 0.3
    low = chebyshev_series(Heat(1.0), ONE, order=5)
    assert np.abs(low(_everywhere(ONE)) - Heat(1.0)(_everywhere(ONE))).max() <= 1.01 * low.error
    assert repr(low) == f"<ChebyshevSeries: order 5, error about {low.error:.2g}>"


def test_rounding_is_part_of_the_error():
    """The matrix is known to 1e-16 of its norm: with a slope of 1e7 there is no error of 1e-10."""
    with pytest.raises(ApproximationError):
        chebyshev_series(Heat(1e6), ONE, 1e-11)


def test_constants_and_an_interval_of_one_point():
    assert chebyshev_series(lambda x: 3.0, ONE).coefficients.tolist() == pytest.approx([3.0])
    series = chebyshev_series(Heat(1.0), Interval(0.0, 0.0))
    assert (series.order, series(0.0)) == (0, 1.0)
    zero = chebyshev_series(lambda x: 0 * x, ONE)
    assert (zero.order, zero.error) == (0, 0)


def test_a_pole_in_the_interval():
    with np.errstate(divide="ignore"), pytest.raises(NonFiniteError, match="eigenvalue 0"):
        chebyshev_series(lambda x: 1 / x, ONE)
