"""Section 3.1.2: edges, faces, and the matrices that store them (E4, E5, E19)."""

from itertools import combinations, permutations

import numpy as np
import pytest

from beltrami.errors import UnreferencedVertexError
from beltrami.mesh.diagnose import diagnose
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import MESHES

READINGS = {
    "once": lambda f: [tuple(f)],
    "rotations": lambda f: [tuple(np.roll(f, k)) for k in range(3)],
    "unordered": lambda f: list(permutations(f)),
}


def _thirds(topology, reading):
    """{k; (i, j, k) in F} for each ordered edge, with the faces read in one of three ways."""
    thirds = {(i, j): set() for a, b in topology.edges.tolist() for i, j in ((a, b), (b, a))}
    for face in topology.faces.tolist():
        for i, j, k in READINGS[reading](face):
            thirds[int(i), int(j)].add(int(k))
    return thirds


@pytest.mark.chapter("U2", "U3", "U17")
@pytest.mark.parametrize("name", MESHES)
def test_edges_are_the_sides_of_the_faces_in_one_order(name):
    topology = MESHES[name]().topology
    sides = {frozenset(p) for f in topology.faces.tolist() for p in combinations(f, 2)}
    edges = [tuple(e) for e in topology.edges.tolist()]
    assert {frozenset(e) for e in edges} == sides
    assert len(set(edges)) == len(sides) == topology.n_edges  # each once
    assert all(i < j for i, j in edges)
    oriented = set(zip(*topology.adjacency.nonzero(), strict=True))
    assert oriented == {*edges, *((j, i) for i, j in edges)}
    assert len(oriented) == 2 * topology.n_edges


@pytest.mark.chapter("U4", "U8")
@pytest.mark.parametrize("name", ["closed", "open", "bad", "cur"])
def test_both_conditions_on_the_faces_need_unordered_faces(name):
    """Of three readings of F only one meets what is said of it, on an open mesh (E4)."""
    topology = MESHES[name]().topology
    counts = {r: [len(k) for k in _thirds(topology, r).values()] for r in READINGS}

    def check(reading):
        assert min(counts[reading]) >= 1  # no isolated edge
        assert max(counts[reading]) == 2  # "at most two" says something

    check("unordered")
    for wrong in ("once", "rotations"):
        with pytest.raises(AssertionError):
            check(wrong)
    b = len(topology.boundary_edges)
    assert counts["rotations"].count(0) == b
    assert counts["unordered"].count(1) == 2 * b
    faces = topology.edge_face_count
    assert sorted(np.repeat(faces, 2)) == sorted(counts["unordered"])
    assert not len(topology.non_manifold_edges)


@pytest.mark.chapter("U8")
def test_a_third_face_on_an_edge_is_told():
    topology = MESHES["leaves"]().topology
    assert topology.non_manifold_edges.tolist() == [[0, 1]]
    assert max(len(k) for k in _thirds(topology, "unordered").values()) == 3


@pytest.mark.chapter("U4")
@pytest.mark.parametrize("name", ["closed", "open"])
def test_an_isolated_vertex_is_told_and_would_have_no_degree(name):
    mesh = MESHES[name]()
    more = Mesh(np.concatenate([mesh.vertices, mesh.vertices[:1] + 0.5]), mesh.faces)
    assert more.topology.edges.tolist() == mesh.topology.edges.tolist()
    assert diagnose(more).unreferenced_vertices.tolist() == [mesh.n_vertices]
    assert not more.topology.adjacency.sum(axis=1)[-1]
    with pytest.raises(UnreferencedVertexError):
        laplacian(more, "combinatorial")


@pytest.mark.chapter("P5")
@pytest.mark.parametrize("name", MESHES)
def test_powers_of_the_adjacency_matrix_count_triangles(name):
    """Those of the graph, which may be more than the faces: (0, 1) is in all three leaves."""
    topology = MESHES[name]().topology
    A = topology.adjacency
    assert A.nnz == 2 * topology.n_edges
    assert abs(A - A.T).max() == 0
    near = {i: set(topology.ring(i).tolist()) for i in range(topology.n_vertices)}
    triangles = sum(len(near[i] & near[j]) for i, j in topology.edges.tolist()) / 3
    assert (A @ A @ A).trace() / 6 == triangles >= topology.n_faces


@pytest.mark.chapter("P6")
@pytest.mark.parametrize("name", ["closed", "open", "leaves"])
def test_the_face_matrix_gives_the_edges_back(name):
    """A_F is 3 x m and counts from one; its columns are the faces (E5)."""
    topology = MESHES[name]().topology
    A_F = topology.faces.T + 1
    assert A_F.shape == (3, topology.n_faces)

    def check(column):
        faces = [[A_F[column(c, i)] - 1 for c in range(3)] for i in range(topology.n_faces)]
        again = Topology(faces, topology.n_vertices)
        assert abs(again.adjacency - topology.adjacency).max() == 0

    check(lambda c, i: (c, i))
    with pytest.raises((IndexError, AssertionError)):
        check(lambda c, i: (i, c))  # as printed
    incidence = abs(laplacian(topology).incidence)  # the other name that is mixed up there
    D = np.diag(topology.adjacency.sum(axis=1))
    assert np.array_equal((incidence.T @ incidence).toarray(), D + topology.adjacency.toarray())
