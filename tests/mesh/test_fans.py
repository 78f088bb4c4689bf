import numpy as np
import pytest
from hypothesis import given

from beltrami.mesh.fans import group_corners
from beltrami.mesh.half_edges import pair_sides
from beltrami.mesh.shapes import icosphere, tetrahedron
from beltrami.mesh.topology import Topology
from strategies import any_arrays


def fans_of(faces, v):
    """Sets of the whole faces at v, joined across sides (v, w) of exactly two faces."""
    whole = [f for f, face in enumerate(faces.tolist()) if len(set(face)) == 3]
    around = [f for f in whole if v in faces[f]]
    fans = [{f} for f in around]
    for w in {int(w) for f in around for w in faces[f]} - {v}:
        pair = {f for f in around if w in faces[f]}
        if len(pair) == 2:
            touched = [fan for fan in fans if fan & pair]
            fans = [fan for fan in fans if not fan & pair] + [set().union(*touched)]
    return fans


def link_is_path_or_cycle(faces, v):
    """The link test on its definition: degrees at most two, and connected."""
    sides = [set(face) - {v} for face in faces.tolist() if v in face and len(set(face)) == 3]
    points = set().union(*sides) if sides else set()
    if any(sum(p in side for side in sides) > 2 for p in points):
        return False
    reached = {next(iter(points))} if points else set()
    while grown := [side for side in sides if side & reached and not side <= reached]:
        reached = reached.union(*grown)
    return reached == points


@given(any_arrays())
def test_fans_against_sets_of_faces(pair):
    vertices, faces = pair
    n = len(vertices)
    fans = group_corners(faces, pair_sides(faces, n).twins, n)
    root = fans.root.reshape(-1, 3)
    for v in range(n):
        expected = fans_of(faces, v)
        assert fans.of_vertex[v] == len(expected)
        grouped = {}
        for f, c in np.argwhere((faces == v) & (root >= 0)).tolist():
            grouped.setdefault(int(root[f, c]), set()).add(f)
        assert sorted(map(sorted, grouped.values())) == sorted(map(sorted, expected))
        for corner in grouped:  # the representative is one of its own corners
            assert faces.ravel()[corner] == v
            assert root.ravel()[corner] == corner
    twice = np.array([len(set(face)) < 3 for face in faces.tolist()], dtype=bool)
    assert np.array_equal(root < 0, np.repeat(twice[:, None], 3, axis=1))


@pytest.mark.chapter("P10")
@given(any_arrays())
def test_manifold_vertices_are_those_with_a_path_or_a_cycle_as_link(pair):
    vertices, faces = pair
    topology = Topology(faces, len(vertices))
    bad = [v for v in range(len(vertices)) if not link_is_path_or_cycle(faces, v)]
    assert topology.non_manifold_vertices.tolist() == bad
    assert topology.is_manifold == (not bad)


@pytest.mark.chapter("P10")
def test_two_tetrahedra_that_share_a_vertex():
    """E9: at most two faces at each edge, yet no manifold; the Euler characteristic is 3."""
    one = tetrahedron().faces
    other = np.where(one == 0, 0, one + 3)
    topology = Topology(np.concatenate([one, other]))
    assert topology.is_edge_manifold
    assert topology.is_closed
    assert topology.edge_face_count.tolist() == [2] * 12
    assert topology.euler_characteristic == 3
    assert not topology.is_manifold
    assert topology.non_manifold_vertices.tolist() == [0]
    assert topology.fans.of_vertex.tolist() == [2, 1, 1, 1, 1, 1, 1]


def test_one_fan_at_each_vertex_of_a_sphere_and_of_its_half():
    sphere = icosphere(1)
    assert set(sphere.topology.fans.of_vertex.tolist()) == {1}
    half = Topology(sphere.faces[sphere.vertices[sphere.faces].mean(axis=1)[:, 2] > 0])
    assert half.is_manifold
    assert not half.is_closed


def test_two_faces_on_the_same_three_vertices_make_one_fan_at_each():
    pillow = Topology([[0, 1, 2], [0, 2, 1]])
    assert pillow.fans.of_vertex.tolist() == [1, 1, 1]
    assert (pillow.is_closed, pillow.is_oriented, pillow.genus) == (True, True, 0)
