"""Differences along the axes, against shifts of the array."""

import numpy as np
import pytest

from beltrami.errors import UnknownNameError
from beltrami.grids.grid import Grid

GRIDS = [
    Grid(5, spacing=0.5),
    Grid((4, 3), spacing=(0.5, 2.0)),
    Grid((4, 3), (True, False), (0.5, 2.0)),
    Grid((2, 1, 3), False, (1.0, 0.3, 0.1)),
    Grid((2, 1, 3), True, (1.0, 0.3, 0.1)),
]


def shifted(grid, f, a, by):
    """The value one step further along an axis; beyond an end, that of the end."""
    if grid.periodic[a]:
        return np.roll(f, -by, a)
    at = np.clip(np.arange(grid.shape[a]) + by, 0, grid.shape[a] - 1)
    return np.take(f, at, axis=a)


@pytest.mark.chapter("P31", "P37")
@pytest.mark.parametrize("grid", GRIDS, ids=repr)
def test_each_scheme_against_shifts(grid):
    f = np.random.default_rng(15).normal(size=grid.shape)
    sides = {"forward": (0, 1, 1), "backward": (-1, 0, 1), "centered": (-1, 1, 2)}
    for scheme, (left, right, steps) in sides.items():
        G = grid.gradient(scheme)
        assert G.shape == (grid.dimension * grid.n_vertices, grid.n_vertices)
        found = (G @ f.ravel()).reshape(grid.dimension, *grid.shape)
        for a, h in enumerate(grid.spacing):
            exact = (shifted(grid, f, a, right) - shifted(grid, f, a, left)) / (steps * h)
            assert np.abs(found[a] - exact).max() < 1e-13
        assert abs(grid.divergence(scheme) + G.T).max() == 0
        assert np.abs(G @ np.ones(grid.n_vertices)).max() < 1e-14
        assert (G.data != 0).all()


@pytest.mark.chapter("P31")
@pytest.mark.parametrize("grid", GRIDS, ids=repr)
def test_minus_the_divergence_of_the_gradient_is_l(grid):
    L = grid.make_laplacian("distance", "unit").stiffness
    for scheme in ("forward", "backward"):
        assert abs(-(grid.divergence(scheme) @ grid.gradient(scheme)) - L).max() < 1e-12


def test_unknown_schemes():
    for make in (GRIDS[0].gradient, GRIDS[0].divergence):
        with pytest.raises(UnknownNameError) as caught:
            make("centred")
        assert caught.value.choices == ("forward", "backward", "centered")
