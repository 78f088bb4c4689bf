import copy
import pickle
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import numpy as np
import pytest
from hypothesis import assume, given, settings

from beltrami.errors import (
    DimensionError,
    MeshError,
    NotManifoldError,
    NotOrientableError,
    UnknownNameError,
)
from beltrami.mesh.shapes import cylinder, grid, icosphere, torus
from beltrami.mesh.topology import Topology
from dictionary_of_sides import sides_of
from strategies import any_arrays, closed_meshes, moebius

DERIVED = (
    "boundary_edges",
    "on_boundary",
    "non_manifold_edges",
    "referenced",
    "non_manifold_vertices",
    "inconsistent_edges",
)
TETRAHEDRON = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def strip(n):
    """A Moebius strip of 2 n faces."""
    return Topology(moebius(np.random.default_rng(9182736455), n)[1])


def classes(nodes, pairs):
    """Sets of nodes that the pairs join."""
    groups = [{node} for node in nodes]
    for pair in pairs:
        touched = [g for g in groups if g & set(pair)]
        groups = [g for g in groups if not g & set(pair)] + [set().union(*touched)]
    return groups


# ------------------------------------------------------------------------------ the door


@pytest.mark.parametrize("dtype", ["int8", "uint8", "int32", "uint32", "int64", "uint64", ">i4"])
def test_any_type_of_integers(dtype):
    topology = Topology(TETRAHEDRON.astype(dtype))
    assert topology.faces.dtype == np.int64
    assert topology.faces.tolist() == TETRAHEDRON.tolist()
    assert topology.n_edges == 6


def test_lists_tuples_and_columns_of_fortran_order():
    for faces in (TETRAHEDRON.tolist(), tuple(map(tuple, TETRAHEDRON)), TETRAHEDRON[::-1][::-1]):
        assert np.array_equal(Topology(faces).faces, TETRAHEDRON)
    fortran = Topology(np.asfortranarray(TETRAHEDRON))
    assert fortran.faces.flags.c_contiguous
    assert fortran.twins.tolist() == Topology(TETRAHEDRON).twins.tolist()


@pytest.mark.parametrize(
    "faces",
    [
        [0, 1, 2],
        [[0, 1, 2, 3]],
        [[0, 1]],
        [[[0, 1, 2]]],
        [[0.0, 1.0, 2.0]],
        [[True, False, True]],
        5,
    ],
)
def test_wrong_shapes_and_types_are_named(faces):
    with pytest.raises(DimensionError) as caught:
        Topology(faces)
    given = np.asarray(faces)
    assert str(given.shape) in str(caught.value) or str(given.dtype) in str(caught.value)


def test_rows_of_different_lengths_are_an_error_of_this_library():
    with pytest.raises(MeshError):
        Topology([[0, 1, 2], [0, 1, 2, 3]])


@pytest.mark.parametrize(
    ("faces", "n", "guilty"),
    [
        ([[0, 1, 2], [0, 1, 3], [2, 1, 7]], 3, [1, 2]),
        ([[0, 1, 2], [-1, 1, 2]], 3, [1]),
        ([[-1, 1, 2]], None, [0]),
        (np.array([[0, 1, 2], [0, 1, 2**64 - 1]], np.uint64), 3, [1]),
        ([[0, 0, 0]], 0, [0]),
    ],
)
def test_indices_out_of_range_are_named(faces, n, guilty):
    with pytest.raises(MeshError) as caught:
        Topology(faces, n)
    assert caught.value.faces.tolist() == guilty


def test_the_number_of_vertices_is_the_largest_index_plus_one_or_what_is_said():
    assert Topology([[0, 4, 2]]).n_vertices == 5
    assert Topology([[0, 4, 2]], 9).n_vertices == 9
    assert Topology([]).n_vertices == 0
    assert Topology([], 4).n_vertices == 4


def test_a_negative_number_of_vertices_is_refused():
    with pytest.raises(MeshError):
        Topology([], -1)


def test_writable_faces_are_copied_and_read_only_ones_are_shared():
    faces = TETRAHEDRON.copy()
    topology = Topology(faces)
    faces[0] = 0
    assert topology.faces.tolist() == TETRAHEDRON.tolist()
    assert faces.flags.writeable
    faces = TETRAHEDRON.copy()
    view = faces[:]
    view.flags.writeable = False  # but faces itself can still be written into
    assert not np.shares_memory(Topology(view).faces, faces)
    faces.flags.writeable = False
    assert np.shares_memory(Topology(faces).faces, faces)


# ------------------------------------------------------------------------------ frozen


