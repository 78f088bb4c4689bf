from collections import Counter

import numpy as np
import pytest
from hypothesis import assume, given

from beltrami.errors import NotManifoldError
from beltrami.mesh.shapes import cylinder, grid, icosphere
from beltrami.mesh.topology import Topology
from dictionary_of_sides import sides_of
from strategies import any_arrays, closed_meshes


def boundary_of(topology):
    """Directed boundary sides {(a, b)} as their faces run them, by counting."""
    sides = [
        (face[c], face[(c + 1) % 3])
        for face in topology.faces.tolist()
        if len(set(face)) == 3
        for c in range(3)
    ]
    times = Counter(frozenset(side) for side in sides)
    return [side for side in sides if times[frozenset(side)] == 1], times


def fan_ends(topology):
    """For each fan with an open end: the boundary sides that end it."""
    root = topology.fans.root.reshape(-1, 3)  # fans have their own test
    ends = {}
    for f, c in np.argwhere(topology.twins == -1).tolist():
        if root[f, 0] >= 0:
            for end in (1, 2):
                fan = int(root[f, (c + end) % 3])
                ends.setdefault(fan, []).append(3 * f + c)
    return ends


def count_loops(ends):
    """Classes of boundary sides that meet in an end of a fan."""
    group = {side: side for pair in ends.values() for side in pair}
    for _ in group:
        for a, b in ends.values():
            group[a] = group[b] = min(group[a], group[b])
    return len(set(group.values()))


@given(any_arrays())
def test_loops_run_through_each_boundary_edge_once(pair):
    vertices, faces = pair
    topology = Topology(faces, len(vertices))
    directed, _ = boundary_of(topology)
    ends = fan_ends(topology)
    if any(len(sides) == 1 for sides in ends.values()):
        with pytest.raises(NotManifoldError) as caught:
            _ = topology.boundary_loops
        on_edge = set(topology.non_manifold_edges.ravel().tolist())
        assert len(caught.value.vertices)
        assert set(caught.value.vertices.tolist()) <= on_edge
        assert "split_non_manifold" in caught.value.remedy
        return
    loops = topology.boundary_loops
    steps = [
        step
        for loop in loops
        for step in zip(loop.tolist(), np.roll(loop, -1).tolist(), strict=True)
    ]
    assert Counter(map(frozenset, steps)) == Counter(map(frozenset, directed))
    assert len(loops) == count_loops(ends)
    for loop in loops:
        assert loop[0] == loop.min()
        assert loop.dtype == np.int64
        assert not loop.flags.writeable
    keys = [(-len(loop), loop[0]) for loop in loops]
    assert keys == sorted(keys)
    if topology.is_oriented and topology.is_manifold:
        assert Counter(steps) == Counter(directed)


@given(any_arrays())
def test_a_loop_runs_in_the_direction_of_its_first_face(pair):
    vertices, faces = pair
    topology = Topology(faces, len(vertices))
    assume(topology.is_edge_manifold)
    first_side = {frozenset(edge): sides[0] for edge, sides in sides_of(faces).items()}
    for loop in topology.boundary_loops:
        steps = list(zip(loop.tolist(), np.roll(loop, -1).tolist(), strict=True))
        first = min(steps, key=lambda step: first_side[frozenset(step)])
        assert first == first_side[frozenset(first)][1:]


@given(closed_meshes())
def test_closed_meshes_have_no_loops(mesh):
    assert mesh.boundary_loops == ()


def test_one_triangle():
    (loop,) = Topology([[7, 3, 5]]).boundary_loops
    assert loop.tolist() == [3, 5, 7]
    (loop,) = Topology([[3, 7, 5]]).boundary_loops
    assert loop.tolist() == [3, 7, 5]


def test_a_square_is_run_round_with_the_surface_on_the_left():
    square = grid(4, 3)
    (loop,) = square.boundary_loops
    x, y = square.vertices[loop, :2].T
    signed = (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2
    assert signed == pytest.approx(square.area)


def test_two_loops_of_a_tube_the_longest_first():
    tube = cylinder(7, 2)
    assert [len(loop) for loop in tube.boundary_loops] == [7, 7]
    assert [int(loop[0]) for loop in tube.boundary_loops] == [0, 14]
    longer = np.concatenate([tube.faces[1:]])  # one face less makes its end one edge longer
    assert [len(loop) for loop in Topology(longer, 21).boundary_loops] == [8, 7]


def test_turned_faces_change_neither_the_loops_nor_their_order():
    rng = np.random.default_rng(55120398412)
    tube = cylinder(9, 3)
    turned = rng.random(tube.n_faces) < 0.5
    faces = np.where(turned[:, None], tube.faces[:, [0, 2, 1]], tube.faces)
    loops = Topology(faces, tube.n_vertices).boundary_loops
    for loop, other in zip(tube.boundary_loops, loops, strict=True):
        assert loop.tolist() in (other.tolist(), np.roll(other[::-1], 1).tolist())


def test_loops_that_meet_in_a_vertex_keep_to_their_fans():
    bow_tie = Topology([[0, 1, 2], [0, 3, 4]])
    assert [loop.tolist() for loop in bow_tie.boundary_loops] == [[0, 1, 2], [0, 3, 4]]


def test_two_holes_that_meet_in_a_vertex_make_one_loop():
    """Without two faces that have one vertex in common; each fan there joins the two holes."""
    sphere = icosphere(1)
    holes = [0, next(f for f in range(80) if np.isin(sphere.faces[f], sphere.faces[0]).sum() == 1)]
    (common,) = set(sphere.faces[holes[0]]) & set(sphere.faces[holes[1]])
    (loop,) = Topology(np.delete(sphere.faces, holes, axis=0), 42).boundary_loops
    assert len(loop) == 6
    assert set(loop) == set(sphere.faces[holes].ravel())
    assert Counter(loop.tolist())[int(common)] == 2


def test_a_pinched_vertex_may_come_twice_in_one_loop():
    """A strip of faces whose two ends touch in one vertex only: its boundary is one loop."""
    faces = np.array([[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5], [4, 5, 0]])
    (loop, *rest) = Topology(faces).boundary_loops
    assert not rest
    assert Counter(loop.tolist())[0] == 2
    assert len(loop) == 7


def test_three_faces_on_an_edge_have_no_loops():
    fan = Topology([[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    with pytest.raises(NotManifoldError) as caught:
        _ = fan.boundary_loops
    assert set(caught.value.vertices.tolist()) <= {0, 1}


def test_a_loop_away_from_the_edge_of_three_faces_is_found():
    sphere = icosphere(1).faces
    hole = np.array([f for f in range(len(sphere)) if f != 79])
    extra = np.array([[sphere[0, 0], sphere[0, 1], 42]])  # a fin: its tip is on the boundary
    with pytest.raises(NotManifoldError):
        _ = Topology(np.concatenate([sphere[hole], extra])).boundary_loops
    # a closed bubble on that edge instead: the boundary, elsewhere, is one loop of three
    a, b = sphere[0, :2].tolist()
    bubble = np.array([[a, b, 42], [b, a, 43], [a, 42, 43], [b, 43, 42]])
    topology = Topology(np.concatenate([sphere[hole], bubble]))
    assert topology.non_manifold_edges.tolist() == [sorted((a, b))]
    assert [set(loop.tolist()) for loop in topology.boundary_loops] == [set(sphere[79].tolist())]
