"""Grid: its description, its points, its pair."""

import itertools
import pickle

import numpy as np
import pytest

import beltrami as bt
from beltrami.errors import DimensionError, MeshError, NonFiniteError, UnknownNameError
from beltrami.grids.grid import Grid
from beltrami.operators.laplacian import laplacian

SHAPES = [(1,), (2,), (3,), (8,), (1, 5), (2, 3), (2, 2), (4, 6), (3, 1, 4), (2, 3, 4)]


def neighbour_weights(grid, kind):
    """W by walking from each point one step each way: ten lines, no edges."""
    h = np.array(grid.spacing)
    w = {"combinatorial": 1 + 0 * h, "distance": 1 / h**2, "dirichlet": h.prod() / h**2}[kind]
    W = np.zeros((grid.n_vertices, grid.n_vertices))
    for i in itertools.product(*map(range, grid.shape)):
        for a, side in itertools.product(range(grid.dimension), (-1, 1)):
            j = list(i)
            j[a] += side
            if grid.periodic[a]:
                j[a] %= grid.shape[a]
            if 0 <= j[a] < grid.shape[a] and tuple(j) != i:
                at = [np.ravel_multi_index(k, grid.shape) for k in (i, j)]
                W[at[0], at[1]] += w[a]
    return W


def some_grids():
    for shape in SHAPES:
        for periodic in itertools.product((True, False), repeat=len(shape)):
            yield Grid(shape, periodic, spacing=[0.5, 0.7, 2.0][: len(shape)])


@pytest.mark.chapter("U16", "P25", "D9", "D13", "D14")
@pytest.mark.parametrize("kind", ["combinatorial", "distance", "dirichlet"])
@pytest.mark.parametrize("grid", list(some_grids()), ids=repr)
def test_the_pair_against_a_walk_over_the_points(grid, kind):
    W = neighbour_weights(grid, kind)
    pair = laplacian(grid, kind, "unit")
    L = np.diag(W.sum(axis=1)) - W
    assert np.allclose(pair.weights.toarray(), W, rtol=1e-14)
    assert np.allclose(pair.stiffness.toarray(), L, rtol=1e-14)
    assert (pair.edges[:, 0] < pair.edges[:, 1]).all()
    assert len(np.unique(pair.edges, axis=0)) == len(pair.edges) == np.count_nonzero(W) / 2
    assert np.array_equal(pair.edges, pair.edges[np.lexsort(pair.edges.T[::-1])])
    G = pair.gradient
    assert np.allclose((G.T @ G).toarray(), L, rtol=1e-13)
    if grid.n_vertices > 1:
        of_degree = laplacian(grid, kind, "degree")
        assert np.allclose(of_degree.masses, W.sum(axis=1))
        assert np.allclose(of_degree.averaging.toarray(), W / W.sum(axis=1)[:, None])
        assert np.allclose(of_degree.averaging.sum(axis=1), 1, atol=1e-14)
    for mass in ("degree", "voronoi", "unit")[grid.n_vertices == 1 :]:
        some = laplacian(grid, kind, mass)
        B = some.mass.diagonal() ** -0.5
        largest = np.linalg.eigvalsh(B[:, None] * L * B)[-1]
        bound = some.spectral_bound()
        assert largest <= bound * (1 + 1e-12)
        assert some.spectral_bound("unit") == laplacian(grid, kind, "unit").spectral_bound()
        assert some.properties.non_negative_weights


@pytest.mark.parametrize("shape", [(8,), (4, 6), (4, 2, 6)])
def test_the_bound_is_reached_on_a_torus_with_even_sides(shape):
    for mass in ("degree", "unit", "voronoi"):
        pair = laplacian(Grid(shape), "dirichlet", mass)
        B = pair.mass.diagonal() ** -0.5
        largest = np.linalg.eigvalsh(B[:, None] * pair.stiffness.toarray() * B)[-1]
        assert pair.spectral_bound() == pytest.approx(largest, rel=1e-12)


@pytest.mark.chapter("P25")
def test_two_points_on_a_circle_are_neighbours_twice():
    assert laplacian(Grid(2), mass="unit").stiffness.toarray().tolist() == [[2, -2], [-2, 2]]
    assert laplacian(Grid(2, False), mass="unit").stiffness.toarray().tolist() == [[1, -1], [-1, 1]]
    assert laplacian(Grid((2, 3))).degrees.tolist() == [4] * 6
    assert laplacian(Grid((1, 3))).degrees.tolist() == [2] * 3
    assert laplacian(Grid(1), mass="unit").stiffness.toarray().tolist() == [[0]]


