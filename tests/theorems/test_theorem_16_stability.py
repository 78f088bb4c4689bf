"""Theorem 16: explicit steps are bounded iff δ <= 2/λ_n, implicit ones always (E52, E55, E75)."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.sparse import csr_array

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.diffusion.smoothing import smooth
from beltrami.errors import StepTooLongError
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import MESHES

pytestmark = pytest.mark.chapter("T16")

COTANGENT = [("closed", False), ("obt", True), ("bad", True)]


def _explicit(pair, delta):
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    return np.eye(pair.n) - delta * np.linalg.solve(B, L)


@pytest.mark.chapter("R3")
@pytest.mark.parametrize(("name", "negative"), COTANGENT)
def test_the_limit_is_two_over_the_largest_eigenvalue(name, negative):
    mesh = MESHES[name]()
    pair = laplacian(mesh, "cotangent", "degree")
    true = 2 / np.linalg.eigvalsh(pair.normalized.toarray())[-1]
    assert (true < 1) == negative  # printed: δ < 1 suffices
    f = oracle.rough_functions(mesh, 1)[:, 0]
    below = np.linalg.matrix_power(_explicit(pair, 0.99 * true), 6000) @ f
    assert np.abs(below).max() <= 2 * np.abs(f).max()
    beyond = np.linalg.matrix_power(_explicit(pair, 1.01 * true), 6000) @ f
    assert np.abs(beyond).max() > 1e20
    longest = 2 / pair.spectral_bound()
    assert 2 / 3 < longest <= true  # safe on every mesh
    with pytest.raises(StepTooLongError) as caught:
        heat(pair, f, 10 * 1.01 * true, "explicit", 10)
    assert caught.value.longest == pytest.approx(longest)
    calm = heat(pair, f, 3000 * longest, "explicit", 3000)
    assert np.abs(calm).max() <= np.abs(f).max()


@pytest.mark.chapter("R3")
def test_the_printed_limit_is_neither_sufficient_nor_necessary():
    bad = laplacian(MESHES["bad"](), mass="degree")
    f = oracle.rough_functions(MESHES["bad"](), 1)[:, 0]
    assert np.abs(np.linalg.matrix_power(_explicit(bad, 0.9), 200) @ f).max() > 1e10
    tetrahedron = laplacian(csr_array(1.0 - np.eye(4)))
    g = np.array([1.0, -2, 0.5, 3])
    for delta, bounded in ((1.2, True), (1.49, True), (1.51, False)):
        power = np.linalg.matrix_power(_explicit(tetrahedron, delta), 400) @ g
        assert (np.abs(power).max() < 10) == bounded


def test_two_thirds_is_safe_for_any_cotangents():
    for name in ("obt", "open", "bad", "cur"):
        mesh = MESHES[name]()
        pair = laplacian(mesh, mass="degree")
        f = oracle.rough_functions(mesh, 1)[:, 0]
        result = heat(pair, f, 2000 / 3 * 2, "explicit", 2000)
        assert pair.norm(result) <= pair.norm(f)


@pytest.mark.parametrize("delta", [1.0, 10.0, 1000.0])
@pytest.mark.parametrize("name", ["closed", "bad"])
def test_implicit_steps_of_any_length_are_stable(name, delta):
    """Printed: for any δ <= 1 (E55)."""
    mesh = MESHES[name]()
    pair = laplacian(mesh, mass="degree")
    f = oracle.rough_functions(mesh, 1)[:, 0]
    values = np.linalg.eigvalsh(pair.normalized.toarray())
    assert np.abs(1 / (1 + delta * values)).max() == pytest.approx(1, abs=1e-9)
    result = heat(pair, f, 50 * delta, steps=50)
    assert pair.norm(result) <= pair.norm(f)
    far = heat(pair, f, 1e9, steps=4)
    assert np.allclose(far, pair.mean(f), atol=1e-6)  # the mean weighted by D (E74)
    assert abs(f.mean() - pair.mean(f)) > 1e-3


def _even_cycle():
    A = np.eye(16, k=1) + np.eye(16, k=-1)
    A[0, -1] = A[-1, 0] = 1
    return csr_array(A)


@pytest.mark.chapter("P40")
def test_a_bipartite_graph_converges_as_well():
    """Printed: the explicit scheme needs a graph that is not two-colourable (E75)."""
    pair = laplacian(_even_cycle())
    f = np.random.default_rng(9109383).normal(size=16)
    exact = expm(-2 * _minus_flow(pair)) @ f
    errors = {}
    for method in ("explicit", "implicit"):
        errors[method] = [heat(pair, f, 2.0, method, k) - exact for k in (10, 20, 40, 80)]
        sizes = [np.abs(e).max() for e in errors[method]]
        assert np.log2(sizes[-2] / sizes[-1]) == pytest.approx(1, abs=0.1)
    a, b = errors["explicit"][-1], errors["implicit"][-1]
    assert a @ b / np.linalg.norm(a) / np.linalg.norm(b) < -0.99


def _minus_flow(pair):
    return np.linalg.solve(pair.mass.toarray(), pair.stiffness.toarray())


@pytest.mark.chapter("R4", "U31")
def test_explicit_heat_with_the_degree_mass_is_averaging_with_that_step():
    mesh = MESHES["bad"]()
    pair = laplacian(mesh, "distance", "degree")
    f = oracle.rough_functions(mesh, 3)
    assert np.allclose(heat(pair, f, 7 * 0.8, "explicit", 7), smooth(pair, f, 7, 0.8), rtol=1e-9)


@pytest.mark.parametrize("name", ["closed", "obt", "bad"])
def test_the_default_explicit_steps_overshoot_no_mode(name):
    """δ <= 1 / bound, so that with positive weights a spike stays between 0 and 1."""
    pair = laplacian(MESHES[name](), "combinatorial")
    time, seen = 7.3 / pair.spectral_bound(), []
    spike = np.zeros(pair.n)
    spike[17] = 1
    after = heat(pair, spike, time, "explicit", progress=lambda done, total: seen.append(total))
    assert seen[-1] == 8  # the fewest
    assert after.min() >= 0
    assert after.max() <= 1
    one = heat(pair, spike, 1.9 / pair.spectral_bound(), "explicit", 1)
    with pytest.raises(AssertionError):  # a longer one, though stable, overshoots
        assert one.min() >= 0


@pytest.mark.chapter("R3")
@pytest.mark.parametrize("name", ["closed", "obt"])
def test_averaging_refuses_steps_beyond_two_over_the_bound(name):
    mesh = MESHES[name]()
    pair = laplacian(mesh, "combinatorial", "voronoi")  # its mass does not matter
    longest = 2 / pair.spectral_bound(mass="degree")
    assert 1 < longest <= 2 / np.linalg.eigvalsh(pair.normalized.toarray())[-1]
    f = oracle.rough_functions(mesh)
    calm = smooth(pair, f, 3000, 0.999 * longest)
    assert np.abs(calm).max() <= 2 * np.abs(f).max()
    with pytest.raises(StepTooLongError) as caught:
        smooth(pair, f, 1, 1.001 * longest)
    assert caught.value.longest == pytest.approx(longest)
