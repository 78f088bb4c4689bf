import pickle

import numpy as np
import pytest
from scipy.sparse import csr_array

import dense_oracles as oracle
from beltrami.errors import (
    DimensionError,
    EmptyMeshError,
    MeshError,
    NegativeWeightError,
    NonFiniteError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import edge_weights, weigh_edges
from meshes_of_the_errata import IRREGULAR, MESHES, triangle


@pytest.mark.chapter("X3")
@pytest.mark.parametrize("name", MESHES)
def test_clamped_is_the_cotangent_where_that_is_positive(name):
    mesh = MESHES[name]()
    cotangent, clamped = (weigh_edges(mesh, k) for k in ("cotangent", "clamped"))
    low = cotangent < 1e-3
    assert np.array_equal(clamped[~low], cotangent[~low])
    assert (clamped[low] == 1e-3).all()  # not 0, which lets vertices land on segments (S5)
    pair = laplacian(mesh, "clamped")
    assert np.array_equal(edge_weights(mesh, "clamped").toarray(), pair.weights.toarray())
    assert (pair.weight_kind, pair.mass_kind) == ("clamped", "voronoi")
    assert np.allclose(pair.averaging.sum(axis=1), 1)
    assert abs(pair.gradient.T @ pair.gradient - pair.stiffness).max() < 1e-12 * pair.degrees.max()


@pytest.mark.chapter("X3")
@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_clamping_does_not_depend_on_the_unit(unit):
    mesh = MESHES["bad"]()
    other = weigh_edges(mesh.with_vertices(unit * mesh.vertices), "clamped")
    assert np.allclose(other, weigh_edges(mesh, "clamped"), rtol=1e-9)


@pytest.mark.chapter("P23")
def test_what_clamping_costs():
    """S6: energy of f = x on the square, exact 1, and a spectrum in [0, 2] again."""
    mesh = MESHES["bad"]()
    x = mesh.vertices[:, 0]
    assert laplacian(mesh, "clamped").dirichlet_energy(x) > 2
    assert laplacian(mesh).dirichlet_energy(x) == pytest.approx(1, rel=1e-12)
    largest = {
        kind: np.linalg.eigvalsh(laplacian(mesh, kind).normalized.toarray())[-1]
        for kind in ("cotangent", "clamped")
    }
    assert largest["cotangent"] > 2.5
    assert largest["clamped"] < 2


@pytest.mark.chapter("X3")
@pytest.mark.parametrize("name", IRREGULAR)
def test_weights_of_the_caller(name):
    mesh = MESHES[name]()
    weigh = lambda m: np.exp(-m.edge_lengths)  # noqa: E731
    W = edge_weights(mesh, weigh)
    i, j = mesh.edges.T
    distances = np.linalg.norm(mesh.vertices[i] - mesh.vertices[j], axis=1)
    assert np.allclose(W[i, j], np.exp(-distances), rtol=1e-12)
    assert abs(W - W.T).max() == 0
    pair = laplacian(mesh, weigh)
    assert (pair.weight_kind, pair.mass_kind, pair.domain) == ("given", "degree", mesh)
    assert np.allclose(pair.stiffness.toarray(), oracle.stiffness(W.toarray()), atol=1e-12)
    assert pair.properties.maximum_principle
    assert pair.spectral_bound() <= 2
    area = laplacian(mesh, weigh, "barycentric")
    true = oracle.spectrum(area.stiffness.toarray(), area.mass.toarray())[-1]
    assert true <= area.spectral_bound()
    copy = pickle.loads(pickle.dumps(pair))  # noqa: S301
    assert abs(copy.stiffness - pair.stiffness).max() == 0


@pytest.mark.chapter("X3", "P16")
def test_a_callable_gets_what_was_given_and_is_copied():
    mesh = MESHES["open"]()
    mine = np.ones(len(mesh.edges))
    asked = []
    pair = laplacian(mesh.topology, lambda t: asked.append(t) or mine)
    assert asked == [mesh.topology]
    mine[:] = 7
    assert (pair.edge_weight == 1).all()
    assert mine.flags.writeable
    integers = laplacian(mesh, lambda m: [2] * len(m.edges))
    assert (integers.edge_weight == 2).all()
    for kind in ("combinatorial", "distance", "cotangent"):
        same = laplacian(mesh, lambda m, k=kind: np.maximum(weigh_edges(m, k), 0))
        expected = np.maximum(laplacian(mesh, kind).edge_weight, 0)
        assert np.array_equal(same.edge_weight, expected)


@pytest.mark.chapter("X3")
def test_what_a_callable_may_not_return():
    mesh = MESHES["open"]()
    p = len(mesh.edges)
    for wrong in (np.ones(p + 1), np.ones((p, 1)), 1.0, np.ones(p, complex), ["a"] * p, None):
        with pytest.raises(DimensionError):
            edge_weights(mesh, lambda m, w=wrong: w)
    values = np.ones(p)
    values[[3, 8]] = np.nan, np.inf
    with pytest.raises(NonFiniteError) as caught:
        laplacian(mesh, lambda m: values)
    assert np.array_equal(caught.value.edges, mesh.edges[[3, 8]])
    values[[3, 8]] = -1, -1e-9
    with pytest.raises(NegativeWeightError, match="sparse matrix") as negative:
        laplacian(mesh, lambda m: values)
    assert np.array_equal(negative.value.edges, mesh.edges[[3, 8]])
    values[3] = 1
    with pytest.raises(NegativeWeightError) as negative:
        edge_weights(mesh, lambda m: values)
    assert np.array_equal(negative.value.edges, mesh.edges[[8]])
    alone = (mesh.edges != 5).all(axis=1).astype(float)
    with pytest.raises(MeshError, match="no positive degree") as lonely:
        laplacian(mesh, lambda m: alone)
    assert lonely.value.vertices.tolist() == [5]
    assert laplacian(mesh, lambda m: alone, "unit").degrees[5] == 0
    with pytest.raises(EmptyMeshError):
        edge_weights(Mesh(mesh.vertices, []), lambda m: [])
    broken = triangle(60, 60).with_vertices([[0, 0], [1, np.nan], [0, 1]])
    with pytest.raises(NonFiniteError):
        laplacian(broken, lambda m: np.ones(3))
    with pytest.raises(DimensionError, match="of a Mesh or of a Topology"):
        laplacian(csr_array([[0, 1.0], [1.0, 0]]), lambda m: [1.0])
