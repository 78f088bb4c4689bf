import math

import numpy as np
import pytest
import scipy.sparse

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.diffusion.interpolate import interpolate
from beltrami.diffusion.regularize import FORMS, regularize
from beltrami.errors import (
    BeltramiError,
    DimensionError,
    MeshError,
    NegativeWeightError,
    NonFiniteError,
    UnknownNameError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

MASSES = ("degree", "voronoi", "consistent")


def objective(pair, f, g, t, form, soft):
    """The sum of squares of each form, written out."""
    L = pair.stiffness.toarray()
    root = np.sqrt(soft)
    if form == "mass":
        return (root * (f - g)) @ (pair.mass @ (root * (f - g))) + t * g @ L @ g
    if form == "identity":
        return soft @ (f - g) ** 2 + t * g @ L @ g
    h = g / np.sqrt(L.diagonal())
    return soft @ (f - g) ** 2 + t * h @ L @ h


@pytest.mark.chapter("D20")
@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("constrained", [False, True])
def test_the_minimum_with_weights_and_held_values(form, mass, constrained):
    """No change of the free values makes the objective of this form smaller."""
    mesh = MESHES["cur"]()
    pair = laplacian(mesh, mass=mass)
    rng = np.random.default_rng(662607)
    f, soft, held = rng.normal(size=pair.n), np.ones(pair.n), np.zeros(pair.n, bool)
    if constrained:
        soft = rng.uniform(0, 3, size=pair.n) * (rng.uniform(size=pair.n) < 0.4)
        held[::17] = True
    t = 2.0 if form == "normalized" or mass == "degree" else 0.01
    weights = soft if constrained else None
    g = regularize(pair, f, t, form, hold=held, weights=weights)
    assert np.array_equal(g[held], f[held])
    least = objective(pair, f, g, t, form, soft)
    for _ in range(5):
        change = rng.normal(size=pair.n) * ~held
        for size in (-1, -1e-3, 1e-3, 1):
            assert objective(pair, f, g + size * change, t, form, soft) > least
    for other in set(FORMS) - {form}:
        if (mass, {form, other}) == ("degree", {"mass", "normalized"}):
            continue
        wrong = regularize(pair, f, t, other, hold=held, weights=weights)
        assert objective(pair, f, wrong, t, form, soft) > least * (1 + 1e-6)


@pytest.mark.parametrize("form", FORMS)
def test_held_values_and_weights_against_a_dense_solve(form):
    """The consistent mass also joins held and free vertices."""
    mesh = MESHES["cur"]()
    pair = laplacian(mesh, mass="consistent")
    rng = np.random.default_rng(299792)
    f, soft = rng.normal(size=pair.n), rng.uniform(0.5, 2, size=pair.n)
    held = rng.uniform(size=pair.n) < 0.3
    L, root, d = pair.stiffness.toarray(), np.diag(np.sqrt(soft)), pair.degrees
    C = root @ pair.mass @ root if form == "mass" else np.diag(soft)
    S = L / np.sqrt(np.outer(d, d)) if form == "normalized" else L
    A, b = C + 0.02 * S, C @ f
    A[held], b[held] = np.eye(pair.n)[held], f[held]
    found = regularize(pair, f, 0.02, form, hold=held, weights=soft)
    assert np.allclose(found, np.linalg.solve(A, b), atol=1e-11)


@pytest.mark.chapter("D20")
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_mass_form_is_one_implicit_step_of_heat(name):
    pair = laplacian(MESHES[name]())
    f = oracle.rough_functions(MESHES[name]())
    assert np.allclose(regularize(pair, f, 0.03), heat(pair, f, 0.03, steps=1), atol=1e-13)


@pytest.mark.chapter("T18")
@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("constrained", [False, True])
def test_infinity_is_the_limit(form, constrained):
    pair = laplacian(MESHES["obt"](), mass="degree")
    f = oracle.rough_functions(MESHES["obt"](), 2)
    soft = np.arange(pair.n) % 3.0 if constrained else None
    hold = [5, 70] if constrained else []
    limit = regularize(pair, f, math.inf, form, weights=soft, hold=hold)
    errors = []
    for t in (1e5, 1e6, 1e7):
        found = regularize(pair, f, t, form, weights=soft, hold=hold)
        errors.append(np.abs(found - limit).max())
    assert errors[1] == pytest.approx(errors[0] / 10, rel=0.05)
    assert errors[2] == pytest.approx(errors[0] / 100, rel=0.05)
    assert errors[2] < 1e-3


def test_few_values_with_noise_and_the_harmonic_limit_of_large_weights():
    """Weights on few vertices: between nothing given and an interpolation."""
    mesh = icosphere(3)
    pair = laplacian(mesh)
    rng = np.random.default_rng(137035)
    places = rng.choice(pair.n, 80, replace=False)
    truth = mesh.vertices[:, 2]
    noisy = truth + 0.6 * rng.normal(size=pair.n)
    soft = np.zeros(pair.n)
    soft[places] = pair.n / 80
    guess = regularize(pair, noisy, 0.05, weights=soft)
    through = interpolate(pair, places, noisy[places])
    assert pair.norm(guess - truth) < 0.8 * pair.norm(through - truth)
    assert np.allclose(regularize(pair, noisy, 0.05, weights=1e9 * soft), through, atol=1e-6)
    other = np.where(soft > 0, noisy, 1e6)  # what has no weight is not used
    assert np.allclose(regularize(pair, other, 0.05, weights=soft), guess, atol=1e-12)


def two_spheres():
    one = icosphere(1)
    x = np.concatenate([one.vertices, one.vertices + 9])
    return Mesh(x, np.concatenate([one.faces, one.faces + 42]))


def test_a_component_without_any_weight_is_named():
    pair = laplacian(two_spheres())
    f = oracle.rough_functions(two_spheres(), 1)[:, 0]
    soft = np.where(np.arange(84) < 42, 0.0, 1)
    for t in (0, 1.0, math.inf):
        with pytest.raises(MeshError, match="neither a weight nor") as caught:
            regularize(pair, f, t, weights=soft)
        assert caught.value.vertices.tolist() == [0]
    held = regularize(pair, f, 1.0, weights=soft, hold=[7])
    assert np.allclose(held[:42], f[7])
    assert np.allclose(held[42:], regularize(pair, f, 1.0)[42:])


@pytest.mark.parametrize("form", FORMS)
def test_means_are_kept_however_long(form):
    pair = laplacian(two_spheres(), "combinatorial", "voronoi")
    f = oracle.rough_functions(two_spheres(), 1)[:, 0]
    measure = {
        "mass": pair.masses,
        "identity": np.ones(84),
        "normalized": np.sqrt(pair.degrees),
    }[form]
    for t in (1e-3, 1.0, 1e6, 1e11, math.inf):
        g = regularize(pair, f, t, form)
        for part in (slice(0, 42), slice(42, 84)):
            assert measure[part] @ g[part] == pytest.approx(measure[part] @ f[part], abs=1e-12)


@pytest.mark.parametrize("form", FORMS)
def test_edges_of_the_domain(form):
    pair = laplacian(MESHES["open"]())
    f = oracle.rough_functions(MESHES["open"](), 2)
    assert np.allclose(regularize(pair, f, 0, form), f, atol=1e-14)
    assert regularize(pair, f[:, :0], 1.0, form).shape == (pair.n, 0)
    both = regularize(pair, f, 0.1, form)
    assert np.allclose(regularize(pair, f[:, 1], 0.1, form), both[:, 1], atol=1e-13)


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_any_unit_of_length(unit):
    mesh = MESHES["cur"]()
    f = oracle.rough_functions(mesh, 1)[:, 0]
    pair, scaled = laplacian(mesh), laplacian(mesh.with_vertices(unit * mesh.vertices))
    for form, power in (("mass", 2), ("identity", 0), ("normalized", 0)):
        expected = regularize(pair, f, 0.1, form)
        found = regularize(scaled, f, 0.1 * unit**power, form)
        assert np.allclose(found, expected, atol=1e-9)


def test_what_is_refused():
    pair = laplacian(MESHES["open"]())
    f = np.zeros(pair.n)
    with pytest.raises(UnknownNameError, match="Did you mean 'normalized'"):
        regularize(pair, f, 1, "normalised")
    for t in (-1, np.nan):
        with pytest.raises(BeltramiError, match="t must be"):
            regularize(pair, f, t)
    with pytest.raises(MeshError, match="weights are negative") as caught:
        regularize(pair, f, 1, weights=np.where(np.arange(pair.n) == 9, -1.0, 1))
    assert caught.value.vertices.tolist() == [9]
    with pytest.raises(DimensionError, match="weights"):
        regularize(pair, f, 1, weights=np.ones((pair.n, 2)))
    with pytest.raises(NonFiniteError):
        regularize(pair, f, 1, weights=f + np.inf)
    with pytest.raises(DimensionError):
        regularize(pair, f[:3], 1)
    alone = laplacian(scipy.sparse.csr_array((1, 1)), mass="unit")
    assert regularize(alone, [4.0], 3).tolist() == [4]
    with pytest.raises(MeshError, match="degrees"):
        regularize(alone, [4.0], 3, "normalized")
    W = scipy.sparse.csr_array([[0, 2.0, 2], [2, 0, -1], [2, -1, 0]])
    with pytest.raises(NegativeWeightError):
        regularize(laplacian(W, mass="unit"), np.zeros(3), 1)
