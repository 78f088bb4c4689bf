"""Definition 17: the heat equation, its means and its units (E50, E51)."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.sparse import csr_array

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("D17")


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("mass", ["degree", "voronoi", "consistent"])
def test_many_steps_come_near_the_exponential(name, mass):
    mesh = MESHES[name]()
    pair = laplacian(mesh, mass=mass)
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    f = oracle.rough_functions(mesh, 1)[:, 0]
    time = 2.0 if mass == "degree" else 0.02
    exact = expm(-time * np.linalg.solve(B, L)) @ f
    change = pair.norm(exact - f)
    assert pair.norm(heat(pair, f, time, steps=400) - exact) < 0.01 * change


@pytest.mark.chapter("P35")
def test_with_areas_z_on_the_sphere_decays_like_exp_of_minus_two_t():
    mesh = icosphere(4)
    z = mesh.vertices[:, 2]
    pair = laplacian(mesh)
    decay = pair.inner(heat(pair, z, 0.05, steps=200), z) / pair.inner(z, z)
    assert decay == pytest.approx(np.exp(-0.1), abs=2e-4)
    degree = laplacian(mesh, mass="degree")  # no unit: hardly anything happens (E50)
    decay = degree.inner(heat(degree, z, 0.05, steps=200), z) / degree.inner(z, z)
    assert decay > 0.999


@pytest.mark.parametrize("p", [16, 32, 64])
def test_the_time_of_the_degree_mass_is_half_of_the_square_of_the_spacing(p):
    A = np.eye(p, k=1) + np.eye(p, k=-1)
    A[0, -1] = A[-1, 0] = 1
    pair = laplacian(csr_array(A))
    wave = np.cos(2 * np.pi * np.arange(p) / p)
    rate = pair.inner(pair.apply(wave), wave) / pair.inner(wave, wave)
    assert rate / (4 * np.pi**2) == pytest.approx(1 / (2 * p**2), rel=10 / p**2)
