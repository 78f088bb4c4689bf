import numpy as np
import pytest
import scipy.sparse

import dense_oracles as oracle
from beltrami.diffusion.interpolate import interpolate
from beltrami.errors import BeltramiError, DimensionError, MeshError, NegativeWeightError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

PLACES = [7, 2, 150, 40]


def energy(pair, f, order):
    if order == 1:
        return pair.dirichlet_energy(f)
    return pair.inner(pair.apply(f), pair.apply(f))


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("mass", ["degree", "voronoi"])
@pytest.mark.parametrize("name", IRREGULAR)
def test_no_other_function_through_the_values_has_less_energy(name, mass, order):
    pair = laplacian(MESHES[name](), mass=mass)
    values = np.array([[1.0, -2], [3, 0], [0, 0.5], [2, 2]])
    f = interpolate(pair, PLACES, values, order)
    assert np.array_equal(f[PLACES], values)
    change = oracle.rough_functions(MESHES[name](), 2)
    change[PLACES] = 0
    least = energy(pair, f, order)
    for size in (1e-5, 1e-3, 1):
        for sign in (-1, 1):
            assert energy(pair, f + sign * size * change, order) > least
    other = interpolate(pair, PLACES, values, 3 - order)
    assert energy(pair, other, order) > 1.01 * least


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("name", IRREGULAR)
def test_against_a_dense_solve(name, order):
    pair = laplacian(MESHES[name]())
    L = pair.stiffness.toarray()
    Q = L if order == 1 else L @ np.diag(1 / pair.masses) @ L
    free = np.ones(pair.n, bool)
    free[PLACES] = False
    values = np.array([1.0, 3, 0, 2])
    expected = np.zeros(pair.n)
    expected[PLACES] = values
    expected[free] = np.linalg.solve(Q[free][:, free], -Q[free][:, PLACES] @ values)
    assert np.allclose(interpolate(pair, PLACES, values, order), expected, atol=1e-7)
    assert np.allclose(interpolate(pair, ~free, expected[~free], order), expected, atol=1e-7)


@pytest.mark.parametrize("name", IRREGULAR)
def test_harmonic_functions_stay_between_their_values_with_positive_weights(name):
    pair = laplacian(MESHES[name](), "combinatorial")
    f = interpolate(pair, PLACES, [1.0, 3, -1, 2])
    assert f.min() == -1
    assert f.max() == 3


def test_order_two_has_no_peaks():
    """One value of another sign on a fine sphere: order 1 makes a needle of it."""
    mesh = icosphere(4)
    pair = laplacian(mesh)
    z = mesh.vertices[:, 2]
    places = np.flatnonzero(np.abs(z) > 0.9)
    rings = {}
    peak = int(np.abs(z).argmin())
    around = mesh.ring(peak)
    for order in (1, 2):
        f = interpolate(pair, [*places, peak], [*np.zeros(len(places)), 1.0], order)
        rings[order] = f[around].mean()
    assert rings[1] < 0.75
    assert rings[2] > 0.97


def test_linear_functions_on_a_planar_mesh():
    mesh = MESHES["bad"]()
    edge = np.unique(mesh.topology.boundary_edges)
    x = mesh.vertices @ [2.0, -1] + 3
    assert np.allclose(interpolate(laplacian(mesh), edge, x[edge]), x, atol=1e-12)


def test_a_component_without_a_value_is_named():
    one = icosphere(1)
    x = np.concatenate([one.vertices + 9 * k for k in range(3)])
    pair = laplacian(Mesh(x, np.concatenate([one.faces + 42 * k for k in range(3)])))
    for order in (1, 2):
        with pytest.raises(MeshError, match="in 2 components") as caught:
            interpolate(pair, [3, 4], [0, 1], order)
        assert caught.value.vertices.tolist() == [42, 84]
        f = interpolate(pair, [3, 4, 50, 100], [0, 1, 5, 6], order)
        assert np.allclose(f[42:84], 5)
        assert np.allclose(f[84:], 6)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_any_unit_of_length(order, unit):
    mesh = MESHES["cur"]()
    scaled = laplacian(mesh.with_vertices(unit * mesh.vertices))
    expected = interpolate(laplacian(mesh), PLACES, [1.0, 3, 0, 2], order)
    assert np.allclose(interpolate(scaled, PLACES, [1.0, 3, 0, 2], order), expected, atol=1e-7)


def test_little_input_and_what_is_refused():
    pair = laplacian(MESHES["open"]())
    but_one = np.arange(1, pair.n)
    assert np.array_equal(interpolate(pair, but_one, but_one)[1:], but_one)
    assert np.allclose(interpolate(pair, [3], 5.0, 2), 5)
    assert interpolate(pair, [3, 5], np.zeros((2, 0))).shape == (pair.n, 0)
    with pytest.raises(MeshError, match="no value is given in 1 component"):
        interpolate(pair, [], [])
    with pytest.raises(MeshError, match="held twice"):
        interpolate(pair, [1, 1], [0, 1])
    with pytest.raises(DimensionError):
        interpolate(pair, [1, 2], [0, 1, 2])
    with pytest.raises(BeltramiError, match="order"):
        interpolate(pair, [1], [0], 3)
    with pytest.raises(MeshError, match="diagonal mass"):
        interpolate(laplacian(MESHES["open"](), mass="consistent"), [1], [0], 2)
    W = scipy.sparse.csr_array([[0, 2.0, 2], [2, 0, -1], [2, -1, 0]])
    with pytest.raises(NegativeWeightError):
        interpolate(laplacian(W, mass="unit"), [0], [1])
