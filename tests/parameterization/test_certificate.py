"""The certificate catches what signs of areas alone let through."""

import numpy as np
import pytest
from hypothesis import given

from beltrami.errors import DimensionError, EmptyMeshError, NonFiniteError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import disk, grid
from beltrami.mesh.topology import Topology
from beltrami.parameterization.certificate import certify
from strategies import planar_meshes


def wound_twice(rings=3, around=12):
    """A strip that runs around twice (as z -> z² does without its origin): locally no fold."""
    t = 4 * np.pi * np.arange(2 * around) / (2 * around - 1) * 0.9
    r = 1 + np.arange(rings)
    x = (r[:, None, None] * np.stack([np.cos(t), np.sin(t)], axis=1)).reshape(-1, 2)
    faces = []
    for i in range(rings - 1):
        for j in range(2 * around - 1):
            a, b = i * 2 * around + j, (i + 1) * 2 * around + j
            faces += [[a, b, b + 1], [a, b + 1, a + 1]]
    return Mesh(x, faces)


@given(planar_meshes())
def test_a_planar_mesh_is_its_own_map(mesh):
    found = certify(mesh.topology, mesh.vertices)
    assert len(found.flipped) == 0
    assert len(found.crossings) == 0


def test_a_disk_passes_and_every_kind_of_damage_is_told():
    mesh = grid(6, 5)
    x = mesh.vertices[:, :2].copy()
    assert certify(mesh.topology, x).is_bijective
    assert certify(mesh, x).is_bijective
    mirrored = certify(mesh.topology, x * [-1, 1])
    assert len(mirrored.flipped) == mesh.n_faces
    assert len(mirrored.turned_loops) == 1
    inside = np.setdiff1d(np.arange(mesh.n_vertices), mesh.boundary_loops[0])
    x[inside[0]] = x.max(axis=0) * 2
    found = certify(mesh.topology, x)
    assert not found.is_bijective
    assert set(found.flipped) <= set(mesh.face_ring(inside[0]))
    assert len(found.flipped)


@pytest.mark.chapter("T21")
def test_a_double_winding_has_positive_areas_and_no_pass():
    """E89: the signs of the areas do not certify a bijection."""
    strip = wound_twice()
    half = Topology(strip.faces[:22], strip.n_vertices)  # of the inner strip, once around
    assert certify(half, strip.vertices).is_bijective
    found = certify(strip.topology, strip.vertices)
    assert len(found.flipped) == 0
    assert len(found.crossings) > 0
    assert not found.is_bijective


def branched(windings):
    """A fan around vertex 0 whose rim winds so often: the map z -> z^windings, at the corners."""
    rim = 12
    t = 2 * np.pi * windings * np.arange(rim) / rim
    x = np.concatenate([[[0, 0]], np.stack([np.cos(t), np.sin(t)], axis=1) * (1 + t[:, None] / 50)])
    faces = [[0, 1 + k, 1 + (k + 1) % rim] for k in range(rim)]
    return Topology(faces), x


def test_a_branch_point_is_caught_by_the_boundary():
    topology, x = branched(1)
    assert certify(topology, x).is_bijective
    topology, x = branched(2)
    found = certify(topology, x)
    assert len(found.flipped) == 0
    assert len(found.crossings) > 0


def test_holes_run_the_other_way():
    """An annulus turned inside out around its hole has two outer loops, or none."""
    mesh = disk(4)
    ring = Mesh(mesh.vertices, np.delete(mesh.faces, mesh.face_ring(0), axis=0))
    used = np.unique(ring.faces)
    number = np.full(mesh.n_vertices, -1)
    number[used] = np.arange(len(used))
    topology = Topology(number[ring.faces])
    x = mesh.vertices[used, :2]
    assert len(topology.boundary_loops) == 2
    assert certify(topology, x).is_bijective
    r2 = (x**2).sum(axis=1)[:, None]
    inverted = certify(topology, x / r2 * [1, -1])  # inside out, and turned back over
    assert len(inverted.flipped) == 0
    assert inverted.is_bijective
    assert len(certify(topology, x / r2).flipped) == topology.n_faces
    assert not certify(topology, x).turned_loops
    inner = r2[:, 0] < 1.5 * r2.min()
    twice = certify(topology, np.where(inner[:, None], x * [-1, 1], x)).turned_loops
    assert len(twice) == 1  # both loops turn left: one too many
    assert set(twice[0]) in ({*topology.boundary_loops[0]}, {*topology.boundary_loops[1]})
    none = certify(mesh, mesh.vertices[:, :2] * [-1, 1]).turned_loops
    assert [set(loop) for loop in none] == [{*mesh.boundary_loops[0]}]


def test_one_component_inside_another():
    small, large = disk(2), disk(2)
    n = small.n_vertices
    both = Topology(np.concatenate([small.faces, large.faces + n]))
    x = small.vertices[:, :2]
    assert certify(both, np.concatenate([x, x + np.array([3, 0])])).is_bijective
    found = certify(both, np.concatenate([x * 0.05 + [0.3, 0.1], x]))
    assert found.nested.tolist() == [[0, 1]]
    assert not found.is_bijective
    side = certify(both, np.concatenate([x * 0.05 + [0.9, 0.9], x]))  # in the box, not in the disk
    assert side.is_bijective


def test_collapsed_faces_count():
    found = certify(Topology([[0, 1, 2]]), np.array([[0.1, 0.1], [0.2, 0.2], [0.4, 0.4]]))
    assert found.flipped.tolist() == [0]


def test_bad_input():
    square = Topology([[0, 1, 2], [0, 2, 3]])
    with pytest.raises(DimensionError):
        certify(square, np.zeros((4, 3)))
    with pytest.raises(DimensionError):
        certify(square, np.zeros(4))
    with pytest.raises(NonFiniteError) as caught:
        certify(square, [[0, 0], [1, np.nan], [1, 1], [0, 1]])
    assert caught.value.vertices.tolist() == [1]
    with pytest.raises(DimensionError, match="Topology is needed"):
        certify([[0, 1, 2]], np.zeros((3, 2)))
    with pytest.raises(EmptyMeshError):
        certify(Topology(np.zeros((0, 3), int), 0), np.zeros((0, 2)))
