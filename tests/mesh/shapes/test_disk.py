import numpy as np
import pytest

from beltrami.errors import MeshError
from beltrami.mesh.shapes import disk


@pytest.mark.parametrize("rings", [1, 2, 9])
def test_counts_and_topology(survey, rings):
    mesh = disk(rings)
    facts = survey(mesh)
    assert (mesh.n_vertices, mesh.n_faces) == (1 + 3 * rings * (rings + 1), 6 * rings**2)
    assert (facts.euler, facts.boundary_edges, facts.is_manifold) == (1, 6 * rings, True)
    a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    assert ((b - a)[:, 0] * (c - a)[:, 1] > (b - a)[:, 1] * (c - a)[:, 0]).all()


def test_area_converges_at_order_two(survey, rate):
    errors = [np.pi * 4 - survey(disk(rings, 2.0)).area for rings in (5, 10, 20)]
    assert rate(errors) == pytest.approx(2, abs=0.02)


def test_triangles_are_nearly_equilateral(survey):
    assert survey(disk(30)).min_angles.min() > 40


def test_a_turn_by_sixty_degrees_maps_the_mesh_to_itself():
    rings = 5
    mesh = disk(rings)
    turned = [0]
    for k in range(1, rings + 1):  # the numbers after the turn
        turned += list(np.roll(np.arange(6 * k), -k) + 1 + 3 * k * (k - 1))
    turned = np.array(turned)
    c, s = np.cos(np.pi / 3), np.sin(np.pi / 3)
    assert np.allclose(mesh.vertices[turned], mesh.vertices @ np.array([[c, s], [-s, c]]))

    def as_set(faces):
        return {tuple(np.roll(face, -int(np.argmin(face)))) for face in faces.tolist()}

    assert as_set(turned[mesh.faces]) == as_set(mesh.faces)


def test_dimension():
    assert disk(2).vertices.shape == (19, 2)
    assert (disk(2, dimension=3).vertices[:, 2] == 0).all()


@pytest.mark.parametrize("bad", [{"rings": 0}, {"radius": -2.0}, {"dimension": 1}])
def test_bad_parameters(bad):
    with pytest.raises(MeshError, match=next(iter(bad))):
        disk(**bad)
