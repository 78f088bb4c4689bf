"""Grids against scipy: convolution that wraps around, and the cosine transform."""

import numpy as np
import pytest
import scipy.fft
import scipy.ndimage

from beltrami.grids.convolution import convolve
from beltrami.grids.grid import Grid


@pytest.mark.chapter("U16", "P25")
@pytest.mark.parametrize(("shape", "side"), [((9,), 5), ((6, 7), 3), ((5, 4, 6), 3)])
@pytest.mark.parametrize("method", ["direct", "fft"])
def test_stencils_are_placed_as_ndimage_does(shape, side, method):
    rng = np.random.default_rng(17)
    f, stencil = rng.normal(size=shape), rng.normal(size=(side,) * len(shape))
    expected = scipy.ndimage.convolve(f, stencil, mode="wrap")
    found = convolve(f, Grid(shape).kernel(stencil), method)
    assert np.abs(found - expected).max() < 1e-13


@pytest.mark.parametrize(("mass", "kind"), [("unit", 2), ("degree", 1)])
def test_between_ends_the_modes_are_those_of_the_cosine_transform(mass, kind):
    """Cells (unit mass) have the second kind; the degrees 1, 2 ... 2, 1 the first."""
    p = 9
    f = np.random.default_rng(18).normal(size=p)
    grid = Grid(p, False)
    pair, found = grid.make_laplacian(mass=mass), grid.fourier_modes(mass=mass)
    ours = found.modes.T @ (pair.mass @ f)
    if kind == 2:
        assert np.allclose(ours, scipy.fft.dct(f, 2, norm="ortho"), atol=1e-13)
    else:
        sums = scipy.fft.dct(f, 1)
        scale = np.where(np.isin(np.arange(p), (0, p - 1)), 2, 1) * (p - 1)
        assert np.allclose(ours * np.sqrt(scale), sums, atol=1e-13)
