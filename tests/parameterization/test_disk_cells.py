"""segment_into_disks: each cell a disk, on any surface."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beltrami.errors import (
    EmptyMeshError,
    MeshError,
    NonFiniteError,
    NotOrientableError,
    UnknownNameError,
    UnreferencedVertexError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cylinder, grid, icosphere, tetrahedron, torus
from beltrami.parameterization.disk_cells import CELL_METHODS, segment_into_disks
from made_once import MadeOnce, creature
from strategies import arrays, hull, moebius, ring_torus, sheet
from surfaces_to_part import is_disk, side_by_side, two_holes

SURFACES = MadeOnce(
    {
        "sphere": icosphere(2),
        "torus": torus(16, 12),
        "genus 2": two_holes(),
        "cylinder": cylinder(16, 5),
        "square": grid(8, 8),
        "blob": lambda: creature(1000),
        "tetrahedron": tetrahedron(),
        "two parts": side_by_side(icosphere(2), torus(12, 8)),
        "triangle": Mesh(np.eye(3), [[0, 1, 2]]),
        "three faces on an edge": Mesh(
            [[0, 0, 0], [0, 0, 1], [1, 0, 0], [-1, 1, 0], [-1, -1, 0]],
            [[0, 1, 2], [0, 1, 3], [0, 1, 4]],
        ),
    }
)


@pytest.mark.chapter("P69")
@pytest.mark.parametrize("method", CELL_METHODS)
@pytest.mark.parametrize("name", SURFACES)
def test_every_cell_is_a_disk(name, method):
    mesh = SURFACES[name]
    for count in (1, 3, 7):
        if count > mesh.n_faces:
            continue
        try:
            cells = segment_into_disks(mesh, count, method=method)
        except NotOrientableError:
            assert name == "three faces on an edge"
            continue
        assert cells.labels.shape == (mesh.n_faces,)
        assert np.unique(cells.labels).tolist() == list(range(cells.count))
        assert all(is_disk(mesh.faces, cells.labels, c) for c in range(cells.count))
        np.testing.assert_allclose(cells.areas.sum(), mesh.area)


@pytest.mark.chapter("P69")
@pytest.mark.parametrize("count", [4, 9, 20])
def test_as_many_cells_as_asked_for_where_that_is_possible(count):
    for name in ("sphere", "torus", "cylinder", "square", "blob"):
        assert segment_into_disks(SURFACES[name], count).count == count


def test_cells_of_a_square_are_as_round_as_those_of_seeds():
    """Each face is nearer to the middle of its cell than the square is wide, and cells alike."""
    mesh = grid(20, 20)
    cells = segment_into_disks(mesh, 9)
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    for cell in range(9):
        own = middles[cells.labels == cell]
        assert np.ptp(own, axis=0).max() < 0.62
    assert cells.areas.max() < 5 * cells.areas.min()


def test_spectral_cells_part_at_the_neck():
    """Two balls that touch in a ring of faces: two clusters, parted there."""
    x = icosphere(4).vertices
    pinched = Mesh(x * (0.25 + np.abs(x[:, :1])), icosphere(4).faces)
    cells = segment_into_disks(pinched, 2, method="spectral")
    side = pinched.vertices[pinched.faces].mean(axis=1)[:, 0] > 0
    assert np.bincount(2 * side + cells.labels).max() < side.size * 0.55
    agreement = (side == cells.labels).mean()
    assert max(agreement, 1 - agreement) > 0.97


@pytest.mark.parametrize("unit", [2.0**-30, 2.0**30])  # no rounding decides a tie
def test_the_unit_of_length_does_not_matter(unit):
    mesh = torus(16, 12)
    big = mesh.with_vertices(mesh.vertices * unit)
    np.testing.assert_array_equal(
        segment_into_disks(mesh, 6).labels, segment_into_disks(big, 6).labels
    )


def test_a_long_strip_does_not_get_cold():
    strip = cylinder(3, 2000, height=2000.0)
    assert segment_into_disks(strip, 8).count == 8


@given(arrays(hull, ring_torus, sheet), st.integers(1, 6))
@settings(max_examples=25)
def test_meshes_nobody_thought_of(pair, count):
    x, faces = pair
    used, local = np.unique(faces, return_inverse=True)
    mesh = Mesh(x[used], local.reshape(-1, 3))
    cells = segment_into_disks(mesh, min(count, mesh.n_faces))
    assert all(is_disk(mesh.faces, cells.labels, c) for c in range(cells.count))


def test_bad_input_is_told():
    ball = icosphere(1)
    for count in (0, -1, ball.n_faces + 1, 2.5):
        with pytest.raises(MeshError, match="the number of cells"):
            segment_into_disks(ball, count)
    with pytest.raises(UnknownNameError, match="farthest"):
        segment_into_disks(ball, 2, method="fartest")
    with pytest.raises(EmptyMeshError):
        segment_into_disks(Mesh(np.zeros((3, 3)), np.zeros((0, 3), int)), 1)
    with pytest.raises(NonFiniteError):
        segment_into_disks(ball.with_vertices(np.where(ball.vertices > 0.9, np.nan, 1.0)), 2)
    with pytest.raises(UnreferencedVertexError):
        segment_into_disks(Mesh(np.eye(4, 3), [[0, 1, 2]]), 1)
    x, faces = moebius(np.random.default_rng(0), 12)
    with pytest.raises(NotOrientableError):
        segment_into_disks(Mesh(x, faces), 2)
