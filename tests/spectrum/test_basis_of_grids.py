"""Grids, whose eigenvalues have closed forms: what the eigensolver finds from the matrices."""

import numpy as np
import pytest

import beltrami as bt

GRIDS = [
    bt.Grid((7, 5)),
    bt.Grid((8, 6), periodic=False),
    bt.Grid((6, 7), periodic=(True, False), spacing=(0.3, 0.7)),
    bt.Grid((3, 4, 5)),
    bt.Grid(31, periodic=False),
]


@pytest.mark.chapter("T11", "T12", "P56")
@pytest.mark.parametrize("grid", GRIDS, ids=lambda grid: str(grid.shape))
@pytest.mark.parametrize(
    ("weights", "mass"),
    [("combinatorial", "unit"), ("distance", "unit"), ("dirichlet", "voronoi")],
)
def test_the_spectrum_is_the_sorted_closed_form(grid, weights, mass):
    exact = np.sort(grid.eigenvalues(weights, mass), axis=None)
    for k in (1, 9, 30):
        basis = bt.fourier_basis(bt.laplacian(grid, weights, mass), k)
        assert np.allclose(basis.eigenvalues, exact[:k], atol=1e-9 * exact[-1])
    unsorted = grid.eigenvalues(weights, mass).ravel()[:30]  # the order of the FFT (E71)
    assert not np.allclose(basis.eigenvalues, unsorted, atol=1e-3 * exact[-1]) or grid.shape == (
        31,
    )
