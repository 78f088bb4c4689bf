"""Definition 6 with a mass: what the plain inner product loses (E12)."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("D6")


@pytest.mark.parametrize("name", IRREGULAR)
def test_the_square_of_the_norm_of_one(name):
    mesh = MESHES[name]()
    ones = np.ones(mesh.n_vertices)
    W = oracle.weights(mesh, "combinatorial")
    expected = {"unit": mesh.n_vertices, "degree": W.sum(), "voronoi": mesh.area}
    for mass, value in expected.items():
        assert laplacian(mesh, "combinatorial", mass).norm(ones) ** 2 == pytest.approx(value)


@pytest.mark.parametrize("name", IRREGULAR)
def test_averaging_is_self_adjoint_for_d_only(name):
    mesh = MESHES[name]()
    f, g = oracle.rough_functions(mesh, 2).T
    gaps = {}
    for mass in ("degree", "unit", "voronoi"):
        pair = laplacian(mesh, "combinatorial", mass)
        A = pair.averaging
        gaps[mass] = abs(pair.inner(A @ f, g) - pair.inner(f, A @ g)) / pair.norm(f) / pair.norm(g)
    assert gaps["degree"] < 1e-14
    assert gaps["unit"] > 1e-3
    assert gaps["voronoi"] > 1e-3


def test_averaging_may_increase_the_plain_norm_and_not_that_of_d():
    mesh = MESHES["closed"]()
    pair = laplacian(mesh, "combinatorial")
    A, D = pair.averaging.toarray(), np.diag(np.sqrt(pair.degrees))
    assert np.linalg.norm(A, 2) > 1.01
    assert np.linalg.norm(D @ A @ np.linalg.inv(D), 2) == pytest.approx(1)


def test_the_mean_over_a_sphere_that_is_sampled_more_in_the_north():
    rng = np.random.default_rng(6674301)
    x = rng.normal(size=(1500, 3))
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    x = x[(x[:, 2] > 0) | (rng.uniform(size=1500) < 0.3)]
    mesh = Mesh(x, ConvexHull(x).simplices)
    z = x[:, 2]
    assert abs(laplacian(mesh).mean(z)) < 0.01
    assert abs(laplacian(mesh, mass="barycentric").mean(z)) < 0.01
    assert laplacian(mesh, "combinatorial").mean(z) > 0.2
    assert z.mean() > 0.2


def test_one_step_of_heat_keeps_the_sum_with_the_mass_and_not_the_plain_one():
    mesh = MESHES["open"]()
    f = oracle.rough_functions(mesh, 1)[:, 0]
    for mass in ("degree", "voronoi", "consistent"):
        pair = laplacian(mesh, "cotangent", mass)
        after = heat(pair, f, 0.5 / pair.spectral_bound(), steps=1)
        assert pair.masses @ after == pytest.approx(pair.masses @ f, abs=1e-10)
        assert abs(after.sum() - f.sum()) > 1e-3
