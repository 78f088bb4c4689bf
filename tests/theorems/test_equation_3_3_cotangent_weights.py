"""Equation 3.3: the cotangents of the angles that face the edge (E17, E18, E29, E90)."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import edge_weights, weigh_edges
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("Q3.3")


@pytest.mark.parametrize("name", MESHES)
def test_energy_of_the_interpolant(name):
    mesh = MESHES[name]()
    f = mesh.vertices[:, 0]
    exact = oracle.dirichlet_energy(mesh, f)
    assert laplacian(mesh).dirichlet_energy(f) == pytest.approx(exact, rel=1e-10)
    printed_constant = f @ oracle.stiffness(2 * oracle.weights(mesh, "cotangent")) @ f
    assert printed_constant == pytest.approx(2 * exact, rel=1e-8)


@pytest.mark.parametrize("name", IRREGULAR)
def test_the_printed_apex_is_wrong_though_its_row_sums_are_right(name):
    mesh = MESHES[name]()
    right, wrong = (oracle.weights(mesh, "cotangent", apex) for apex in ("opposite", "printed"))
    W = edge_weights(mesh, "cotangent").toarray()
    assert np.allclose(W.sum(axis=1), wrong.sum(axis=1), rtol=1e-9)  # the trap
    assert np.allclose(W, right, rtol=1e-9, atol=1e-9)
    assert np.abs(W - wrong).max() > 1
    assert np.abs(wrong - wrong.T).max() > 1
    f = mesh.vertices[:, 0]
    i, j = mesh.edges.T
    energy = (wrong[i, j] + wrong[j, i]) / 2 @ (f[i] - f[j]) ** 2
    assert energy / oracle.dirichlet_energy(mesh, f) > 1.2


@pytest.mark.parametrize("name", ["open", "bad"])
def test_a_boundary_edge_has_one_cotangent(name):
    mesh = MESHES[name]()
    x = mesh.vertices[:, 0]
    i, j = mesh.edges.T
    w = weigh_edges(mesh, "cotangent")
    boundary = mesh.topology.edge_face_count == 1
    energy = lambda factor: (w * np.where(boundary, factor, 1)) @ (x[i] - x[j]) ** 2  # noqa: E731
    assert energy(1) == pytest.approx(1, abs=1e-12)
    assert abs(energy(0) - 1) > 0.01  # boundary edges left out
    assert abs(energy(2) - 1) > 0.01  # or counted twice


@pytest.mark.chapter("P23")
def test_other_weights_do_not_give_the_energy():
    mesh = MESHES["open"]()
    x = mesh.vertices[:, 0]
    assert laplacian(mesh, "combinatorial").dirichlet_energy(x) / 2 > 1.05
    assert laplacian(mesh, "distance").dirichlet_energy(x) / 2 > 50


def test_lattices():
    right = edge_weights(MESHES["pl"](), "cotangent").toarray()
    at = lambda i, j: i + 8 * j  # noqa: E731
    assert right[at(3, 3), at(4, 3)] == pytest.approx(1)  # inside
    assert right[at(3, 0), at(4, 0)] == pytest.approx(0.5)  # on the boundary
    assert right[at(3, 3), at(4, 4)] == pytest.approx(0, abs=1e-15)  # the diagonal
    u, v = np.array([1, 0]), np.array([0.5, np.sqrt(3) / 2])
    rhombus = Mesh([0 * u, u, v, u + v], [[0, 1, 2], [1, 3, 2]])
    equilateral = edge_weights(rhombus, "cotangent")
    assert equilateral[1, 2] == pytest.approx(1 / np.sqrt(3))
    assert equilateral[0, 1] == pytest.approx(1 / (2 * np.sqrt(3)))


@pytest.mark.parametrize("name", ["closed", "obt", "open", "bad", "cur"])
def test_negative_where_the_angles_add_to_more_than_pi(name):
    """Obtuse faces are necessary and not sufficient (E90); on the boundary, more than π/2."""
    mesh = MESHES[name]()
    facing = np.bincount(
        mesh.topology.face_edges.ravel(), oracle.angles(mesh).ravel(), len(mesh.edges)
    )
    boundary = mesh.topology.edge_face_count == 1
    expected = facing > np.where(boundary, np.pi / 2, np.pi)
    assert np.array_equal(weigh_edges(mesh, "cotangent") < 0, expected)
    obtuse = (oracle.angles(mesh) > np.pi / 2).any(axis=1).sum()
    assert obtuse > 100
    assert expected.any() == (name != "closed")


@pytest.mark.parametrize("name", IRREGULAR)
def test_degrees_are_positive_whatever_the_signs(name):
    """S1 of the errata: cot B + cot C = sin A / (sin B sin C) > 0 in each face."""
    mesh = MESHES[name]()
    sines = np.sin(oracle.angles(mesh))
    share = sines**2 / sines.prod(axis=1, keepdims=True) / 2
    degrees = np.bincount(mesh.faces.ravel(), share.ravel(), mesh.n_vertices)
    assert (degrees > 0).all()
    assert np.allclose(laplacian(mesh).degrees, degrees, rtol=1e-8)
