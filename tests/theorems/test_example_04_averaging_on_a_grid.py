"""Section 3.2.4: where the points of a grid are, and example 4, averaging (E31, E33)."""

import numpy as np
import pytest

from beltrami.grids.convolution import convolve
from beltrami.grids.grid import Grid


@pytest.mark.chapter("P24")
def test_the_end_point_is_the_first_one():
    """E31: the numbers of the errata, first eigenvalue of L/h² over 4π²."""
    right, with_both_ends = [], []
    for p in (16, 64):
        grid = Grid(p)
        assert np.allclose(grid.coordinates.ravel(), np.arange(p) / p, rtol=1e-15)
        first = np.sort(grid.eigenvalues("distance", "unit"))[1] / (4 * np.pi**2)
        right.append(first)
        other = Grid(p, spacing=1 / (p - 1))
        with_both_ends.append(np.sort(other.eigenvalues("distance", "unit"))[1] / (4 * np.pi**2))
    assert right == pytest.approx([0.9872, 0.9992], abs=5e-5)
    assert with_both_ends == pytest.approx([0.8677, 0.9682], abs=5e-5)


@pytest.mark.chapter("X4", "P25")
@pytest.mark.parametrize("d", [1, 2, 3])
def test_a_point_has_2d_neighbours(d):
    grid = Grid((3, 4, 5)[:d])
    kernel = grid.averaging_kernel()
    assert kernel.sum() == pytest.approx(1, abs=1e-15)
    assert np.count_nonzero(kernel) == 2 * d
    assert np.unique(kernel[kernel > 0]).tolist() == [1 / (2 * d)]
    printed = (kernel > 0).sum() / 2**d  # E33
    assert printed == {1: 1.0, 2: 1.0, 3: 0.75}[d]
    f = np.random.default_rng(d).normal(size=grid.shape)
    sides = [np.roll(f, side, a) for a in range(d) for side in (1, -1)]
    assert np.abs(convolve(f, kernel) - np.mean(sides, axis=0)).max() < 1e-15
    W = grid.make_laplacian().averaging
    assert np.abs(W.sum(axis=1) - 1).max() < 1e-15
    assert np.abs(W @ f.ravel() - np.mean(sides, axis=0).ravel()).max() < 1e-15


@pytest.mark.chapter("X4")
def test_in_one_dimension_it_is_one_nought_one_over_two():
    assert np.array_equal(Grid(9).averaging_kernel(), Grid(9).kernel([0.5, 0, 0.5]))
