"""Theorem 5: iterated averaging on a grid tends to the mean, if it is not bipartite (E37)."""

import numpy as np
import pytest

from beltrami.diffusion.smoothing import smooth
from beltrami.grids.convolution import convolve_repeatedly
from beltrami.grids.grid import Grid

pytestmark = pytest.mark.chapter("T5")
RNG = np.random.default_rng(299792458)


def averaged(grid, f, k):
    return convolve_repeatedly(f.reshape(grid.shape), grid.averaging_kernel(), k).ravel()


@pytest.mark.parametrize("shape", [(15,), (15, 15), (16, 15), (3, 2), (1, 15), (4, 4, 3)])
def test_with_an_odd_circle_it_tends_to_the_mean(shape):
    grid = Grid(shape)
    f = RNG.normal(size=grid.n_vertices)
    assert not grid.is_bipartite
    limit = grid.averaging_limit(f)
    assert limit.converges
    assert np.allclose(limit.even, f.mean(), rtol=1e-13)
    assert np.allclose(limit.odd, f.mean(), rtol=1e-13)
    assert np.abs(averaged(grid, f, 4000) - f.mean()).max() < 1e-14
    assert np.abs(averaged(grid, f, 4001) - f.mean()).max() < 1e-14


@pytest.mark.parametrize("shape", [(2,), (16,), (16, 16), (2, 6), (1, 16), (4, 4, 2)])
def test_without_one_it_jumps_between_the_means_of_two_colours(shape):
    grid = Grid(shape)
    f = RNG.normal(size=grid.n_vertices)
    assert grid.is_bipartite
    limit = grid.averaging_limit(f)
    assert not limit.converges
    for k, expected in ((4000, limit.even), (4001, limit.odd)):
        found = averaged(grid, f, k)
        assert np.abs(found - expected).max() < 1e-13
        assert np.abs(found - f.mean()).max() > 1e-3  # printed
    colour = np.indices(shape).sum(axis=0).ravel() % 2
    assert np.allclose(limit.even[colour == 0], f[colour == 0].mean())
    assert np.allclose(limit.odd[colour == 0], f[colour == 1].mean())
    lazy = grid.averaging_limit(f, lazy=True)
    assert lazy.converges
    assert np.abs(smooth(grid.make_laplacian(), f, 4000, 0.5) - lazy.even).max() < 1e-13


@pytest.mark.parametrize(
    ("shape", "periodic"),
    [((9,), False), ((4, 5), False), ((4, 5), (False, True)), ((6, 5), (True, False))],
)
@pytest.mark.parametrize("weights", ["combinatorial", "distance"])
def test_with_ends_the_means_are_weighted_by_the_degrees(shape, periodic, weights):
    grid = Grid(shape, periodic, spacing=[1.0, 0.7][: len(shape)])
    pair = grid.make_laplacian(weights)
    f = RNG.normal(size=(grid.n_vertices, 2))
    limit = grid.averaging_limit(f, weights)
    for k, expected in ((4000, limit.even), (4001, limit.odd)):
        assert np.abs(smooth(pair, f, k) - expected).max() < 1e-12
    assert limit.converges == (not grid.is_bipartite) == (periodic == (False, True))
    lazy = grid.averaging_limit(f, weights, lazy=True)
    assert np.abs(smooth(pair, f, 4000, 0.5) - lazy.odd).max() < 1e-12
    assert np.abs(lazy.even - f.mean(axis=0)).max() > 1e-4  # the plain mean is not the limit


def test_the_graph_decides():
    """Two colours, found by walking over the graph, exist exactly where is_bipartite says so."""
    for shape in ((2, 3), (2, 4), (3,), (4,), (1, 3), (1, 4), (3, 4), (1, 1), (5, 1, 2)):
        for periodic in (True, False):
            grid = Grid(shape, periodic)
            W = grid.make_laplacian(mass="unit").weights
            values = np.linalg.eigvalsh(W.toarray())
            symmetric = np.allclose(values, -values[::-1], atol=1e-12)
            assert grid.is_bipartite == symmetric


def test_local_filters_need_not_tend_to_the_mean():
    shift = Grid(15).kernel([0, 0, 1])  # rows add to one, the graph of the grid is not bipartite
    f = RNG.normal(size=15)
    found = convolve_repeatedly(f, shift, 4001)
    assert np.abs(found - np.roll(f, 4001 % 15)).max() < 1e-11
    assert np.abs(found - f.mean()).max() > 0.5
