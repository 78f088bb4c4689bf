import numpy as np
import pytest

from beltrami.errors import DimensionError, EmptyMeshError, MeshError, NonFiniteError
from beltrami.mesh.mesh import Mesh
from beltrami.operators.differences import edge_derivative
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import MESHES, triangle

pytestmark = pytest.mark.chapter("U15", "X5", "P30")


@pytest.mark.parametrize("name", MESHES)
def test_exact_for_linear_functions_with_its_sign(name):
    mesh = MESHES[name]()
    g = np.random.default_rng(3).normal(size=(mesh.dimension, 2))
    i, j = mesh.edges.T
    along = mesh.vertices[j] - mesh.vertices[i]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    assert np.allclose(edge_derivative(mesh, mesh.vertices @ g), along @ g, atol=1e-9)
    single = edge_derivative(mesh, mesh.vertices @ g[:, 0])
    assert np.allclose(single, along @ g[:, 0], atol=1e-9)


@pytest.mark.parametrize("name", ["closed", "cur"])
def test_it_is_the_gradient_of_distance_weights(name):
    mesh = MESHES[name]()
    f = np.random.default_rng(4).normal(size=mesh.n_vertices)
    G = laplacian(mesh, "distance").gradient
    assert np.allclose(G @ f, edge_derivative(mesh, f), rtol=1e-12)
    for other in ("combinatorial", "clamped"):
        assert not np.allclose(laplacian(mesh, other).gradient @ f, edge_derivative(mesh, f))


def test_turning_an_edge_turns_the_sign():
    mesh = MESHES["open"]()
    order = np.arange(mesh.n_vertices)[::-1]
    turned = Mesh(mesh.vertices[order], order[mesh.faces])
    f = mesh.vertices[:, 0] ** 2
    slope = dict(zip(map(tuple, mesh.edges.tolist()), edge_derivative(mesh, f), strict=True))
    for (i, j), value in zip(turned.edges.tolist(), edge_derivative(turned, f[order]), strict=True):
        assert value == -slope[int(order[j]), int(order[i])]


def test_second_order_at_the_middle_and_first_at_the_ends():
    errors, ends = [], []
    for h in (0.1, 0.05, 0.025):
        mesh = Mesh([[0.3, 0], [0.3 + h, 0], [0.3, h]], [[0, 1, 2]])
        slope = edge_derivative(mesh, np.exp(mesh.vertices[:, 0]))[0]
        errors.append(slope - np.exp(0.3 + h / 2))
        ends.append(slope - np.exp(0.3))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.05)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2, abs=0.05)
    assert np.log2(ends[1] / ends[2]) == pytest.approx(1, abs=0.05)


def test_errors():
    mesh = triangle(60, 60)
    with pytest.raises(DimensionError):
        edge_derivative(mesh, [1.0, 2])
    with pytest.raises(NonFiniteError):
        edge_derivative(mesh, [1.0, 2, np.nan])
    with pytest.raises(NonFiniteError):
        edge_derivative(mesh.with_vertices([[0, 0], [1, np.nan], [0, 1]]), np.ones(3))
    with pytest.raises(EmptyMeshError):
        edge_derivative(Mesh(mesh.vertices, []), np.ones(3))
    with pytest.raises(MeshError, match="Weld their ends") as caught:
        edge_derivative(Mesh([[0, 0], [1, 0], [0, 0]], [[0, 1, 2]]), np.ones(3))
    assert caught.value.edges.tolist() == [[0, 2]]
