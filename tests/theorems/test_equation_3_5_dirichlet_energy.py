"""Equations 3.4 and 3.5: the Dirichlet energy, edge by edge and face by face (E26 to E30)."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.operators.gradient import face_gradient
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import MESHES

pytestmark = pytest.mark.chapter("Q3.5")


@pytest.mark.parametrize("name", MESHES)
def test_every_route_gives_the_energy_of_the_interpolant(name):
    mesh = MESHES[name]()
    pair = laplacian(mesh)
    i, j = mesh.edges.T
    for f in oracle.rough_functions(mesh, 3).T:
        exact = oracle.dirichlet_energy(mesh, f)
        assert pair.dirichlet_energy(f) == pytest.approx(exact, rel=1e-9)
        gradient = (face_gradient(mesh) @ f).reshape(mesh.dimension, -1)
        assert mesh.face_areas @ (gradient**2).sum(axis=0) == pytest.approx(exact, rel=1e-9)
        cot = 2 * pair.edge_weight  # as printed: w = cot α + cot β
        squares = (f[i] - f[j]) ** 2
        assert cot @ squares == pytest.approx(2 * exact, rel=1e-9)  # (3.5) as printed (E27)
        slopes = squares / mesh.edge_lengths**2
        true_areas = mesh.edge_lengths**2 * cot / 4
        assert true_areas @ slopes == pytest.approx(exact / 2, rel=1e-9)  # the dimension (E26)
        assert 2 * true_areas @ slopes == pytest.approx(exact, rel=1e-9)  # two slips cancel


def test_several_columns_add_up():
    mesh = MESHES["bad"]()
    f = oracle.rough_functions(mesh, 3)
    single = [laplacian(mesh).dirichlet_energy(c) for c in f.T]
    assert laplacian(mesh).dirichlet_energy(f) == pytest.approx(sum(single))


def test_a_smooth_function_on_the_square():
    mesh = MESHES["open"]()
    x, y = mesh.vertices.T
    f = np.sin(3 * x) * np.cos(2 * y)
    exact = 2.9839  # of the smooth function, from the errata (E29)
    assert laplacian(mesh).dirichlet_energy(f) == pytest.approx(exact, rel=0.05)


@pytest.mark.chapter("P35")
def test_l_is_minus_the_laplacian_times_the_areas():
    """On a mesh inscribed in the sphere the mean of B⁻¹L x over the surface is 2x (E30)."""
    mesh = MESHES["closed"]()
    pair = laplacian(mesh)
    x = mesh.vertices
    assert pair.inner(pair.apply(x), x) / pair.masses.sum() == pytest.approx(2, rel=1e-10)
    degree = laplacian(mesh, mass="degree")  # printed: D⁻¹L truly approximates it
    assert np.abs(degree.apply(x)).max() < 0.2
