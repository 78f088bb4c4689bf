import numpy as np
import pytest
import scipy.sparse

import dense_oracles as oracle
from beltrami.diffusion.poisson import poisson
from beltrami.errors import (
    BeltramiError,
    DimensionError,
    IncompatibleError,
    MeshError,
    NegativeWeightError,
    NonFiniteError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere
from beltrami.operators.gradient import face_divergence, face_gradient
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

MASSES = ("degree", "voronoi", "consistent", "unit")


def three_spheres():
    one = icosphere(1)
    x = np.concatenate([one.vertices, 2 * one.vertices + 9, 3 * one.vertices + 20])
    return Mesh(x, np.concatenate([one.faces + 42 * k for k in range(3)]))


@pytest.mark.chapter("P34", "P46")
@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_residual_and_the_mean(name, mass):
    pair = laplacian(MESHES[name](), mass=mass)
    f = oracle.rough_functions(MESHES[name]())
    right = f - pair.mean(f)
    u = poisson(pair, right)
    load = pair.mass @ right
    assert np.abs(pair.stiffness @ u - load).max() < 1e-11 * np.abs(load).max()
    assert np.abs(pair.mean(u)).max() < 1e-13 * np.abs(u).max()
    assert np.allclose(poisson(pair, load, integrated=True), u, rtol=1e-12)
    assert np.allclose(poisson(pair, right[:, 1]), u[:, 1], atol=1e-12 * np.abs(u).max())
    assert np.allclose(poisson(pair, f, project=True), u, atol=1e-11 * np.abs(u).max())


@pytest.mark.chapter("P34")
@pytest.mark.parametrize("name", IRREGULAR)
def test_it_has_the_least_energy(name):
    """Of ½<Lu, u> - <ρ, u>_B: every other function has more."""
    pair = laplacian(MESHES[name]())
    f, *others = oracle.rough_functions(MESHES[name](), 6).T
    right = f - pair.mean(f)
    u = poisson(pair, right)

    def energy(v):
        return pair.dirichlet_energy(v) / 2 - pair.inner(right, v)

    for other in others:
        for size in (1e-4, 1e-2, 1):
            assert energy(u + size * other) > energy(u)


@pytest.mark.chapter("P34")
@pytest.mark.parametrize("mass", MASSES)
def test_a_right_hand_side_with_a_mean_has_no_solution(mass):
    mesh = three_spheres()
    pair = laplacian(mesh, mass=mass)
    right = np.zeros(pair.n)
    right[42:84] = 0.25
    right[84:] = [-1, 1] * 21
    with pytest.raises(IncompatibleError, match=r"0\.25 in the component of vertex 42") as caught:
        poisson(pair, right)
    guilty = [42] if abs(pair.masses[84:] @ right[84:]) < 1e-9 else [42, 84]
    assert caught.value.vertices.tolist() == guilty
    assert "project=True" in str(caught.value)
    least = np.linalg.lstsq(pair.stiffness.toarray(), pair.mass @ right)[1]
    assert not least.size or least > 1e-6  # nothing solves it
    u = poisson(pair, right, project=True)
    assert not u[:84].any()
    values = poisson(pair, right, hold=[50, 90])
    assert values[50] == values[90] == 0
    assert np.abs(values[42:84]).max() > 0.01


@pytest.mark.chapter("P34")
def test_a_message_names_few_of_many_components():
    one = icosphere(0)
    x = np.concatenate([one.vertices + 5 * k for k in range(6)])
    pair = laplacian(Mesh(x, np.concatenate([one.faces + 12 * k for k in range(6)])))
    with pytest.raises(IncompatibleError, match="and not zero in 2 more") as caught:
        poisson(pair, np.repeat([0.0, 1, 2, 3, 4, 5], 12))
    assert caught.value.vertices.tolist() == [12, 24, 36, 48, 60]
    assert "3 in the component of vertex 36" in str(caught.value)


@pytest.mark.chapter("P34")
@pytest.mark.parametrize("name", ["closed", "cur"])
def test_what_rounding_leaves_is_no_mean(name):
    pair = laplacian(MESHES[name]())
    f = oracle.rough_functions(MESHES[name](), 1)[:, 0]
    poisson(pair, f - pair.mean(f) + 1e-11)
    with pytest.raises(IncompatibleError):
        poisson(pair, f - pair.mean(f) + 1e-7)
    with pytest.raises(IncompatibleError):
        poisson(pair, np.full(pair.n, 1e-30))
    assert not poisson(pair, np.zeros(pair.n)).any()


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("screen", [0.0, 3.5])
def test_held_values_against_a_dense_solve(mass, screen):
    mesh = MESHES["bad"]()
    pair = laplacian(mesh, mass=mass)
    right, values = oracle.rough_functions(mesh, 2), oracle.rough_functions(mesh)[:5, 1:]
    hold = [9, 3, 100, 55, 4]
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    A, b = L + screen * B, B @ right
    A[hold], b[hold] = np.eye(pair.n)[hold], values
    u = poisson(pair, right, hold=hold, values=values, screen=screen)
    assert np.allclose(u, np.linalg.solve(A, b), atol=1e-9)
    assert np.array_equal(u[hold], values)
    both = poisson(pair, right[:, 0], hold=hold, values=values, screen=screen)
    assert np.allclose(both[:, 0], u[:, 0], atol=1e-12)
    same = poisson(pair, right, hold=hold, values=values[:, 0], screen=screen)
    assert np.allclose(same[:, 0], u[:, 0], atol=1e-12)
    flat = poisson(pair, 0 * right[:, 0], hold=hold, values=2.5, screen=0)
    assert np.allclose(flat, 2.5)


@pytest.mark.chapter("P46")
@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("name", IRREGULAR)
def test_screened(name, mass):
    pair = laplacian(MESHES[name](), mass=mass)
    right = oracle.rough_functions(MESHES[name]()) + 1
    u = poisson(pair, right, screen=0.3)
    left = pair.stiffness @ u + 0.3 * (pair.mass @ u)
    assert np.allclose(left, pair.mass @ right, atol=1e-11)
    assert np.allclose(pair.mean(u), pair.mean(right) / 0.3)
    for wrong in (-1.0, np.nan, np.inf):
        with pytest.raises(BeltramiError, match="screen"):
            poisson(pair, right, screen=wrong)


def test_a_function_comes_back_from_its_gradient():
    mesh = MESHES["cur"]()
    pair = laplacian(mesh)
    f = oracle.rough_functions(mesh, 1)[:, 0]
    divergence = face_divergence(mesh) @ (face_gradient(mesh) @ f)
    u = poisson(pair, -divergence, integrated=True)
    assert np.allclose(u, f - pair.mean(f), atol=1e-10)


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_any_unit_of_length(unit):
    mesh = MESHES["cur"]()
    f = oracle.rough_functions(mesh, 1)[:, 0]
    pair, scaled = laplacian(mesh), laplacian(mesh.with_vertices(unit * mesh.vertices))
    u = poisson(pair, f, project=True)
    assert np.allclose(poisson(scaled, f / unit**2, project=True), u, rtol=1e-9, atol=1e-12)
    u = poisson(pair, f, screen=2.0)
    found = poisson(scaled, f / unit**2, screen=2 / unit**2)
    assert np.allclose(found, u, rtol=1e-9, atol=1e-12)


def test_little_input_and_what_is_refused():
    alone = laplacian(scipy.sparse.csr_array((1, 1)), mass="unit")
    assert poisson(alone, [0.0]).tolist() == [0]
    assert poisson(alone, [3.0], screen=2).tolist() == [1.5]
    pair = laplacian(MESHES["open"]())
    f = np.zeros(pair.n)
    assert poisson(pair, np.zeros((pair.n, 0))).shape == (pair.n, 0)
    with pytest.raises(DimensionError, match="right-hand side"):
        poisson(pair, f[:-1])
    with pytest.raises(NonFiniteError):
        poisson(pair, f + np.nan)
    with pytest.raises(MeshError, match="held vertices"):
        poisson(pair, f, hold=[-1])
    with pytest.raises(DimensionError, match="3 columns, and the values 2"):
        poisson(pair, np.zeros((pair.n, 3)), hold=[1], values=[[1, 2]])
    W = scipy.sparse.csr_array([[0, 2.0, 2], [2, 0, -1], [2, -1, 0]])
    with pytest.raises(NegativeWeightError):
        poisson(laplacian(W, mass="unit"), np.zeros(3))