def test_nothing_can_be_set_or_deleted():
    topology = Topology(TETRAHEDRON)
    for name in ("faces", "n_vertices", "edges", "something"):
        with pytest.raises(AttributeError):
            setattr(topology, name, 1)
    with pytest.raises(AttributeError):
        del topology.faces
    assert topology.n_faces == 4


def test_arrays_cannot_be_written_into():
    topology = Topology(TETRAHEDRON)
    arrays = [topology.faces, topology.edges, topology.face_edges, topology.twins]
    arrays += [getattr(topology, name) for name in DERIVED]
    for array in arrays:
        assert not array.flags.writeable


def test_what_is_cached_cannot_be_spoilt():
    """Whoever got a cached array and writes into it must not change later answers."""
    topology = Topology(TETRAHEDRON)
    cached = [*topology.fans, topology.adjacency.data, topology.vertex_faces.indices]
    cached += [topology.edge_faces.data, topology.orientation]
    for array in cached:
        assert array is not None
        assert not array.flags.writeable


def test_pickles_and_copies_hold_the_same_and_are_frozen():
    topology = Topology(TETRAHEDRON, 6)
    assert topology.n_edges == 6
    for other in (pickle.loads(pickle.dumps(topology)), copy.deepcopy(topology)):  # noqa: S301
        assert np.array_equal(other.faces, topology.faces)
        assert other.n_vertices == 6
        assert not other.faces.flags.writeable
        assert "half_edges" not in vars(other)  # what is derived is not stored


def test_many_threads_get_the_same_answers():
    faces = torus(40, 30).faces
    expected = Topology(faces, 1200)
    names = ("edges", "twins", "boundary_loops", "genus", "n_components", "is_manifold")
    names += ("orientation", "adjacency", "edge_faces", "vertex_faces", "is_bipartite")
    shared = Topology(faces, 1200)
    start = Barrier(8)

    def ask(i):
        start.wait()
        order = np.random.default_rng(661298341 + i).permutation(len(names))
        return {names[k]: getattr(shared, names[k]) for k in order}

    with ThreadPoolExecutor(8) as pool:
        answers = list(pool.map(ask, range(8)))
    for answer in answers:
        for name in names:
            value, right = answer[name], getattr(expected, name)
            if hasattr(right, "toarray"):
                assert (value != right).nnz == 0
            else:
                assert np.array_equal(value, right)


# ------------------------------------------------------------------------------ edges


@pytest.mark.chapter("U2", "U3")
@given(any_arrays())
def test_edges_by_a_dictionary(pair):
    vertices, faces = pair
    topology = Topology(faces, len(vertices))
    found = sides_of(faces)

    def those(keep):
        return [list(edge) for edge, sides in found.items() if keep([i for _, i, _ in sides])]

    assert topology.edges.tolist() == those(lambda starts: True)
    assert topology.boundary_edges.tolist() == those(lambda starts: len(starts) == 1)
    ends = sorted({v for edge in those(lambda starts: len(starts) == 1) for v in edge})
    assert np.flatnonzero(topology.on_boundary).tolist() == ends
    assert topology.non_manifold_edges.tolist() == those(lambda starts: len(starts) > 2)
    wrong = those(lambda starts: len(starts) == 2 and starts[0] == starts[1])
    assert sorted(topology.inconsistent_edges.tolist()) == wrong
    assert topology.half_edges.disoriented == len(wrong)
    assert topology.is_oriented == (not wrong)
    assert topology.is_closed == (bool(found) and all(len(sides) > 1 for sides in found.values()))
    assert topology.is_edge_manifold == all(len(sides) < 3 for sides in found.values())


@given(any_arrays())
def test_edge_faces_by_membership(pair):
    vertices, faces = pair
    topology = Topology(faces, len(vertices))
    expected = np.zeros((topology.n_edges, len(faces)))
    for e, edge in enumerate(topology.edges.tolist()):
        for f, face in enumerate(faces.tolist()):
            expected[e, f] = len(set(face)) == 3 and set(edge) <= set(face)
    assert np.array_equal(topology.edge_faces.toarray(), expected)


@given(any_arrays())
def test_side_c_is_opposite_corner_c(pair):
    vertices, faces = pair
    topology = Topology(faces, len(vertices))
    for f, c in np.argwhere(topology.face_edges >= 0).tolist():
        edge = topology.edges[topology.face_edges[f, c]]
        assert set(edge.tolist()) == {*faces[f].tolist()} - {faces[f, c]}
        twin = topology.twins[f, c]
        if twin >= 0:
            assert topology.twins.ravel()[twin] == 3 * f + c
            assert topology.face_edges.ravel()[twin] == topology.face_edges[f, c]


