"""Cells: they hang together, are disks, have short borders; joined where that makes a disk."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cylinder, grid, icosphere, torus
from beltrami.parameterization.cells import (
    Neighbours,
    are_disks,
    halved,
    hanging_together,
    into_disks,
    merged,
    smoothed,
)
from surfaces_to_part import is_disk, of_cell


def border(labels, near):
    return near.edges[~near.within(labels)].sum()


@given(st.integers(0, 10**6), st.integers(1, 5))
def test_disks_are_told_from_all_else(seed, count):
    mesh = torus(6, 5)
    rng = np.random.default_rng(seed)
    near = Neighbours.of(mesh)
    labels = hanging_together(rng.integers(0, count, mesh.n_faces), near)
    labels = np.unique(labels, return_inverse=True)[1]
    told = are_disks(mesh.topology, labels)
    assert told.tolist() == [is_disk(mesh.faces, labels, c) for c in range(labels.max() + 1)]


def test_a_cell_that_touches_itself_in_a_vertex_is_no_disk():
    mesh = grid(3, 3)
    around = np.flatnonzero((mesh.faces == 5).any(axis=1))
    labels = np.zeros(mesh.n_faces, np.int64)
    labels[around[:1]] = 1
    across = [f for f in around[1:] if len(set(mesh.faces[f]) & set(mesh.faces[around[0]])) == 1]
    labels[across[0]] = 1
    assert not are_disks(mesh.topology, labels)[1]


@given(st.integers(0, 10**6))
def test_lonely_faces_go_to_neighbours(seed):
    rng = np.random.default_rng(seed)
    a, b = icosphere(1), torus(5, 4)
    mesh = Mesh(
        np.concatenate([a.vertices, b.vertices]), np.concatenate([a.faces, b.faces + a.n_vertices])
    )
    near = Neighbours.of(mesh)
    given_labels = rng.integers(0, 6, mesh.n_faces)
    labels = hanging_together(given_labels, near)
    for cell in np.unique(labels):
        assert of_cell(mesh.faces, labels, cell).components("edges").max() == 0
        kept = given_labels[labels == cell]
        assert np.bincount(kept).max() > 0
    assert len(np.unique(labels)) <= 7  # one for each label, and one for a component without


def test_what_hangs_together_stays():
    mesh = grid(6, 4)
    labels = (mesh.vertices[mesh.faces][..., 0].mean(axis=1) > 0.5).astype(np.int64)
    together = hanging_together(labels, Neighbours.of(mesh))
    assert (np.unique(together, return_inverse=True)[1] == labels).all()


def test_the_longer_common_border_wins():
    mesh = Mesh(
        [[0, 0], [4, 0], [2, 1], [2, -3], [6, 3], [-2, 3]],
        [[0, 1, 2], [1, 0, 3], [1, 4, 2], [0, 2, 5]],
    )
    labels = hanging_together(np.array([0, 0, 1, 2]), Neighbours.of(mesh))
    assert labels[0] == labels[1]
    lonely = hanging_together(np.array([1, 0, 1, 2]), Neighbours.of(mesh))
    assert lonely[0] == lonely[2]
    # face 0 alone, of the cell of a far away face, goes where its longest side leads
    far = Mesh(
        np.concatenate([mesh.vertices, mesh.vertices + 100]),
        np.concatenate([mesh.faces, mesh.faces[1:2] + 6, mesh.faces[:1] + 6]),
    )
    moved = hanging_together(np.array([3, 0, 1, 2, 3, 3]), Neighbours.of(far))
    assert moved[0] == moved[1]


@pytest.mark.parametrize("mesh", [icosphere(2), torus(9, 6), cylinder(8, 6), grid(1, 1)])
def test_halves_hang_together_and_are_smaller(mesh):
    near = Neighbours.of(mesh)
    labels = halved(np.zeros(mesh.n_faces, np.int64), near, np.ones(1, np.bool_))
    assert set(labels) == {0, 1}
    assert 0 < labels.sum() < mesh.n_faces
    for cell in (0, 1):
        assert of_cell(mesh.faces, labels, cell).components("edges").max() == 0


def test_only_chosen_cells_are_halved():
    mesh = grid(6, 4)
    labels = (mesh.vertices[mesh.faces][..., 0].mean(axis=1) > 0.5).astype(np.int64)
    after = halved(labels, Neighbours.of(mesh), np.array([False, True]))
    assert (after[labels == 0] == 0).all()
    assert set(after[labels == 1]) == {1, 2}


@given(st.integers(0, 10**6))
@settings(max_examples=20)
def test_borders_get_shorter_and_cells_stay_together(seed):
    mesh = torus(8, 6)
    near = Neighbours.of(mesh)
    rng = np.random.default_rng(seed)
    labels = hanging_together(rng.integers(0, 4, mesh.n_faces), near)
    after = smoothed(labels, mesh)
    assert border(after, near) <= border(labels, near) + 1e-12
    assert set(after) == set(labels)
    for cell in np.unique(after):
        assert of_cell(mesh.faces, after, cell).components("edges").max() == 0
    assert (smoothed(after, mesh) == after).all()


@given(st.integers(0, 10**6), st.integers(1, 6))
@example(0, 6)  # so many disks are not to be had
@settings(max_examples=20)
def test_joined_disks_are_disks(seed, count):
    mesh = torus(8, 6)
    near = Neighbours.of(mesh)
    labels = np.random.default_rng(seed).integers(0, 5, mesh.n_faces)
    labels = np.unique(hanging_together(labels, near), return_inverse=True)[1]
    disks, _ = into_disks(labels, mesh.topology, near)
    after = merged(disks, mesh, near, count)
    cells = after.max() + 1
    assert are_disks(mesh.topology, after).all()
    assert min(count, len(np.unique(disks))) <= cells <= max(count, len(np.unique(disks)))
    for cell in np.unique(disks):  # cells are joined, not cut
        assert len(np.unique(after[disks == cell])) == 1


def test_two_halves_of_a_sphere_are_not_joined():
    mesh = icosphere(2)
    near = Neighbours.of(mesh)
    labels = (mesh.vertices[mesh.faces].mean(axis=1)[:, 2] > 0.05).astype(np.int64)
    assert are_disks(mesh.topology, labels).all()
    assert (merged(labels, mesh, near, 1) == labels).all()
