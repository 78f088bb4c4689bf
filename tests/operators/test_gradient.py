import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.errors import (
    DegenerateFaceError,
    EmptyMeshError,
    NegativeWeightError,
    NonFiniteError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.operators.gradient import (
    edge_gradient,
    face_divergence,
    face_gradient,
    incidence_matrix,
)
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import weigh_edges
from meshes_of_the_errata import IRREGULAR, MESHES


@pytest.mark.chapter("U17")
def test_incidence_goes_from_the_smaller_vertex_to_the_larger():
    G0 = incidence_matrix(np.array([[0, 2], [1, 2]]), 4)
    assert G0.toarray().tolist() == [[-1, 0, 1, 0], [0, -1, 1, 0]]


def test_edge_gradient_refuses_negative_weights_and_names_the_edges():
    edges = np.array([[0, 1], [0, 2], [1, 2]])
    with pytest.raises(NegativeWeightError, match="square roots") as caught:
        edge_gradient(edges, np.array([1.0, -1.0, -2.0]), 3)
    assert caught.value.edges.tolist() == [[0, 2], [1, 2]]
    G = edge_gradient(edges, np.array([4.0, 0.0, 9.0]), 3)
    assert G.toarray().tolist() == [[-2, 2, 0], [0, 0, 0], [0, -3, 3]]


@pytest.mark.parametrize("name", MESHES)
def test_face_gradient_is_exact_for_linear_functions(name):
    mesh = MESHES[name]()
    d = mesh.dimension
    slope = np.array([2.0, -3.0, 0.5])[:d]
    got = (face_gradient(mesh) @ (mesh.vertices @ slope + 7)).reshape(d, mesh.n_faces).T
    p = mesh.vertices[mesh.faces]
    for f in range(mesh.n_faces):  # the part of the slope in the plane of the face
        basis = np.linalg.qr((p[f, 1:] - p[f, 0]).T)[0]
        assert np.allclose(got[f], basis @ (basis.T @ slope), atol=1e-9)


@pytest.mark.chapter("P38")
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_stiffness_is_minus_divergence_of_gradient(name):
    mesh = MESHES[name]()
    L = laplacian(mesh).stiffness.toarray()
    G, div = face_gradient(mesh), face_divergence(mesh)
    assert np.allclose(-(div @ G).toarray(), L, rtol=1e-8, atol=1e-9 * np.abs(L).max())
    assert (weigh_edges(mesh, "cotangent") < 0).any() or name == "closed"
    f = oracle.rough_functions(mesh, 1)[:, 0]
    field = np.random.default_rng(9191).normal(size=G.shape[0])
    areas = np.tile(mesh.face_areas, mesh.dimension)
    assert (areas * field) @ (G @ f) == pytest.approx(-(div @ field) @ f, rel=1e-8)


def test_gradient_in_four_dimensions_keeps_the_energy():
    mesh = MESHES["cur"]()
    rotation = np.linalg.qr(np.random.default_rng(424344).normal(size=(4, 4)))[0]
    lifted = mesh.with_vertices(mesh.vertices @ rotation[:3])
    f = oracle.rough_functions(mesh, 1)[:, 0]
    g = (face_gradient(lifted) @ f).reshape(4, -1)
    assert lifted.face_areas @ (g**2).sum(axis=0) == pytest.approx(
        oracle.dirichlet_energy(mesh, f), rel=1e-8
    )


def test_face_gradient_refuses_what_is_not_sound():
    x = [[0.0, 0], [1, 0], [0, 1], [2, 0]]
    with pytest.raises(EmptyMeshError):
        face_gradient(Mesh(x, []))
    with pytest.raises(DegenerateFaceError) as flat:
        face_divergence(Mesh(x, [[0, 1, 2], [0, 1, 3]]))
    assert flat.value.faces.tolist() == [1]
    with pytest.raises(NonFiniteError):
        face_gradient(Mesh([[0, 0], [1, 0], [np.inf, 1]], [[0, 1, 2]]))