@given(any_arrays())
def test_referenced_vertices(pair):
    vertices, faces = pair
    named = set(faces.ravel().tolist())
    topology = Topology(faces, len(vertices))
    assert topology.referenced.tolist() == [v in named for v in range(len(vertices))]


# ------------------------------------------------------------------------------ rings


@pytest.mark.parametrize("i", [-1, 4, 10**9])
def test_there_is_no_such_vertex(i):
    topology = Topology(TETRAHEDRON)
    for call in (topology.ring, topology.face_ring):
        with pytest.raises(MeshError, match=f"no vertex {i}"):
            call(i)


def test_a_ring_of_a_negative_radius_is_refused():
    with pytest.raises(MeshError):
        Topology(TETRAHEDRON).ring(0, -1)


# ------------------------------------------------------------------------------ components


def check_components(faces, n):
    """Whole faces are labelled alike exactly if they are joined; those twice a vertex are not."""
    topology = Topology(faces, n)
    whole = [f for f, face in enumerate(faces.tolist()) if len(set(face)) == 3]
    nodes = [("f", f) for f in whole]
    at_vertex = [{("f", f) for f in whole if v in faces[f]} for v in range(n)]
    by_vertex = classes(nodes, [pair for pair in at_vertex if pair])
    found = sides_of(faces)
    at_edge = [{("f", f) for f in whole if set(e) <= set(faces[f].tolist())} for e in found]
    by_edge = classes(nodes, [group for group in at_edge if group])
    for through, expected in (("vertices", by_vertex), ("edges", by_edge)):
        labels = topology.components(through)
        assert labels.shape == (len(faces),)
        assert labels.dtype == np.int64
        groups = {}
        for f in whole:
            groups.setdefault(int(labels[f]), set()).add(("f", f))
        assert sorted(map(sorted, groups.values())) == sorted(map(sorted, expected))
        order = list(dict.fromkeys(labels.tolist()))
        assert order == sorted(order)  # numbered in the order of their first faces
    return topology, by_vertex


@given(any_arrays())
def test_components_through_vertices_and_through_edges(pair):
    vertices, faces = pair
    whole = faces[[len(set(face)) == 3 for face in faces.tolist()]]
    topology, expected = check_components(whole, len(vertices))
    assert topology.n_components == len(expected)
    if len(whole):
        assert topology.components().min() == 0
        assert topology.components().max() == len(expected) - 1


@given(any_arrays())
def test_faces_that_name_a_vertex_twice_make_no_component(pair):
    vertices, faces = pair
    topology, expected = check_components(faces, len(vertices))
    assert topology.n_components == len(expected)


def test_a_face_that_names_a_vertex_twice_joins_nothing():
    faces = np.concatenate([TETRAHEDRON, TETRAHEDRON + 4, [[0, 0, 4]]])
    topology = Topology(faces)
    assert topology.n_components == 2
    assert topology.genus == 0


def test_components_of_two_bodies_and_a_pinch():
    two = Topology(np.concatenate([TETRAHEDRON + 4, TETRAHEDRON]))
    assert two.components().tolist() == [0] * 4 + [1] * 4
    pinched = np.concatenate([TETRAHEDRON, np.where(TETRAHEDRON == 0, 0, TETRAHEDRON + 3)])
    assert Topology(pinched).n_components == 1
    assert Topology(pinched).components("edges").tolist() == [0] * 4 + [1] * 4


def test_components_through_something_unknown():
    with pytest.raises(UnknownNameError):
        Topology(TETRAHEDRON).components("edge")


# ------------------------------------------------------------------------------ Euler and genus


@given(any_arrays())
def test_euler_characteristic_by_counting(pair):
    vertices, faces = pair
    whole = faces[[len(set(face)) == 3 for face in faces.tolist()]]
    chi = len(set(whole.ravel().tolist())) - len(sides_of(whole)) + len(whole)
    assert Topology(whole, len(vertices)).euler_characteristic == chi


@given(any_arrays())
def test_the_genus_of_each_component_is_a_whole_number_and_adds_up(pair):
    vertices, faces = pair
    topology = Topology(faces, len(vertices))
    assume(topology.is_manifold and topology.is_orientable)
    whole = faces[[len(set(face)) == 3 for face in faces.tolist()]]
    total = 0
    for label in set(Topology(whole).components().tolist()):
        part = Topology(whole[Topology(whole).components() == label])
        chi = len(set(part.faces.ravel().tolist())) - len(sides_of(part.faces)) + part.n_faces
        twice = 2 - len(part.boundary_loops) - chi
        assert twice >= 0
        assert twice % 2 == 0
        total += twice // 2
    assert topology.genus == total


