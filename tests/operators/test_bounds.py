import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_array

import dense_oracles as oracle
from beltrami.errors import DimensionError, UnknownNameError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import torus
from beltrami.operators import bounds
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import MASSES
from beltrami.operators.weights import WEIGHTS
from meshes_of_the_errata import MESHES, flipped, triangle


def _pair(sides, corners):
    """The 3 x 3 pair of one face; weight k is that of the side opposite corner k."""
    u, v, w = sides
    W = np.array([[0, w, v], [w, 0, u], [v, u, 0.0]])
    return np.diag(W.sum(axis=1)) - W, np.diag(corners)


@settings(deadline=None, max_examples=100)
@given(st.integers(0, 2**40))
def test_the_largest_root_against_numpy(seed):
    rng = np.random.default_rng(seed)
    sides, corners = rng.uniform(0, 3, (4, 3)), rng.uniform(0.1, 2, (4, 3))
    cot = 1 / np.tan(oracle.angles(triangle(*rng.uniform(2, 89, 2))))
    sides[0] = cot[0]  # signs as a face can have them
    true = max(oracle.spectrum(*_pair(s, c))[-1] for s, c in zip(sides, corners, strict=True))
    assert bounds.largest_face_eigenvalue(sides, corners) == pytest.approx(true, rel=1e-9)


@pytest.mark.chapter("T9")
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("weights", WEIGHTS)
def test_bounds_the_spectrum_of_every_pair(name, weights):
    mesh = MESHES[name]()
    for mass in MASSES:
        pair = laplacian(mesh, weights, mass)
        true = oracle.spectrum(pair.stiffness.toarray(), pair.mass.toarray())[-1]
        bound = pair.spectral_bound()
        assert true <= bound * (1 + 1e-9)
        # the sum over faces is loose where the areas of neighbours differ much: by 60 at worst
        assert bound <= {"degree": 1.6, "unit": 4}.get(mass, 80) * true
        assert laplacian(mesh, weights, "unit").spectral_bound(mass=mass) == pytest.approx(bound)


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 2**40), st.floats(0.05, 1.0))
def test_bounds_the_spectrum_of_random_flipped_meshes(seed, aspect):
    mesh = flipped(seed, n=20, aspect=aspect)
    for weights in WEIGHTS:
        for mass in MASSES:
            pair = laplacian(mesh, weights, mass)
            true = oracle.spectrum(pair.stiffness.toarray(), pair.mass.toarray())[-1]
            assert true <= pair.spectral_bound() * (1 + 1e-9)
    assert laplacian(mesh, "cotangent", "degree").spectral_bound() < 3  # E62


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("weights", WEIGHTS)
def test_exact_for_a_single_face(weights, mass):
    for angles in ((60, 60), (45, 90), (15, 150), (1, 178), (20, 31)):
        pair = laplacian(triangle(*angles), weights, mass)
        true = oracle.spectrum(pair.stiffness.toarray(), pair.mass.toarray())[-1]
        assert pair.spectral_bound() == pytest.approx(true, rel=1e-7)  # a double root


def test_units_cancel_with_the_mass():
    mesh = MESHES["bad"]()
    for unit in (1e-9, 1e9):
        other = mesh.with_vertices(unit * mesh.vertices)
        for mass, power in (("voronoi", -2), ("consistent", -2), ("degree", 0), ("unit", 0)):
            ratio = laplacian(other, mass=mass).spectral_bound() / unit**power
            assert ratio == pytest.approx(laplacian(mesh, mass=mass).spectral_bound(), rel=1e-8)


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 2**40), st.booleans(), st.sampled_from(["degree", "unit"]))
def test_bounds_the_spectrum_of_a_graph(seed, signed, mass):
    rng = np.random.default_rng(seed)
    W = np.triu(rng.uniform(0.1, 1, (8, 8)) * (rng.uniform(size=(8, 8)) < 0.6), 1)
    W[np.arange(7), np.arange(1, 8)] += 1
    if signed:
        W[0, 7] = -0.05
    pair = laplacian(csr_array(W + W.T), mass=mass)
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    true = oracle.spectrum(L, B)[-1]
    bound = pair.spectral_bound()
    assert true <= bound * (1 + 1e-12)
    if mass == "degree" and not signed:
        assert bound == pytest.approx(2)  # theorem 9
    assert laplacian(csr_array(W + W.T), mass="unit").spectral_bound(mass=mass) == pytest.approx(
        bound
    )


def test_a_graph_without_edges():
    pair = laplacian(csr_array((3, 3)), mass="unit")
    assert pair.spectral_bound() == 0
    assert (
        bounds.largest_edge_eigenvalue(
            np.zeros((0, 2), np.int64), np.zeros(0), np.zeros(3), np.ones(3)
        )
        == 0
    )


def test_positions_are_needed_for_areas():
    pair = laplacian(MESHES["open"]().topology)
    assert pair.spectral_bound(mass="unit") > 0
    with pytest.raises(DimensionError, match="voronoi mass: a Topology has no positions"):
        pair.spectral_bound(mass="voronoi")
    with pytest.raises(UnknownNameError):
        pair.spectral_bound(mass="lumped")


def test_a_corner_without_mass_leaves_an_edge():
    zero = np.zeros((1, 3))
    for turn in range(3):
        sides, corners = np.roll([[2.0, 0, 0]], turn, 1), np.roll([[0.0, 1, 4]], turn, 1)
        assert bounds.largest_face_eigenvalue(sides, corners) == pytest.approx(2 * (1 + 1 / 4))
        assert bounds.largest_face_eigenvalue(np.ones((1, 3)), corners) == np.inf
    assert bounds.largest_face_eigenvalue(zero, zero) == 0
    assert bounds.largest_face_eigenvalue(np.ones((1, 3)), zero) == np.inf


def test_weights_that_a_callable_made_zero():
    square = Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    for given_weights in ([1, 0, 1, 0, 1], [0, 0, 1, 1, 1], [1, 0, 0, 0, 1], [1, 1, 1, 1, 0]):
        pair = laplacian(square, lambda mesh, w=given_weights: w, "degree")
        true = oracle.spectrum(pair.stiffness.toarray(), pair.mass.toarray())[-1]
        assert true <= pair.spectral_bound() + 1e-12 <= 2 + 1e-9


@pytest.mark.parametrize("unit", [1e-100, 1e-70, 1e70, 1e100])
def test_bounds_do_not_overflow(unit):
    mesh = MESHES["closed"]()
    for weights, power in (("cotangent", -2), ("tufted", -2), ("distance", -4)):
        bound = laplacian(mesh, weights, "voronoi").spectral_bound()
        pair = laplacian(mesh.with_vertices(mesh.vertices * unit**0.5), weights, "voronoi")
        assert pair.spectral_bound() == pytest.approx(bound * unit ** (power / 2), rel=1e-9)


def test_needles_stay_below_three_with_the_degree_mass():
    ring = torus(4, 5)  # flattened, its long sides see cotangents that cancel
    for weights in ("cotangent", "intrinsic_delaunay", "tufted"):
        mesh = ring.with_vertices(ring.vertices * [1, 1, 1e-10])
        assert laplacian(mesh, weights, "degree").spectral_bound() <= 3
