import numpy as np
import pytest

from beltrami.errors import MeshError, UnknownNameError
from beltrami.mesh.shapes import grid


@pytest.mark.parametrize("diagonals", ["parallel", "alternating"])
def test_counts_area_and_orientation(survey, diagonals):
    mesh = grid(5, 3, 2.0, 0.5, diagonals=diagonals)
    facts = survey(mesh)
    assert (mesh.n_vertices, mesh.n_faces) == (24, 30)
    assert (facts.euler, facts.boundary_edges, facts.is_manifold) == (1, 16, True)
    a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    signed = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    assert np.allclose(signed, 2.0 * 0.5 / 30)


def test_parallel_diagonals_all_go_up_to_the_right():
    mesh = grid(4, 4)
    e = mesh.vertices[np.roll(mesh.faces, -1, axis=1)] - mesh.vertices[mesh.faces]
    slanted = e[(e != 0).all(axis=2)]
    assert len(slanted) == mesh.n_faces
    assert (slanted.prod(axis=1) > 0).all()


def test_alternating_diagonals_are_mirrored_in_each_neighbour():
    mesh = grid(4, 4, 4, 4, diagonals="alternating")
    valence = np.bincount(mesh.faces.ravel()).reshape(5, 5)
    assert set(valence[1:-1, 1:-1].ravel()) == {4, 8}
    assert np.array_equal(valence, valence[::-1])
    assert np.array_equal(valence, valence[:, ::-1])
    assert valence[0, 0] == 2


def test_dimension_and_numbering():
    flat, spatial = grid(3, 2), grid(3, 2, dimension=3)
    assert flat.vertices.shape == (12, 2)
    assert np.array_equal(spatial.vertices[:, :2], flat.vertices)
    assert (spatial.vertices[:, 2] == 0).all()
    assert np.allclose(flat.vertices[2 + 1 * 4], (2 / 3, 1 / 2))


@pytest.mark.parametrize(
    "bad", [{"nx": 0}, {"ny": 0}, {"width": 0}, {"height": np.nan}, {"dimension": 4}]
)
def test_bad_parameters(bad):
    with pytest.raises(MeshError, match=next(iter(bad))):
        grid(**bad)


def test_unknown_diagonals():
    with pytest.raises(UnknownNameError, match="alternating"):
        grid(diagonals="alternate")