@given(closed_meshes())
def test_genus_of_hulls_and_tori(mesh):
    assert mesh.is_closed
    assert mesh.is_manifold
    assert mesh.is_oriented
    assert mesh.genus == 1 - mesh.euler_characteristic // 2
    assert mesh.euler_characteristic in (0, 2)


def test_genus_of_known_surfaces():
    one = torus(5, 4)
    two = np.concatenate([one.faces, one.faces + 20])
    assert (one.euler_characteristic, one.genus) == (0, 1)
    assert (Topology(two).n_components, Topology(two).genus) == (2, 2)
    # a face of each is taken out and the two borders are glued, one run backwards: genus 2
    glue = np.arange(40)
    glue[one.faces[-1] + 20] = one.faces[0][[0, 2, 1]]
    double = Topology(glue[np.concatenate([one.faces[1:], one.faces[:-1] + 20])])
    assert (double.n_components, double.is_closed, double.is_manifold) == (1, True, True)
    assert (double.euler_characteristic, double.genus) == (-2, 2)
    for opened, genus in ((cylinder(6, 2), 0), (grid(3, 3), 0)):
        assert opened.genus == genus
    punctured = Topology(one.faces[1:])
    assert (punctured.genus, len(punctured.boundary_loops)) == (1, 1)
    assert icosphere(1).genus == 0


def test_the_genus_of_what_has_none():
    with pytest.raises(NotManifoldError) as caught:
        _ = Topology([[0, 1, 2], [0, 1, 3], [0, 1, 4]]).genus
    assert caught.value.edges.tolist() == [[0, 1]]
    assert caught.value.vertices.tolist() == [0, 1]
    with pytest.raises(NotOrientableError):
        _ = strip(7).genus


# ------------------------------------------------------------------------------ orientation


@pytest.mark.chapter("P10")
@pytest.mark.parametrize("n", [5, 6, 9])
def test_a_moebius_strip_has_no_orientation(n):
    topology = strip(n)
    assert topology.is_manifold
    assert not topology.is_orientable
    assert topology.orientation is None
    assert topology.euler_characteristic == 0
    assert [len(loop) for loop in topology.boundary_loops] == [2 * n]


@settings(max_examples=150)
@given(any_arrays())
def test_turning_the_faces_of_the_orientation_orients(pair):
    vertices, faces = pair
    topology = Topology(faces, len(vertices))
    turned = topology.orientation
    assert topology.is_orientable == (turned is not None)
    if turned is None:
        assert not topology.is_oriented
        return
    fixed = Topology(np.where(turned[:, None], faces[:, [0, 2, 1]], faces), len(vertices))
    assert fixed.is_oriented
    assert fixed.orientation is not None
    assert not fixed.orientation.any()
    labels = topology.components("edges")
    for label in set(labels.tolist()):  # the first face of each component is kept
        assert not turned[labels == label][0]


@given(any_arrays())
def test_orientability_does_not_depend_on_turned_faces(pair):
    vertices, faces = pair
    rng = np.random.default_rng(31415926535)
    turned = rng.random(len(faces)) < 0.5
    other = np.where(turned[:, None], faces[:, [0, 2, 1]], faces)
    n = len(vertices)
    assert Topology(faces, n).is_orientable == Topology(other, n).is_orientable


# ------------------------------------------------------------------------------ two colours


@given(any_arrays())
def test_a_mesh_with_a_face_has_no_two_colouring(pair):
    vertices, faces = pair
    whole = any(len(set(face)) == 3 for face in faces.tolist())
    assert Topology(faces, len(vertices)).is_bipartite == (not whole)  # E63


def test_empty():
    for topology in (Topology([]), Topology(np.zeros((0, 3), int), 7), Topology([[]])):
        assert topology.faces.shape == (0, 3)
        assert topology.edges.shape == (0, 2)
        assert topology.boundary_loops == ()
        assert not topology.is_closed
        assert topology.is_manifold
        assert topology.n_components == topology.euler_characteristic == topology.genus == 0
        assert topology.components("edges").tolist() == []


def test_repr():
    assert repr(Topology(TETRAHEDRON, 6)) == "<Topology: 6 vertices, 4 faces>"


def test_a_face_that_names_a_vertex_twice_changes_no_number():
    for extra in ([[0, 0, 4]], [[4, 4, 4], [5, 5, 5]]):
        topology = Topology(np.concatenate([TETRAHEDRON, extra]))
        assert (topology.euler_characteristic, topology.genus, topology.n_components) == (2, 0, 1)


@pytest.mark.parametrize("wrong", ["a", 4.0, np.nan, [4], -1])
def test_the_number_of_vertices_is_a_whole_number(wrong):
    with pytest.raises(MeshError, match="the number of vertices"):
        Topology(TETRAHEDRON, wrong)
