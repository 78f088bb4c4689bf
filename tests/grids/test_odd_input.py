"""What a grid is given by mistake: refused by name, with no NaN and no error of numpy's."""

import numpy as np
import pytest

from beltrami.errors import BeltramiError, DimensionError, MeshError, NonFiniteError
from beltrami.grids.circle import circle_atoms, coefficient_bound, fourier_coefficients_circle
from beltrami.grids.convolution import convolve_repeatedly
from beltrami.grids.grid import Grid
from beltrami.grids.transform import dft


def test_arrays_without_an_axis_are_one_number_for_all_axes():
    assert Grid(np.array(5)).shape == (5,)
    assert Grid((3, 4), np.array(True)).periodic == (True, True)
    with pytest.raises(DimensionError, match="whole numbers"):
        Grid(np.array(5.0))


@pytest.mark.parametrize("spacing", [1e-320, 1e308])
def test_steps_whose_inverse_or_whose_length_is_infinite_are_refused(spacing):
    with pytest.raises(DimensionError, match="range of floats"):
        Grid((3, 4), spacing=spacing)
    assert np.isfinite(Grid((3, 4), spacing=1e-307).gradient().data).all()


def test_no_entry_of_the_pair_and_no_eigenvalue_overflows():
    grid = Grid((3, 4), spacing=[1e-154, 1.0])  # 1 / h² is a float, and 16 / h² is none
    with pytest.raises(MeshError, match="range of floats"):
        grid.make_laplacian("distance")
    with pytest.raises(MeshError, match="too small for floats"):
        Grid((3, 4), spacing=[1e-160, 1e-148]).eigenvalues(mass="voronoi")


def test_what_overflows_on_finite_input_is_refused():
    huge = np.full(16, 1e308)
    with pytest.raises(NonFiniteError, match="too large for floats"):
        fourier_coefficients_circle(huge)
    with pytest.raises(NonFiniteError, match="too large for floats"):
        Grid((3, 3)).kernel(np.full((9, 9), 1e308))
    with pytest.raises(NonFiniteError, match="products with the frequencies"):
        circle_atoms([1, 2], 1e308)
    with pytest.raises(NonFiniteError, match="too large for floats"):
        coefficient_bound(1, 1, 1e308)
    with pytest.raises(NonFiniteError, match="NaN or infinite"):
        dft(np.full(3, np.longdouble("1e4000")))


def test_a_mean_of_finite_values_is_finite():
    limit = Grid(16).averaging_limit(np.full(16, 1e308))
    np.testing.assert_allclose(limit.even, 1e308)


def test_numbers_that_are_none_are_refused():
    with pytest.raises(BeltramiError, match="times"):
        convolve_repeatedly([1.0, 2.0], [0.5, 0.5], 10**400)
    for supremum in ("a", None, 1j, [1.0, 2.0]):
        with pytest.raises(BeltramiError, match="supremum"):
            coefficient_bound(1, 1, supremum)
    with pytest.raises(DimensionError, match="too large"):
        circle_atoms(np.uint64(2**63 + 5), 0.0)
    assert coefficient_bound([1, 2], 10**400, 1.0).round(4).tolist() == [2.5066, 0.0]
