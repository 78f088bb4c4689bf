"""The inverse of a map: against every face, and back and forth through maps with tiny faces."""

import numpy as np
import pytest

from beltrami.errors import DimensionError, MeshError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cylinder, disk, icosphere, torus
from beltrami.parameterization.location import locator
from beltrami.parameterization.parameterize import parameterize
from meshes_of_the_errata import bad

pytestmark = pytest.mark.chapter("U38", "P70")


def test_against_every_face():
    mesh = bad()
    corners = mesh.vertices[mesh.faces]
    points = np.random.default_rng(0).uniform(-0.2, 1.2, (300, 2))
    faces, inside = locator(corners).locate(points)
    for q, p in enumerate(points):
        u, v, w = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], p - corners[:, 0]
        double = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        b = (w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0]) / double
        c = (u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]) / double
        least = np.minimum(np.minimum(b, c), 1 - b - c)
        assert faces[q] == (least.argmax() if least.max() > 0 else -1)
        if faces[q] >= 0:
            np.testing.assert_allclose(inside[q] @ corners[faces[q]], p, atol=1e-13)
        else:
            assert np.isnan(inside[q]).all()


@pytest.mark.parametrize(
    "mesh",
    [
        torus(16, 10),
        Mesh(icosphere(3).vertices, icosphere(3).faces[1:]),
        cylinder(12, 60, height=60),
    ],
    ids=["torus", "sphere less a triangle", "tube"],
)
@pytest.mark.parametrize("method", ["auto", "free"])
def test_there_and_back(mesh, method):
    psi = parameterize(mesh, method)
    rng = np.random.default_rng(1)
    faces = rng.integers(0, mesh.n_faces, 500)
    inside = rng.dirichlet(np.ones(3), 500)
    points = psi.image(faces, inside)
    found, where = psi.original(points)
    np.testing.assert_array_equal(found, faces)
    np.testing.assert_allclose(where, inside, atol=1e-6)
    # and the function on the surface that these coordinates are of
    back = np.einsum("qc,qci->qi", where, mesh.vertices[mesh.faces[found]])
    truth = np.einsum("qc,qci->qi", inside, mesh.vertices[mesh.faces[faces]])
    np.testing.assert_allclose(back, truth, atol=1e-5)


def test_vertices_and_sides_belong_to_a_face():
    mesh = disk(6)
    faces, inside = locator(mesh.vertices[mesh.faces]).locate(mesh.vertices)
    assert (faces >= 0).all()
    assert np.allclose(inside.max(axis=1), 1)
    np.testing.assert_array_equal(
        mesh.faces[faces, inside.argmax(axis=1)], np.arange(mesh.n_vertices)
    )
    i, j = mesh.edges.T
    faces, _ = locator(mesh.vertices[mesh.faces]).locate((mesh.vertices[i] + mesh.vertices[j]) / 2)
    assert (faces >= 0).all()


def test_one_face_and_no_points():
    corners = np.array([[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]])
    assert locator(corners).locate(np.array([[0.2, 0.2], [1.0, 1.0]]))[0].tolist() == [0, -1]
    assert locator(corners).locate(np.zeros((0, 2)))[1].shape == (0, 3)


def test_bad_input():
    psi = parameterize(disk(2))
    with pytest.raises(DimensionError):
        psi.original(np.zeros((4, 3)))
    with pytest.raises(DimensionError):
        psi.image([0], [[0.5, 0.5]])
    with pytest.raises(MeshError):
        psi.image([99], [[1, 0, 0]])


@pytest.mark.parametrize("method", ["auto", "spectral_conformal"])
def test_functions_there_and_back(method):
    """Linear functions of space are linear on the faces, so nothing is lost on the way."""
    mesh = torus(20, 12)
    psi = parameterize(mesh, method)
    f = mesh.vertices @ [1.0, 2.0, 3.0]
    rng = np.random.default_rng(2)
    faces, inside = rng.integers(0, mesh.n_faces, 300), rng.dirichlet(np.ones(3), 300)
    truth = (inside * f[mesh.faces[faces]]).sum(axis=1)
    points = psi.image(faces, inside)
    np.testing.assert_allclose(psi.evaluate(f, points), truth, atol=1e-9)
    space = psi.evaluate(mesh.vertices, points)  # the surface over the plane
    np.testing.assert_allclose(space @ [1.0, 2.0, 3.0], truth, atol=1e-9)
    outside = psi.uv.max(axis=0) + 1
    assert np.isnan(psi.evaluate(mesh.vertices, [outside])).all()
    np.testing.assert_allclose(psi.evaluate(f, psi.uv), f[psi.vertex_map], atol=1e-9)


def test_functions_on_a_cut_surface_and_on_the_whole_one():
    mesh = torus(10, 6)
    psi = parameterize(mesh)
    f = np.arange(mesh.n_vertices, dtype=float)
    spread = psi.to_map(f)
    assert len(spread) == psi.mesh.n_vertices > mesh.n_vertices
    np.testing.assert_array_equal(psi.from_map(spread), f)
    np.testing.assert_array_equal(psi.to_map(spread), spread)
    both = psi.from_map(np.stack([spread, 2 * spread], axis=1))
    np.testing.assert_array_equal(both, np.stack([f, 2 * f], axis=1))
    copies = np.flatnonzero(psi.vertex_map == psi.vertex_map[-1])
    assert len(copies) > 1
    one = np.zeros(psi.mesh.n_vertices)
    one[-1] = 1
    assert psi.from_map(one)[psi.vertex_map[-1]] == pytest.approx(1 / len(copies))
    for bad_length in (np.zeros(3), 1.0):
        with pytest.raises(DimensionError):
            psi.evaluate(bad_length, [[0.0, 0.0]])
    with pytest.raises(DimensionError):
        psi.from_map(f)
    with pytest.raises(DimensionError):
        psi.evaluate(f, [0.0, 0.0])
