"""Lengths around vertices and heights of faces, against loops."""

import numpy as np
import pytest

from beltrami.diffusion.lengths import lengths_around, median_height
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh
from made_once import creature


def test_lengths_are_means_over_the_edges():
    mesh = creature(600)
    x = mesh.vertices * [1, 2, 3]
    found = lengths_around(mesh, x)
    for i in range(0, mesh.n_vertices, 40):
        near = mesh.edges[(mesh.edges == i).any(axis=1)].sum(axis=1) - i
        assert found[i] == pytest.approx(np.linalg.norm(x[near] - x[i], axis=1).mean())


def test_a_vertex_without_edges_has_none():
    mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5]], [[0, 1, 2]])
    assert lengths_around(mesh, mesh.vertices)[3] == 0


def test_the_height_is_the_least_of_a_face_and_half_of_the_faces_have_less():
    square = shapes.grid(5, 5, dimension=3)  # all faces alike, right angles of the sides 1/5
    assert median_height(square) == pytest.approx(0.2 / np.sqrt(2))
    assert median_height(Mesh(square.vertices * [10, 1, 1], square.faces)) < 0.2
    flat = Mesh([[0, 0, 0], [0, 0, 0], [0, 0, 0]], [[0, 1, 2]])
    assert median_height(flat) == np.inf
