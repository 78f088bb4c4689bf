import numpy as np
import pytest
from hypothesis import given, settings

from beltrami.errors import MeshError
from beltrami.mesh.half_edges import BOUNDARY, NOT_MANIFOLD, _paired, pair_sides
from beltrami.mesh.shapes import icosphere
from beltrami.mesh.topology import Topology
from dictionary_of_sides import sides_of
from strategies import any_arrays


def check(faces, n):
    pairing = pair_sides(faces, n)
    expected = sides_of(faces)
    edges = list(expected)
    face_edges = np.full(faces.shape, -1)
    twins = np.full(faces.shape, BOUNDARY)
    disoriented = 0
    for e, sides in enumerate(expected.values()):
        for k, (h, start, _) in enumerate(sides):
            face_edges.flat[h] = e
            if len(sides) == 2:
                twins.flat[h], other, _ = sides[1 - k]
                disoriented += start == other
            elif len(sides) > 2:
                twins.flat[h] = NOT_MANIFOLD
    assert pairing.edges.shape == (len(edges), 2)
    assert list(map(tuple, pairing.edges.tolist())) == edges
    assert np.array_equal(pairing.face_edges, face_edges)
    assert np.array_equal(pairing.twins, twins)
    count = Topology(faces, n).edge_face_count
    assert count.tolist() == [len(sides) for sides in expected.values()]
    assert pairing.n_boundary == sum(len(sides) == 1 for sides in expected.values())
    assert pairing.n_crowded == sum(len(sides) > 2 for sides in expected.values())
    assert pairing.disoriented == disoriented / 2  # each such edge was met from both sides
    assert pairing.complete == all(len(set(face)) == 3 for face in faces.tolist())


@pytest.mark.chapter("P9")
@given(any_arrays())
def test_sides_are_paired_as_a_dictionary_pairs_them(pair):
    vertices, faces = pair
    check(faces, len(vertices))


@pytest.mark.heavy
@settings(max_examples=5000, derandomize=False)
@given(any_arrays())
def test_sides_are_paired_as_a_dictionary_pairs_them_at_length(pair):
    vertices, faces = pair
    check(faces, len(vertices))


def test_any_triples_of_few_vertices():
    rng = np.random.default_rng(8123749817234)
    for n in (1, 2, 3, 4, 6):
        for m in (1, 2, 5, 40):
            check(rng.integers(n, size=(m, 3)), n)


@pytest.mark.parametrize("n", [300, 1000, 6000])
def test_more_edges_on_the_boundary_than_a_disk_has(n):
    """Where the ends of edges have no room before the sides, they are sorted elsewhere."""
    faces = np.random.default_rng(n).integers(n, size=(2000, 3))
    assert _paired(faces.view(np.uint64), n, 10) is None
    check(faces, n)


@pytest.mark.parametrize("n", [5, 9, 60])
def test_room_is_enough_or_said_to_be_too_little(n):
    """An edge may be written up to the first side that is not yet read, and not over it."""
    faces = np.random.default_rng(n).integers(n, size=(30, 3))
    edges = list(sides_of(faces))
    enough = 0
    for room in range(91):
        found = _paired(faces.view(np.uint64), n, room)
        if found is not None:
            enough += 1
            assert list(map(tuple, found.edges.tolist())) == edges
    assert found is not None
    assert enough < 91 or n == 5  # where nearly all edges have more than two faces


@pytest.mark.parametrize("turned", [0.0, 0.001, 0.5])
@pytest.mark.parametrize("removed", [0.0, 0.05, 0.5])
def test_numbers_and_faces_in_any_order(turned, removed):
    """Buckets of all kinds side by side: pairs, few sides with a boundary or turned, many."""
    rng = np.random.default_rng(20261127)
    sphere = icosphere(3).faces
    fan = np.stack([np.zeros(30), np.arange(1, 31), np.arange(2, 32)], axis=1).astype(np.int64)
    faces = np.concatenate([sphere, sphere.max() + 1 + fan, [[0, 1, 1]]])
    n = int(faces.max()) + 4
    faces = rng.permutation(n)[rng.permutation(faces)]
    faces = faces[rng.random(len(faces)) >= removed]
    other = rng.random(len(faces)) < turned
    faces[other] = faces[other, ::-1]
    check(faces, n)
    check(np.concatenate([faces, faces[:9], faces[:5]]), n)  # more than two faces at an edge


def test_a_vertex_of_many_faces():
    """More sides in one bucket than are compared at once: they are sorted."""
    rng = np.random.default_rng(4)
    for valence in (7, 8, 9, 16, 17, 500):
        for centre in (0, valence // 2, valence):
            rim = np.setdiff1d(np.arange(valence + 1), centre)
            faces = np.stack([np.full(valence, centre), rim, np.roll(rim, -1)], axis=1)
            check(rng.permutation(faces), valence + 2)
            check(rng.permutation(faces[:-1]), valence + 2)


def test_no_faces():
    pairing = pair_sides(np.zeros((0, 3), np.int64), 5)
    assert pairing.edges.shape == (0, 2)
    assert pairing.twins.shape == pairing.face_edges.shape == (0, 3)
    assert (pairing.disoriented, pairing.complete) == (0, True)


def test_the_marks_differ():
    assert (BOUNDARY, NOT_MANIFOLD) == (-1, -2)
    fan = pair_sides(np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]]), 5)
    assert fan.twins[:, 2].tolist() == [NOT_MANIFOLD] * 3
    assert (fan.twins[:, :2] == BOUNDARY).all()


def test_disoriented_counts_edges_that_both_faces_run_through_alike():
    same = pair_sides(np.array([[0, 1, 2], [0, 1, 3]]), 4)
    opposite = pair_sides(np.array([[0, 1, 2], [1, 0, 3]]), 4)
    assert (same.disoriented, opposite.disoriented) == (1, 0)


def test_large_indices_do_not_collide():
    n = 3_000_000
    faces = np.array([[0, n - 1, n - 2], [n - 1, 0, 1]])
    pairing = pair_sides(faces, n)
    assert pairing.edges.tolist() == [
        [0, 1], [0, n - 2], [0, n - 1], [1, n - 1], [n - 2, n - 1],
    ]  # fmt: skip
    assert pairing.twins.tolist() == [[-1, -1, 5], [-1, -1, 2]]


def test_numbers_of_more_than_32_bits_are_refused():
    one = np.array([[0, 1, 2]])
    with pytest.raises(MeshError, match="715,827,883 faces and 3 vertices"):
        pair_sides(np.broadcast_to(one, (2**31 // 3 + 1, 3)), 3)
    with pytest.raises(MeshError, match="1 faces and 4,294,967,299 vertices"):
        pair_sides(one, 2**32 + 3)


def test_results_cannot_be_written_into():
    pairing = pair_sides(np.array([[0, 1, 2]]), 3)
    for array in pairing[:3]:
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 7
