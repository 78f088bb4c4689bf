"""Thinning: what stays is a disk with the same boundary, and what went is known ring by ring."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings

from beltrami.mesh.cut import shortest_paths
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import disk, grid, icosphere
from beltrami.mesh.tree_cotree import cut_to_disk
from beltrami.parameterization.thinning import thinned
from made_once import MadeOnce, creature
from strategies import planar_meshes


def less_one(mesh):
    return Mesh(mesh.vertices, mesh.faces[1:])


DISKS = MadeOnce(
    {
        "ball": less_one(icosphere(3)),
        "cut blob": lambda: cut_to_disk(creature(700)).mesh,
        "grid": grid(14, 11),
        "disk": disk(9),
    }
)


def rings(coarse):
    return np.split(coarse.rings, coarse.starts[1:-1])


@pytest.mark.parametrize("name", DISKS)
def test_a_disk_with_the_same_boundary_remains(name):
    mesh = DISKS[name]
    coarse = thinned(mesh, mesh.n_vertices // 4)
    thin = coarse.mesh
    assert thin.n_vertices < 0.5 * mesh.n_vertices
    assert thin.n_vertices - len(thin.edges) + thin.n_faces == 1
    assert thin.topology.is_manifold
    assert thin.topology.is_oriented
    np.testing.assert_array_equal(thin.vertices, mesh.vertices[coarse.kept])
    before, after = mesh.topology.boundary_edges, coarse.kept[thin.topology.boundary_edges]
    assert set(map(tuple, before)) == set(map(tuple, after))


def test_as_many_remain_as_are_asked_for():
    mesh = DISKS["ball"]
    for count in (600, 400, mesh.n_vertices):
        assert thinned(mesh, count).mesh.n_vertices == count


@pytest.mark.parametrize("name", DISKS)
def test_what_went_can_be_put_back(name):
    """Each fills a hole: with the faces of its ring in place of those there, all return."""
    mesh = DISKS[name]
    coarse = thinned(mesh, mesh.n_vertices // 4)
    assert len(coarse.removed) > 100 or name == "grid"
    assert sorted([*coarse.removed, *coarse.kept]) == list(range(mesh.n_vertices))
    faces = {tuple(np.roll(f, -int(np.argmin(f)))) for f in coarse.kept[coarse.mesh.faces].tolist()}
    for v, ring in zip(coarse.removed[::-1], rings(coarse)[::-1], strict=True):
        inside = [f for f in faces if set(f) <= set(ring.tolist())]
        target = [w for w in ring if _fan(w, ring.tolist()) <= set(inside)]
        assert target
        faces -= _fan(target[0], ring.tolist())
        faces |= {_named(v, a, b) for a, b in zip(ring, np.roll(ring, -1), strict=True)}
    assert faces == {_named(*f) for f in mesh.faces.tolist()}


def _named(*face):
    face = [int(v) for v in face]
    turn = face.index(min(face))
    return tuple(face[turn:] + face[:turn])


def _fan(w, ring):
    at = ring.index(w)
    others = ring[at + 1 :] + ring[:at]
    return {_named(w, a, b) for a, b in pairwise(others)}


@pytest.mark.parametrize("mesh", [grid(20, 2), grid(16, 3), disk(9)])
def test_no_edge_comes_to_lead_across_the_boundary(mesh):
    """Its ends would lie on one side of a square, or make a sliver within a circle."""
    coarse = thinned(mesh, int(mesh.topology.on_boundary.sum()))
    before = mesh.edges[mesh.topology.on_boundary[mesh.edges].all(axis=1)]
    rim = coarse.mesh.topology.on_boundary
    after = coarse.kept[coarse.mesh.edges[rim[coarse.mesh.edges].all(axis=1)]]
    assert set(map(tuple, after.tolist())) == set(map(tuple, before.tolist()))


def test_what_is_around_a_short_boundary_stays():
    mesh = less_one(icosphere(4))
    coarse = thinned(mesh, mesh.n_vertices // 4)
    near = set(mesh.faces[np.isin(mesh.faces, mesh.boundary_loops[0]).any(axis=1)].ravel().tolist())
    assert near <= set(coarse.kept.tolist())


def test_around_a_short_boundary_edges_are_short():
    """No edge that is made is longer than a quarter of the way to the boundary."""
    mesh = less_one(icosphere(5))
    coarse = thinned(mesh, mesh.n_vertices // 16)
    distance, _ = shortest_paths(mesh, mesh.boundary_loops[0])
    ends = coarse.kept[coarse.mesh.edges]
    before = set(map(tuple, mesh.edges.tolist()))
    made = np.array([tuple(edge) not in before for edge in ends.tolist()])
    lengths = coarse.mesh.edge_lengths[made]
    far = distance[ends[made]].max(axis=1)
    assert (lengths < 0.5 * far).all()  # who went lay up to an edge farther away
    assert lengths[far < 1].mean() < 0.7 * lengths[far > 2].mean()


def test_the_tip_of_a_spike_stays():
    flat = grid(15, 15)
    x = np.column_stack([flat.vertices[:, :2], np.zeros(flat.n_vertices)])
    tip = int(np.argmin(np.linalg.norm(x - x.mean(axis=0), axis=1)))
    x[tip, 2] = 5.0
    spiky = Mesh(x, flat.faces)
    first = np.concatenate([[tip], np.delete(np.arange(len(x)), tip)])  # its turn comes first
    number = np.argsort(first)
    one, other = (
        first[thinned(Mesh(mesh.vertices[first], number[mesh.faces]), 200).kept]
        for mesh in (spiky, flat)
    )
    assert tip in one
    assert tip not in other


@pytest.mark.parametrize("name", ["cut blob", "grid", "disk"])
def test_no_two_neighbours_go_in_a_pass(name):
    """Numbers ascend in the first pass; the ring of who goes is what its neighbours are then."""
    mesh = DISKS[name]
    coarse = thinned(mesh, mesh.n_vertices // 3)
    first = 1 + int(np.argmax(np.diff(coarse.removed) < 0))
    assert mesh.n_vertices / 20 < first < len(coarse.removed)
    around = np.concatenate(rings(coarse)[:first])
    assert not np.isin(around, coarse.removed[:first]).any()


@pytest.mark.parametrize("unit", [2.0**-30, 2.0**30])
def test_the_unit_does_not_matter(unit):
    mesh = DISKS["cut blob"]
    one, other = (thinned(Mesh(u * mesh.vertices, mesh.faces), 250) for u in (1.0, unit))
    np.testing.assert_array_equal(one.removed, other.removed)


@given(planar_meshes())
@settings(max_examples=15)
def test_meshes_nobody_thought_of_stay_planar_surfaces(mesh):
    """In the plane areas tell whether something was turned over, or lies twice."""
    coarse = thinned(mesh, mesh.n_vertices // 3)
    assert coarse.mesh.topology.is_manifold
    assert len(coarse.removed) == mesh.n_vertices - coarse.mesh.n_vertices
    euler = [m.n_vertices - len(m.edges) + m.n_faces for m in (mesh, coarse.mesh)]
    assert euler[0] == euler[1]
