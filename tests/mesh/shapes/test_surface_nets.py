import itertools

import numpy as np
import pytest

from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes.relaxation import split_quads
from beltrami.mesh.shapes.surface_nets import (
    crossed_cells,
    net_quads,
    net_vertices,
    well_composed,
)


def _ball(size, radius, centre):
    axes = np.arange(size, dtype=float)
    grid = np.stack(np.meshgrid(axes, axes, axes, indexing="ij"), axis=-1)
    return np.linalg.norm(grid - centre, axis=-1) - radius


def test_ball_is_a_closed_sphere_of_the_right_size(survey):
    values = _ball(30, 11.0, (14.3, 14.6, 14.1))
    crossed = crossed_cells(values < 0)
    vertices = net_vertices(values, crossed)
    facts = survey(Mesh(vertices, split_quads(vertices, net_quads(values < 0, crossed))))
    assert (facts.euler, facts.boundary_edges, facts.is_manifold) == (2, 0, True)
    assert facts.volume == pytest.approx(4 / 3 * np.pi * 11**3, rel=0.01)


def test_vertices_are_exact_on_a_plane():
    values = _ball(6, 0.0, (0, 0, 0)) * 0 + np.arange(6)[:, None, None] - 2.25
    assert np.allclose(net_vertices(values, crossed_cells(values < 0))[:, 0], 2.25)


def test_half_of_a_symmetric_shape_ends_on_the_plane(survey):
    axes = np.arange(16, dtype=float)
    x, y, z = np.meshgrid(axes - 7.7, axes - 0.5, axes - 7.4, indexing="ij")
    values = np.sqrt(x**2 + y**2 + z**2) - 5.0
    crossed = crossed_cells(values < 0)
    vertices = net_vertices(values, crossed)
    assert np.allclose(vertices[np.argwhere(crossed)[:, 1] == 0, 1], 0.5)
    faces = split_quads(vertices, net_quads(values < 0, crossed))
    facts = survey(Mesh(vertices, faces))
    assert (facts.euler, facts.is_manifold) == (1, True)
    assert facts.boundary_edges == (np.argwhere(crossed)[:, 1] == 0).sum()


def test_well_composed_noise_makes_a_manifold_and_only_adds_points(survey):
    rng = np.random.default_rng(771_209_341)
    inside = np.zeros((14, 14, 14), dtype=bool)
    inside[3:11, 3:11, 3:11] = rng.random((8, 8, 8)) < 0.2
    repaired = well_composed(inside)
    assert (repaired >= inside).all()
    assert repaired.sum() < repaired[3:11, 3:11, 3:11].size
    results = []
    for solid in (inside, repaired):
        values = np.where(solid, -1.0, 1.0)
        crossed = crossed_cells(solid)
        vertices = net_vertices(values, crossed)
        results.append(survey(Mesh(vertices, split_quads(vertices, net_quads(solid, crossed)))))
    assert not results[0].is_manifold
    assert results[1].is_manifold
    assert results[1].boundary_edges == 0


@pytest.mark.parametrize("complement", [False, True])
def test_opposite_corners_are_filled(complement):
    for corner in itertools.product((0, 1), repeat=3):
        inside = np.zeros((6, 6, 6), dtype=bool)
        if complement:
            inside[1:5, 2:5, 1:5] = True
        low, high = np.array([2, 3, 2]) + corner, np.array([3, 4, 3]) - corner
        inside[tuple(low)] = inside[tuple(high)] = not complement
        assert well_composed(inside)[2:4, 3:5, 2:4].all()


def test_the_mirror_image_is_kept():
    inside = np.random.default_rng(90_071_553).random((8, 8, 8)) < 0.1
    inside[:, 0] = inside[:, 1]
    repaired = well_composed(inside)
    assert np.array_equal(repaired[:, 0], repaired[:, 1])
