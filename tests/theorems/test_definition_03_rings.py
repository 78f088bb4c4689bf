"""Definition 3, equations 3.1 and 3.2: rings of vertices, read in three ways (E6)."""

import numpy as np
import pytest
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import shortest_path

from meshes_of_the_errata import MESHES

pytestmark = pytest.mark.chapter("D3", "Q3.1", "Q3.2")
NAMES = ("closed", "obt", "open", "bad", "leaves")


def _distances(topology):
    """(n, n) numbers of edges between the vertices, by scipy."""
    return shortest_path(csr_matrix(topology.adjacency), unweighted=True)


def _printed(topology, i, s):
    """V^(s) = the neighbours of V^(s-1), with V^(1) = V."""
    ring = {i}
    for _ in range(s):
        ring = {int(j) for k in ring for j in topology.ring(k)}
    return sorted(ring)


def _check_exact(topology, ring):
    distance = _distances(topology)
    for i in range(0, topology.n_vertices, 7):
        for s in (1, 2, 3):
            assert list(ring(topology, i, s)) == np.flatnonzero(distance[i] == s).tolist()


def _check_ball(topology, ring):
    distance = _distances(topology)
    for i in range(0, topology.n_vertices, 7):
        for s in (1, 2, 3):
            inside = (distance[i] > 0) & (distance[i] <= s)
            assert list(ring(topology, i, s)) == np.flatnonzero(inside).tolist()


@pytest.mark.parametrize("name", NAMES)
def test_neighbours_are_mutual(name):
    topology = MESHES[name]().topology
    A = np.zeros((topology.n_vertices,) * 2, bool)
    for i in range(topology.n_vertices):
        A[i, topology.ring(i)] = True
    assert np.array_equal(A, A.T)
    assert A.sum() == 2 * topology.n_edges
    assert not A.diagonal().any()
    i, j = topology.edges.T
    assert A[i, j].all()


@pytest.mark.parametrize("name", NAMES[:-1])
def test_the_recursion_as_printed_is_neither_ring_nor_ball(name):
    topology = MESHES[name]().topology
    kinds = {k: (lambda t, i, s, k=k: t.ring(i, s, k)) for k in ("exact", "ball", "walk")}
    _check_exact(topology, kinds["exact"])
    _check_ball(topology, kinds["ball"])
    for wrong in (kinds["ball"], kinds["walk"], _printed):
        with pytest.raises(AssertionError):
            _check_exact(topology, wrong)
    for wrong in (kinds["exact"], kinds["walk"], _printed):  # walks come back to i itself
        with pytest.raises(AssertionError):
            _check_ball(topology, wrong)
    for i in range(0, topology.n_vertices, 11):
        for s in (1, 2, 3):
            assert topology.ring(i, s, "walk").tolist() == _printed(topology, i, s)


def test_the_sizes_on_a_torus_of_six_neighbours():
    """The printed recursion has 19 and 37 vertices where the rings have 12 and 18."""
    topology = MESHES["tor"]().topology
    for i in (0, 100, 359):
        sizes = {k: [len(topology.ring(i, s, k)) for s in (1, 2, 3)] for k in ("exact", "ball")}
        assert sizes == {"exact": [6, 12, 18], "ball": [6, 18, 36]}
        assert [len(_printed(topology, i, s)) for s in (1, 2, 3)] == [6, 19, 37]
        assert i in _printed(topology, i, 2)
        assert i not in _printed(topology, i, 1)
