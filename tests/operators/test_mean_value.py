import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import dense_oracles as oracle
from beltrami.errors import (
    DegenerateFaceError,
    DimensionError,
    EmptyMeshError,
    MeshError,
    NonFiniteError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from beltrami.operators.mean_value import mean_value_weights
from beltrami.operators.weights import edge_weights
from meshes_of_the_errata import IRREGULAR, MESHES, flipped, triangle

pytestmark = pytest.mark.chapter("X3")


def _dense(mesh):
    """From the definition: the angles at i beside the edge, by the arc cosine."""
    W = np.zeros((mesh.n_vertices,) * 2)
    angles = oracle.angles(mesh)
    for f, face in enumerate(mesh.faces):
        for c in range(3):
            i = face[c]
            for j in (face[c - 1], face[c - 2]):
                length = np.linalg.norm(mesh.vertices[i] - mesh.vertices[j])
                W[i, j] += np.tan(angles[f, c] / 2) / length
    return W


@pytest.mark.parametrize("name", MESHES)
def test_against_angles(name):
    mesh = MESHES[name]()
    W = edge_weights(mesh, "mean_value")
    assert np.allclose(W.toarray(), _dense(mesh), rtol=1e-8)
    assert W.has_sorted_indices
    assert W.nnz == 2 * len(mesh.edges)
    assert W.data.min() > 0
    i, j = mesh.edges.T
    assert np.array_equal(mean_value_weights(mesh), np.stack([W[i, j], W[j, i]], axis=1))
    if name != "tor":
        assert abs(W - W.T).max() > 0.1


def _off(W, mesh):
    """How far inner vertices are from the mean of their neighbours, over the square."""
    inner = np.setdiff1d(np.arange(mesh.n_vertices), mesh.topology.boundary_edges)
    mean = (W @ mesh.vertices) / W.sum(axis=1)[:, None]
    return np.abs(mean - mesh.vertices)[inner].max()


@given(st.integers(0, 2**40), st.floats(0.1, 1.0))
def test_linear_precision_with_positive_weights(seed, aspect):
    mesh = flipped(seed, n=20, aspect=aspect)
    assert _off(edge_weights(mesh, "mean_value"), mesh) < 1e-9
    assert edge_weights(mesh, "mean_value").data.min() > 0


def test_other_positive_weights_have_none_nor_the_transpose():
    mesh = MESHES["bad"]()
    assert _off(edge_weights(mesh, "mean_value"), mesh) < 1e-14
    assert _off(edge_weights(mesh, "cotangent"), mesh) < 1e-13
    wrong = edge_weights(mesh, "mean_value").T  # angles at the other end
    for W in (wrong, *(edge_weights(mesh, k) for k in ("combinatorial", "distance", "clamped"))):
        assert _off(W, mesh) > 0.02


@pytest.mark.parametrize("unit", [1e-9, 1e9, 1e-60])
def test_the_unit_is_one_over_length(unit):
    mesh = MESHES["obt"]()
    other = mean_value_weights(mesh.with_vertices(unit * mesh.vertices))
    assert np.allclose(other * unit, mean_value_weights(mesh), rtol=1e-9)


@pytest.mark.parametrize("name", IRREGULAR)
def test_an_isometry_into_more_dimensions_changes_nothing(name):
    mesh = MESHES[name]()
    rotation = np.linalg.qr(np.random.default_rng(83746).normal(size=(5, 5)))[0]
    embedded = mesh.with_vertices(mesh.vertices @ rotation[: mesh.dimension])
    assert np.allclose(mean_value_weights(embedded), mean_value_weights(mesh), rtol=1e-8)


def test_wide_angles_keep_their_digits():
    mesh = triangle(1e-4, 179.9998)
    w = edge_weights(mesh, "mean_value")
    length = np.linalg.norm(mesh.vertices[1] - mesh.vertices[2])
    assert w[1, 2] == pytest.approx(np.tan(np.radians(89.9999)) / length, rel=1e-6)


def test_they_make_no_laplacian():
    with pytest.raises(MeshError, match="not symmetric") as caught:
        laplacian(MESHES["open"](), "mean_value")
    assert "clamped" in caught.value.remedy
    with pytest.raises(MeshError, match="symmetric"):
        laplacian(edge_weights(MESHES["open"](), "mean_value"))


def test_defects_are_named():
    mesh = triangle(60, 60)
    with pytest.raises(DimensionError, match="mean value weights: a Topology has no"):
        edge_weights(mesh.topology, "mean_value")
    with pytest.raises(EmptyMeshError):
        edge_weights(Mesh(mesh.vertices, []), "mean_value")
    with pytest.raises(NonFiniteError):
        edge_weights(mesh.with_vertices([[0, 0], [1, np.nan], [0, 1]]), "mean_value")
    flat = Mesh([[0, 0], [1, 0], [0, 1], [2, 0]], [[0, 1, 2], [0, 1, 3]])
    with pytest.raises(DegenerateFaceError) as guilty:
        edge_weights(flat, "mean_value")
    assert guilty.value.faces.tolist() == [1]
