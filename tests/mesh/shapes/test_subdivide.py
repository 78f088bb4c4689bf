import numpy as np
import pytest

from beltrami.errors import DegenerateFaceError, MeshError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import grid, tetrahedron, torus
from beltrami.mesh.shapes.subdivide import subdivide


def test_children_lie_on_their_face_contiguous_and_oriented():
    mesh = torus(7, 5)
    fine = subdivide(mesh)
    corners = mesh.vertices[mesh.faces]
    a, b, c = corners.transpose(1, 0, 2)
    d, e, f = (b + c) / 2, (c + a) / 2, (a + b) / 2
    expected = np.array([[a, f, e], [f, b, d], [e, d, c], [d, e, f]]).transpose(2, 0, 1, 3)
    assert np.allclose(fine.vertices[fine.faces], expected.reshape(-1, 3, 3), atol=1e-15)
    assert np.array_equal(fine.vertices[: mesh.n_vertices], mesh.vertices)


def test_counts_topology_and_measure(survey):
    mesh = subdivide(tetrahedron(), 3)
    facts = survey(mesh)
    assert mesh.n_vertices == 2 * 64 + 2
    assert (facts.euler, facts.boundary_edges, facts.is_manifold) == (2, 0, True)
    assert facts.volume == pytest.approx(survey(tetrahedron()).volume, rel=1e-13)
    assert survey(subdivide(grid(3, 2), 2)).boundary_edges == 4 * 10


def test_no_steps_is_the_same_mesh():
    mesh = grid(2, 2)
    assert subdivide(mesh, 0) is mesh


def test_data_and_uv_are_interpolated_linearly():
    mesh = grid(3, 2)
    x, y = mesh.vertices.T
    uv = mesh.vertices[mesh.faces] * (2.0, 5.0)
    given = Mesh(mesh.vertices, mesh.faces, {"f": 3 * x - y, "g": np.stack([y, x], 1)}, uv)
    fine = subdivide(given, 2)
    x, y = fine.vertices.T
    assert np.allclose(fine.vertex_data["f"], 3 * x - y)
    assert np.allclose(fine.vertex_data["g"], np.stack([y, x], 1))
    assert np.allclose(fine.corner_uv, fine.vertices[fine.faces] * (2.0, 5.0))


def test_three_faces_at_an_edge_share_its_midpoint():
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, 0]]
    fine = subdivide(Mesh(points, [[0, 1, 2], [0, 1, 3], [0, 1, 4]]))
    assert fine.n_vertices == 5 + 7


def test_refusals():
    with pytest.raises(DegenerateFaceError) as caught:
        subdivide(Mesh(np.eye(3), [[0, 1, 2], [0, 1, 1]]))
    assert caught.value.faces.tolist() == [1]
    with pytest.raises(MeshError, match="steps"):
        subdivide(grid(1, 1), -1)
