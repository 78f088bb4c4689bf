import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltrami.errors import MeshError, UnknownNameError
from beltrami.mesh.rings import RING_KINDS, adjacency_matrix, incident_faces, vertex_ring
from beltrami.mesh.shapes import torus
from beltrami.mesh.topology import Topology
from strategies import any_arrays


def distances(neighbours, i):
    """Breadth first: the number of edges from i to each vertex that can be reached."""
    found, front = {i: 0}, [i]
    for v in front:
        for w in neighbours[v]:
            if w not in found:
                found[w] = found[v] + 1
                front.append(w)
    return found


def ring_of(neighbours, i, s, kind):
    d = distances(neighbours, i)
    if kind == "exact":
        return sorted(v for v in d if d[v] == s)
    if kind == "ball":
        return sorted(v for v in d if 0 < d[v] <= s)
    ends = [i]
    for _ in range(s):
        ends = {w for v in ends for w in neighbours[v]}
    return sorted(ends)


@pytest.mark.chapter("D3", "Q3.2")
@given(any_arrays(), st.integers(1, 4), st.data())
def test_the_three_rings_by_breadth_first_search(pair, s, data):
    vertices, faces = pair
    topology = Topology(faces, len(vertices))
    neighbours = {v: set() for v in range(len(vertices))}
    for face in faces.tolist():
        if len(set(face)) == 3:
            for v in face:
                neighbours[v] |= set(face) - {v}
    i = data.draw(st.integers(0, len(vertices) - 1))
    for kind in RING_KINDS:
        assert topology.ring(i, s, kind).tolist() == ring_of(neighbours, i, s, kind)


@pytest.mark.parametrize("i", [0, 77, 143])
def test_ring_sizes_on_a_six_valent_torus(i):
    topology = torus(12, 12).topology
    sizes = {kind: [len(topology.ring(i, s, kind)) for s in (1, 2, 3)] for kind in RING_KINDS}
    assert sizes == {"exact": [6, 12, 18], "ball": [6, 18, 36], "walk": [6, 19, 37]}  # E6
    assert i in topology.ring(i, 2, "walk")
    assert i not in topology.ring(i, 2, "exact")
    assert i not in topology.ring(i, 2, "ball")


def test_ring_sizes_on_a_four_valent_grid():
    k = 12
    at = np.arange(k * k).reshape(k, k)
    pairs = np.concatenate(
        [np.stack([at, np.roll(at, 1, axis=axis)], axis=-1).reshape(-1, 2) for axis in (0, 1)]
    )
    pairs = np.sort(pairs, axis=1)
    grid = adjacency_matrix(pairs[np.lexsort(pairs.T[::-1])], k * k)
    walk, exact, ball = (vertex_ring(grid, 40, 2, kind) for kind in ("walk", "exact", "ball"))
    assert (len(walk), len(exact), len(ball)) == (9, 8, 12)  # E6: 9 and 8; 13 with the centre
    assert set(walk) == set(exact) | {40}
    assert not set(walk) & set(vertex_ring(grid, 40, 1, "exact"))


def test_rings_are_sorted_integers_of_a_vertex_without_neighbours_too():
    topology = Topology([[0, 1, 2]], 4)
    for kind in RING_KINDS:
        ring = topology.ring(3, 2, kind)
        assert ring.dtype == np.int64
        assert len(ring) == 0
        assert topology.ring(1, 1, kind).tolist() == [0, 2]


def test_unknown_kind():
    with pytest.raises(UnknownNameError) as caught:
        Topology([[0, 1, 2]]).ring(0, 1, "exakt")
    assert caught.value.choices == RING_KINDS
    assert "'exact'" in str(caught.value)


@pytest.mark.chapter("D4")
@given(any_arrays())
def test_incident_faces_by_membership(pair):
    vertices, faces = pair
    n = len(vertices)
    around = incident_faces(faces, n)
    assert around.shape == (n, len(faces))
    member = (faces[None] == np.arange(n)[:, None, None]).any(axis=2)
    assert np.array_equal(around.toarray(), member.astype(float))  # a face counts once
    for i in range(n):
        assert (np.diff(around.indices[around.indptr[i] : around.indptr[i + 1]]) > 0).all()


@pytest.mark.chapter("D4")
def test_face_rings_add_up_to_three_times_the_faces():
    mesh = torus(5, 4)
    rings = [mesh.face_ring(i) for i in range(mesh.n_vertices)]
    assert sum(map(len, rings)) == 3 * mesh.n_faces  # E7
    for i, ring in enumerate(rings):
        assert ring.dtype == np.int64
        assert (mesh.faces[ring] == i).any(axis=1).all()


@pytest.mark.chapter("U2", "P5")
@given(any_arrays())
def test_adjacency_is_symmetric_with_ones_and_no_diagonal(pair):
    vertices, faces = pair
    topology = Topology(faces, len(vertices))
    dense = np.zeros((len(vertices),) * 2)
    for face in faces.tolist():
        if len(set(face)) == 3:
            for a in face:
                for b in face:
                    dense[a, b] = a != b
    assert np.array_equal(topology.adjacency.toarray(), dense)


@pytest.mark.parametrize("wrong", [1.5, "a", None, [1], np.nan, -1, 42, 10**30])
def test_a_vertex_is_a_number_of_one(wrong):
    topology = torus(7, 6).topology
    assert topology.ring(np.int8(41)).tolist() == topology.ring(41).tolist()
    for refused in (topology.ring, topology.face_ring):
        with pytest.raises(MeshError, match="vertex"):
            refused(wrong)


@pytest.mark.parametrize("wrong", [1.5, "a", None, [1], np.nan, -1])
def test_the_radius_of_a_ring_is_a_whole_number(wrong):
    with pytest.raises(MeshError, match="the radius of a ring"):
        torus(7, 6).ring(0, wrong)


def test_rings_beyond_the_mesh_end_at_once():
    topology = torus(7, 6).topology
    assert not len(topology.ring(0, 10**12))
    assert len(topology.ring(0, 10**12, "ball")) == 41
