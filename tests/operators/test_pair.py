import pickle

import numpy as np
import pytest
from scipy.sparse import csr_array

import dense_oracles as oracle
from beltrami.errors import (
    DegenerateFaceError,
    DimensionError,
    MeshError,
    NegativeWeightError,
    NonFiniteError,
    UnknownNameError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import MASSES
from meshes_of_the_errata import IRREGULAR, MESHES


@pytest.fixture(params=MASSES)
def pair(request):
    return laplacian(MESHES["bad"](), mass=request.param)


@pytest.mark.chapter("D6")
def test_functions_of_the_pair(pair):
    f = oracle.rough_functions(MESHES["bad"](), 2)
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    g = f[:, 1]
    assert pair.inner(f[:, 0], g) == pytest.approx(f[:, 0] @ B @ g)
    assert pair.inner(f, f) == pytest.approx(np.trace(f.T @ B @ f))
    assert pair.norm(f) == pytest.approx(np.sqrt(np.trace(f.T @ B @ f)))
    assert pair.dirichlet_energy(f) == pytest.approx(np.trace(f.T @ L @ f))
    ones = np.ones(pair.n)
    assert np.allclose(pair.masses, B @ ones)
    assert np.allclose(pair.mean(f), ones @ B @ f / (ones @ B @ ones))
    assert pair.mean(g) == pytest.approx(pair.mean(f)[1])
    if pair.mass_kind == "consistent":
        with pytest.raises(MeshError, match="diagonal mass"):
            pair.apply(f)
    else:
        expected = np.linalg.solve(B, L @ f)
        assert np.allclose(pair.apply(f), expected, rtol=1e-9, atol=1e-9)
        assert np.allclose(pair.apply(g), expected[:, 1], rtol=1e-9, atol=1e-9)


def test_functions_of_the_wrong_shape_or_with_nan_are_refused(pair):
    n = pair.n
    for wrong in (np.zeros(n + 1), np.zeros((3, n)), np.zeros((n, 2, 2)), 1.0):
        for verb in (pair.norm, pair.mean, pair.dirichlet_energy, pair.apply):
            with pytest.raises(DimensionError, match=f"\\({n},\\)"):
                verb(wrong)
    f = np.zeros((n, 2))
    f[[5, 9], 1] = np.nan, np.inf
    with pytest.raises(NonFiniteError) as caught:
        pair.dirichlet_energy(f)
    assert caught.value.vertices.tolist() == [5, 9]


@pytest.mark.chapter("Q3.3")
@pytest.mark.parametrize("name", MESHES)
def test_negative_edges_are_exactly_those_with_a_negative_sum_of_cotangents(name):
    mesh = MESHES[name]()
    pair = laplacian(mesh)
    W = oracle.weights(mesh, "cotangent")[tuple(mesh.edges.T)]
    assert not ((W < -1e-14) & (W > -1e-9)).any()
    negative = mesh.edges[W < -1e-14]  # what is less is zero: opposite a right angle
    assert np.array_equal(pair.properties.negative_edges, negative)
    assert pair.properties.non_negative_weights is (not len(negative))
    for needs in ("averaging", "gradient"):
        if len(negative):
            with pytest.raises(NegativeWeightError) as caught:
                getattr(pair, needs)
            assert np.array_equal(caught.value.edges, negative)
            assert "combinatorial" in str(caught.value)
        else:
            getattr(pair, needs)


def test_properties():
    mesh = MESHES["bad"]()
    cotangent, plain = laplacian(mesh).properties, laplacian(mesh, "combinatorial").properties
    assert (cotangent.linear_precision, plain.linear_precision) == (True, False)
    assert plain.non_negative_weights
    assert cotangent.spectral_bound == laplacian(mesh).spectral_bound()


def test_repr_says_sign_and_factor():
    mesh = MESHES["open"]()
    assert "(cot α + cot β)/2" in repr(laplacian(mesh))
    assert "positive semi-definite" in repr(laplacian(mesh))
    assert "cot α" not in repr(laplacian(mesh, "distance"))
    assert "192 vertices, distance weights, degree mass" in repr(laplacian(mesh, "distance"))


@pytest.mark.parametrize("name", IRREGULAR)
def test_pickles(name):
    pair = laplacian(MESHES[name](), "combinatorial", "barycentric")
    copies = [pickle.loads(pickle.dumps(pair))]  # noqa: S301
    _ = pair.normalized, pair.averaging, pair.gradient, pair.masses
    copies.append(pickle.loads(pickle.dumps(pair)))  # noqa: S301
    for copy in copies:
        assert repr(copy) == repr(pair)
        assert abs(copy.stiffness - pair.stiffness).max() == 0
        assert abs(copy.mass - pair.mass).max() == 0
        assert copy.spectral_bound() == pair.spectral_bound()
        assert abs(copy.gradient - pair.gradient).max() == 0


def test_frozen_and_read_only(pair):
    with pytest.raises(AttributeError):
        pair.stiffness = None
    arrays = (
        pair.edges,
        pair.edge_weight,
        pair.degrees,
        pair.masses,
        pair.properties.negative_edges,
    )
    for array in arrays:
        assert not array.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 7


def test_reading_the_degrees_does_not_depend_on_the_mass(pair):
    mesh = MESHES["bad"]()
    assert np.allclose(pair.degrees, oracle.weights(mesh, "cotangent").sum(axis=1), rtol=1e-8)
    assert (pair.degrees > 0).all()  # S1 of the errata, with 108 negative weights
    lonely = pair.normalized.toarray()
    D = np.diag(pair.degrees**-0.5)
    assert np.allclose(lonely, D @ pair.stiffness.toarray() @ D, atol=1e-12)


def test_weights_have_no_diagonal_and_incidence_any_sign(pair):
    W = pair.weights.toarray()
    assert not W.diagonal().any()
    G0 = pair.incidence.toarray()
    assert np.allclose(G0.T @ np.diag(pair.edge_weight) @ G0, pair.stiffness.toarray(), atol=1e-10)


def test_operators_with_the_inverse_of_d_refuse_a_vertex_without_edges():
    """A graph with the unit mass may have one; then D⁻¹ does not exist (E19)."""
    pair = laplacian(csr_array([[0, 1.0, 0], [1.0, 0, 0], [0, 0, 0]]), mass="unit")
    assert pair.dirichlet_energy([1.0, 0, 5]) == 1
    for needs in ("averaging", "normalized"):
        with pytest.raises(MeshError) as caught:
            getattr(pair, needs)
        assert caught.value.vertices.tolist() == [2]


def test_the_weight_opposite_a_right_angle_is_not_called_negative_for_its_rounding():
    """The same mesh, turned: what is refused must not depend on the frame."""
    mesh = MESHES["pl"]()
    verdicts = []
    for angle in (0.0, 0.1, 0.7, 1.3):
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        pair = laplacian(mesh.with_vertices(mesh.vertices @ turn.T))
        verdicts.append(pair.properties.non_negative_weights)
    assert len(set(verdicts)) == 1


def test_a_graph_has_no_area_masses_and_may_be_indefinite():
    pair = laplacian(csr_array([[0, -1.0], [-1.0, 0]]), mass="unit")
    assert "semi-definite" not in repr(pair)
    with pytest.raises(UnknownNameError, match="degree"):
        pair.spectral_bound("voronoi")


def test_the_bound_with_area_masses_asks_for_areas():
    flat = Mesh([[0, 0], [1, 0], [2, 0]], [[0, 1, 2]])
    with pytest.raises(DegenerateFaceError):
        laplacian(flat, "combinatorial").spectral_bound("voronoi")


def test_an_inner_product_wants_as_many_columns():
    pair = laplacian(MESHES["closed"]())
    f = np.ones(pair.n)
    assert pair.inner(f, f[:, None]) == pair.inner(f, f)
    with pytest.raises(DimensionError, match="as many columns"):
        pair.inner(f, np.ones((pair.n, 2)))


MATRICES = ("stiffness", "mass", "weights", "averaging", "normalized", "incidence", "gradient")


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("weights", ["combinatorial", "tufted"])
def test_the_matrices_are_read_only(weights, mass):
    pair = laplacian(MESHES["closed"](), weights, mass)
    for name in MATRICES:
        matrix = getattr(pair, name)
        for array in (matrix.data, matrix.indices, matrix.indptr):
            assert not array.flags.writeable, name
        with pytest.raises(ValueError, match="read-only"):
            matrix.data[0] = 7
        assert (matrix + matrix.T.T != 2 * matrix).nnz == 0  # and can be used
