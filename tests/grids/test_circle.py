"""The circle: shapes, limits of the input; the theorems are 19 and 20."""

import numpy as np
import pytest

from beltrami.errors import BeltramiError, DimensionError, NonFiniteError
from beltrami.grids.circle import (
    circle_atoms,
    coefficient_bound,
    decay_exponent,
    fourier_coefficients_circle,
)


def test_shapes():
    x = np.zeros((2, 3))
    assert circle_atoms(4, x).shape == (2, 3)
    assert circle_atoms([4, 5], x).shape == (2, 3, 2)
    assert coefficient_bound([[1, 2]], 0, 1.0).shape == (1, 2)
    series = fourier_coefficients_circle(np.arange(5))
    assert series.error([[1, 2, 3]]).shape == (1, 3)
    with pytest.raises(ValueError):
        series.coefficients[0] = 1


def test_a_constant_has_one_coefficient():
    for n in (1, 2, 7):
        series = fourier_coefficients_circle(np.ones(n))
        at = series.frequencies == 0
        assert series.coefficients[at][0] == pytest.approx(np.sqrt(2 * np.pi))
        assert np.abs(series.coefficients[~at]).max(initial=0) < 1e-15
        assert series.error(0) == pytest.approx(0, abs=1e-30)


def test_bad_input():
    for wrong in (0.5, [1, 2.0], "a"):
        with pytest.raises(DimensionError):
            circle_atoms(wrong, 0.0)
    with pytest.raises(NonFiniteError):
        circle_atoms(1, [np.nan])
    with pytest.raises(DimensionError):
        fourier_coefficients_circle(np.ones((2, 2)))
    with pytest.raises(NonFiniteError):
        fourier_coefficients_circle([1, np.nan])
    for wrong in ([-1], [np.nan]):
        with pytest.raises(DimensionError):
            fourier_coefficients_circle([1, 2]).error(wrong)
    with pytest.raises(DimensionError, match="frequency 0"):
        coefficient_bound([1, 0], 1, 1.0)
    for order in (-1, 0.5, True):
        with pytest.raises(BeltramiError, match="order"):
            coefficient_bound(1, order, 1.0)
    for supremum in (-1.0, np.inf, np.nan):
        with pytest.raises(BeltramiError, match="supremum"):
            coefficient_bound(1, 1, supremum)


def test_a_slope_needs_two_points():
    for x, y in (([1], [1]), ([1, 1], [1, 2]), ([1, 2], [1]), ([[1, 2]], [[1, 2]])):
        with pytest.raises(DimensionError, match="two"):
            decay_exponent(x, y)
    for x, y in (([1, 2], [0, 1]), ([0, 2], [1, 1]), ([1, 2], [np.nan, 1]), ([1, 2], [-1, 1])):
        with pytest.raises(DimensionError, match="positive"):
            decay_exponent(x, y)
