"""Section 3.1.2: manifold meshes, their boundary, and how to walk over them (E9)."""

import numpy as np
import pytest

from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere
from beltrami.mesh.topology import Topology
from meshes_of_the_errata import MESHES
from strategies import moebius


def _two_tetrahedra():
    """They share vertex 3: closed, with two faces at each edge, and no surface at 3."""
    one = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    return Topology(np.concatenate([one, one + 3]))


def _by_links(topology):
    return topology.is_manifold


def _by_edges(topology):
    """The condition that the text draws from it: at most two faces on each edge."""
    return bool(topology.edge_face_count.max() <= 2)


def _check(test):
    for name in ("closed", "obt", "open", "bad", "cur", "tor", "pl"):
        assert test(MESHES[name]().topology)
    assert not test(MESHES["leaves"]().topology)
    assert not test(_two_tetrahedra())


@pytest.mark.chapter("P10", "U8")
def test_the_edges_alone_do_not_tell_a_manifold():
    _check(_by_links)
    with pytest.raises(AssertionError):
        _check(_by_edges)
    assert _two_tetrahedra().non_manifold_vertices.tolist() == [3]
    assert _two_tetrahedra().euler_characteristic == 3


@pytest.mark.chapter("P10")
@pytest.mark.parametrize(
    ("name", "characteristic", "loops"),
    [("closed", 2, 0), ("obt", 2, 0), ("open", 1, 1), ("bad", 1, 1), ("tor", 0, 0), ("pl", 1, 1)],
)
def test_euler_characteristic_and_boundary(name, characteristic, loops):
    topology = MESHES[name]().topology
    assert topology.euler_characteristic == characteristic
    assert topology.is_closed == (loops == 0)
    assert topology.is_oriented
    assert topology.is_orientable
    assert len(topology.boundary_loops) == loops
    for loop in topology.boundary_loops:
        around = {frozenset(e) for e in zip(loop, np.roll(loop, -1), strict=True)}
        assert around == {frozenset(e) for e in topology.boundary_edges.tolist()}


@pytest.mark.chapter("P10")
def test_a_vertex_is_inside_iff_its_link_is_one_cycle():
    """160 cycles and 32 paths on ``open``; a half disk is no other shape than a disk (E9)."""
    topology = MESHES["open"]().topology
    inside = np.array([len(topology.face_ring(i)) == len(topology.ring(i)) for i in range(192)])
    assert inside.sum() == 160
    assert np.array_equal(np.flatnonzero(~inside), np.unique(topology.boundary_edges))


@pytest.mark.chapter("P10")
def test_a_moebius_strip_is_a_manifold_that_has_no_sides():
    strip = Topology(moebius(np.random.default_rng(0), 9)[1])
    assert strip.is_manifold
    assert not strip.is_orientable
    assert len(strip.boundary_loops) == 1


def _walk(topology, i):
    """The neighbours of i in order: from a half-edge to the next one across its twin."""
    corner = int(np.flatnonzero(topology.faces.ravel() == i)[0])
    ring, start = [], corner
    while True:
        f, c = divmod(corner, 3)
        ring.append(int(topology.faces[f, (c + 1) % 3]))
        side = int(topology.twins[f, (c + 1) % 3])  # across the side from x_{c+2} to i
        if side < 0:
            return ring, False
        f = side // 3
        corner = 3 * f + int(np.flatnonzero(topology.faces[f] == i)[0])
        if corner == start:
            return ring, True


@pytest.mark.chapter("P9")
@pytest.mark.parametrize("name", ["closed", "open", "bad", "tor"])
def test_half_edges_lead_around_a_vertex(name):
    topology = MESHES[name]().topology
    twins = topology.twins.ravel()
    paired = np.flatnonzero(twins >= 0)
    assert np.array_equal(twins[twins[paired]], paired)
    assert (twins[paired] // 3 != paired // 3).all()
    assert np.array_equal(topology.face_edges.ravel()[twins[paired]], _edge(topology, paired))
    for i in range(0, topology.n_vertices, 5):
        ring, closed = _walk(topology, i)
        if not np.isin(i, topology.boundary_edges):
            assert closed
            assert sorted(ring) == topology.ring(i).tolist()
            sides = {frozenset(p) for p in zip(ring, ring[1:] + ring[:1], strict=True)}
            assert sides <= {frozenset(e) for e in topology.edges.tolist()}
        else:
            assert not closed


def _edge(topology, half_edges):
    return topology.face_edges.ravel()[half_edges]


@pytest.mark.chapter("P4", "U5")
@pytest.mark.parametrize("name", ["closed", "open", "bad"])
def test_the_topology_does_not_know_the_positions(name):
    mesh = MESHES[name]()
    alone = Topology(mesh.faces)
    rng = np.random.default_rng(1729)
    elsewhere = Mesh(rng.normal(size=(mesh.n_vertices, 4)), alone)
    assert elsewhere.topology is alone
    assert elsewhere.dimension == 4
    assert np.array_equal(elsewhere.edges, mesh.edges)
    assert elsewhere.euler_characteristic == mesh.euler_characteristic
    assert [loop.tolist() for loop in elsewhere.boundary_loops] == [
        loop.tolist() for loop in mesh.boundary_loops
    ]
    assert abs(alone.adjacency - mesh.topology.adjacency).max() == 0


@pytest.mark.chapter("U6")
def test_the_surface_is_the_union_of_its_triangles():
    assert MESHES["open"]().area == pytest.approx(1, rel=1e-12)
    assert MESHES["bad"]().area == pytest.approx(1, rel=1e-12)  # flips move no part of it
    errors = [4 * np.pi - icosphere(s).area for s in (2, 3, 4)]
    assert min(errors) > 0  # the triangles are inside
    assert np.polyfit(np.log([4, 2, 1]), np.log(errors), 1)[0] == pytest.approx(2, abs=0.05)