@pytest.mark.chapter("P24")
def test_points_and_cells():
    circle = Grid(4)
    assert circle.coordinates.ravel().tolist() == [0, 0.25, 0.5, 0.75]
    segment = Grid(4, False)
    assert segment.coordinates.ravel().tolist() == [0.125, 0.375, 0.625, 0.875]
    grid = Grid((2, 3), (True, False), (1.0, 2.0))
    assert grid.coordinates.tolist() == [[0, 1], [0, 3], [0, 5], [1, 1], [1, 3], [1, 5]]
    assert (grid.shape, grid.periodic, grid.spacing) == ((2, 3), (True, False), (1.0, 2.0))
    assert (grid.dimension, grid.n_vertices) == (2, 6)
    assert laplacian(grid, mass="voronoi").masses.sum() == 2 * 6
    assert laplacian(Grid((3, 5, 7)), mass="voronoi").masses.sum() == pytest.approx(1)


def test_defaults_and_names():
    kinds = lambda pair: (pair.weight_kind, pair.mass_kind)  # noqa: E731
    assert kinds(laplacian(Grid(5))) == ("combinatorial", "degree")
    assert kinds(laplacian(Grid(5), "distance")) == ("distance", "degree")
    assert kinds(laplacian(Grid(5), "dirichlet")) == ("dirichlet", "voronoi")
    assert bt.Grid is Grid
    for wrong in ("cotangent", "distnace", ""):
        with pytest.raises(UnknownNameError) as caught:
            laplacian(Grid(5), wrong)
        assert caught.value.choices == ("combinatorial", "distance", "dirichlet")
    for wrong in ("barycentric", ""):
        with pytest.raises(UnknownNameError):
            laplacian(Grid(5), mass=wrong)


def test_one_number_for_one_axis_and_one_for_all():
    assert Grid(5).shape == (5,)
    assert Grid(np.array([5, 6])).shape == (5, 6)
    assert Grid((5, 6), True, 0.5).spacing == (0.5, 0.5)
    assert Grid((5, 6), np.array([True, False])).periodic == (True, False)
    assert Grid((5, 4)).spacing == (0.2, 0.25)


@pytest.mark.parametrize("shape", [0, -3, (), (4, 0), 2.0, "45", (3, "a"), True, (4, True), None])
def test_wrong_shapes(shape):
    with pytest.raises(DimensionError, match="grid"):
        Grid(shape)


@pytest.mark.parametrize("periodic", ["yes", 1, 0, None, (True,), (True, 1), (True, False, True)])
def test_wrong_flags(periodic):
    with pytest.raises(DimensionError, match="periodic"):
        Grid((4, 5), periodic)


@pytest.mark.parametrize("spacing", [0, -1.0, (1, 0), (1,), (1, 1, 1), "a", [[1, 1]], 1j])
def test_wrong_steps(spacing):
    with pytest.raises(DimensionError):
        Grid((4, 5), spacing=spacing)


@pytest.mark.parametrize("spacing", [np.nan, np.inf, (1, -np.inf)])
def test_steps_are_finite(spacing):
    with pytest.raises(NonFiniteError, match="spacing"):
        Grid((4, 5), spacing=spacing)


def test_what_floats_and_indices_cannot_hold_is_refused():
    with pytest.raises(DimensionError, match="too large"):
        Grid((30_000, 30_000))
    for step in (1e-200, 1e200):
        grid = Grid((4, 5), spacing=step)
        assert laplacian(grid).degrees.tolist() == [4] * 20
        with pytest.raises(MeshError, match="range of floats"):
            laplacian(grid, "distance")
        with pytest.raises(MeshError, match="measure"):
            laplacian(grid, mass="voronoi")


def test_one_point_has_no_degree():
    with pytest.raises(MeshError) as caught:
        laplacian(Grid((1, 1)))
    assert caught.value.vertices.tolist() == [0]
    assert laplacian(Grid((1, 1)), mass="voronoi").spectral_bound() == 0


def test_a_grid_is_frozen_and_travels():
    grid = Grid((4, 5), (True, False))
    with pytest.raises(AttributeError, match="a Grid is frozen"):
        grid.shape = (3,)
    with pytest.raises(ValueError):
        grid.coordinates[0] = 1
    again = pickle.loads(pickle.dumps(grid))  # noqa: S301
    assert (
        repr(again)
        == repr(grid)
        == "<Grid: 4 x 5 points, periodic x with ends, " + ("spacing 0.25 x 0.2>")
    )
    assert repr(Grid(3, False)) == "<Grid: 3 points, with ends, spacing 0.333333>"
