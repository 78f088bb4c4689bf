"""Closed forms for every mass, with ends and without, against the matrices."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltrami.errors import BeltramiError, MeshError, UnknownNameError
from beltrami.grids.grid import Grid


@st.composite
def grids(draw):
    d = draw(st.integers(1, 3))
    shape = draw(st.tuples(*[st.integers(1, 6)] * d))
    periodic = draw(st.tuples(*[st.booleans()] * d))
    return Grid(shape, periodic, spacing=draw(st.tuples(*[st.sampled_from([0.3, 1.0, 2.5])] * d)))


@pytest.mark.chapter("T11", "T12", "P56")
@given(
    grids(),
    st.sampled_from(["combinatorial", "distance", "dirichlet"]),
    st.sampled_from(["unit", "voronoi", "degree"]),
    st.booleans(),
)
def test_the_modes_solve_the_generalised_problem(grid, weights, mass, real):
    if mass == "degree" and grid.n_vertices == 1:
        return
    pair = grid.make_laplacian(weights, mass)
    try:
        found = grid.fourier_modes(None, weights, mass, real=real)
    except BeltramiError:
        assert np.ptp(pair.degrees) > 0  # only where the degrees vary,
        assert sum(p > 1 for p in grid.shape) > 1  # and in several dimensions
        return
    n, size = grid.n_vertices, np.abs(found.eigenvalues).max() + 1
    left = pair.stiffness @ found.modes
    right = (pair.mass @ found.modes) * found.eigenvalues
    assert np.abs(left - right).max() < 1e-12 * size * np.sqrt(pair.masses.max())
    gram = found.modes.conj().T @ (pair.mass @ found.modes)
    assert np.abs(gram - np.eye(n)).max() < 1e-12
    assert (np.diff(found.eigenvalues) >= 0).all()
    assert len(np.unique(found.frequencies, axis=0)) == n
    assert np.isrealobj(found.modes) == (real or not any(grid.periodic) or _is_path(grid, mass))
    by_frequency = grid.eigenvalues(weights, mass)
    assert by_frequency.shape == grid.shape
    assert np.array_equal(by_frequency[tuple(found.frequencies.T)], found.eigenvalues)
    assert by_frequency.max() <= pair.spectral_bound() * (1 + 1e-12)


def _is_path(grid, mass):
    long = [flag for p, flag in zip(grid.shape, grid.periodic, strict=True) if p > 1]
    return mass == "degree" and long == [False]


def test_some_are_the_first_of_all():
    grid = Grid((6, 9), (True, False))
    every = grid.fourier_modes(mass="unit")
    for k in (1, 7, 54):
        some = grid.fourier_modes(k, mass="unit")
        assert some.modes.shape == (54, k)
        assert np.array_equal(some.modes, every.modes[:, :k])
        assert np.array_equal(some.eigenvalues, every.eigenvalues[:k])
        assert np.array_equal(some.frequencies, every.frequencies[:k])


def test_a_large_grid_pays_for_the_modes_asked_for():
    grid = Grid((1000, 1000))
    found = grid.fourier_modes(5, mass="voronoi")
    assert found.frequencies.tolist() == [[0, 0], [0, 1], [0, 999], [1, 0], [999, 0]]
    assert np.linalg.norm(found.modes, axis=0) == pytest.approx(1000)


def test_mirrored_frequencies_are_equal_to_the_bit():
    values = Grid((7, 12, 5)).eigenvalues("distance", "voronoi")
    assert np.array_equal(values[1:], values[:0:-1])
    assert np.array_equal(values[:, 1:], values[:, :0:-1])


def test_high_frequencies_are_exact():
    """The angle is reduced in integers: the last modes are as good as the first."""
    n = 50_001
    grid = Grid(n)
    found = grid.fourier_modes(3, mass="unit", real=False)
    exact = np.exp(-2j * np.pi * np.arange(n) / n) / np.sqrt(n)
    assert found.frequencies[:, 0].tolist() == [0, 1, n - 1]
    assert np.abs(found.modes[:, 2] - exact).max() < 1e-15


def test_what_has_no_closed_form_is_refused():
    grid = Grid((4, 5), (False, True))
    for make in (grid.eigenvalues, grid.fourier_modes):
        with pytest.raises(BeltramiError, match="no closed form"):
            make()
    assert np.ptp(grid.make_laplacian().degrees) > 0
    assert Grid((2, 5), (False, True)).eigenvalues().max() <= 2  # all degrees are 3
    with pytest.raises(MeshError):
        Grid((1, 1)).eigenvalues()
    with pytest.raises(UnknownNameError):
        Grid(4).eigenvalues("cotangent")
    with pytest.raises(UnknownNameError):
        Grid(4).fourier_modes(mass="consistent")
    for k in (0, 5, 2.0, True, "3"):
        with pytest.raises(BeltramiError, match="1 to 4 modes"):
            Grid(4).fourier_modes(k)
    modes = Grid(4).fourier_modes()
    with pytest.raises(ValueError):
        modes.modes[0, 0] = 1
