"""Definition 13: the gradient along the edges (E38, E39, E40)."""

import numpy as np
import pytest

from beltrami.errors import NegativeWeightError
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("D13")


@pytest.mark.chapter("U17", "U18", "P30")
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("kind", ["combinatorial", "distance"])
def test_one_row_for_each_edge_from_i_to_j(name, kind):
    mesh = MESHES[name]()
    pair = laplacian(mesh, kind)
    G = pair.gradient
    p, n = len(mesh.edges), mesh.n_vertices
    assert G.shape == (p, n)  # printed: n x p with p = #E, twice as many (E39)
    assert pair.weights.nnz == 2 * p
    f = np.random.default_rng(1380649).normal(size=n)
    i, j = mesh.edges.T
    assert (i < j).all()
    assert np.allclose(G @ f, np.sqrt(pair.edge_weight) * (f[j] - f[i]), rtol=1e-12)
    assert np.abs(G @ np.ones(n)).max() < 1e-14 * abs(G).max()


@pytest.mark.chapter("X5")
@pytest.mark.parametrize("name", IRREGULAR)
def test_with_distance_weights_it_is_the_slope_along_the_edge(name):
    mesh = MESHES[name]()
    slope = np.array([0.3, -2.0, 1.1])[: mesh.dimension]
    i, j = mesh.edges.T
    along = mesh.vertices[j] - mesh.vertices[i]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    G = laplacian(mesh, "distance").gradient
    assert np.allclose(G @ (mesh.vertices @ slope), along @ slope, atol=1e-11)


@pytest.mark.chapter("P30")
def test_the_other_orientation_changes_g_and_not_l():
    pair = laplacian(MESHES["bad"](), "distance")
    signs = np.random.default_rng(28979).choice([-1, 1], size=(len(pair.edges), 1))
    G = pair.gradient.toarray()
    assert np.allclose((signs * G).T @ (signs * G), pair.stiffness.toarray(), rtol=1e-10)


@pytest.mark.parametrize("name", ["obt", "open", "bad", "cur"])
def test_negative_weights_have_no_real_root(name):
    pair = laplacian(MESHES[name]())
    with np.errstate(invalid="ignore"):
        lost = np.isnan(np.sqrt(pair.edge_weight))
    assert lost.any()
    with pytest.raises(NegativeWeightError) as caught:
        _ = pair.gradient
    assert np.array_equal(caught.value.edges, pair.edges[lost])


@pytest.mark.chapter("U17")
@pytest.mark.parametrize("name", MESHES)
def test_the_incidence_runs_the_same_way_for_weights_of_any_sign(name):
    """Without the roots, so that it serves negative weights: f_j - f_i for i < j (E38, E40)."""
    pair = laplacian(MESHES[name]())
    f = np.random.default_rng(1602176634).normal(size=pair.n)
    i, j = pair.edges.T
    assert np.allclose(pair.incidence @ f, f[j] - f[i], atol=1e-14)
    weighted = laplacian(MESHES[name](), "distance")
    roots = np.sqrt(weighted.edge_weight)
    assert np.allclose(weighted.gradient @ f, roots * (weighted.incidence @ f), rtol=1e-12)
