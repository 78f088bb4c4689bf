"""Definition 4: the faces around a vertex, and the surface that they make (E7, E8)."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.mesh.mesh import Mesh
from meshes_of_the_errata import IRREGULAR, MESHES


def _as_printed(topology, _):
    """{(i, j, k) in F; i, j in V}: i is quantified, so this is F."""
    return np.arange(topology.n_faces)


def _first(topology, i):
    return np.flatnonzero(topology.faces[:, 0] == i)


def _ring(topology, i):
    return topology.face_ring(i)


def _check_count(mesh, ring):
    """As many faces as neighbours inside, one less at the boundary; 3 m in all."""
    topology = mesh.topology
    boundary = np.isin(np.arange(topology.n_vertices), topology.boundary_edges)
    around = np.array([len(ring(topology, i)) for i in range(topology.n_vertices)])
    neighbours = np.array([len(topology.ring(i)) for i in range(topology.n_vertices)])
    assert np.array_equal(around, neighbours - boundary)
    assert around.sum() == 3 * topology.n_faces


def _check_area(mesh, ring):
    """Each triangle lies in the rings of its three vertices."""
    areas = oracle.double_areas(mesh) / 2
    around = [areas[ring(mesh.topology, i)].sum() for i in range(mesh.n_vertices)]
    assert sum(around) == pytest.approx(3 * areas.sum(), rel=1e-12)


@pytest.mark.chapter("D4")
@pytest.mark.parametrize("name", IRREGULAR)
def test_how_many(name):
    mesh = MESHES[name]()
    _check_count(mesh, _ring)
    for wrong in (_as_printed, _first):
        with pytest.raises(AssertionError):
            _check_count(mesh, wrong)
    marks = mesh.topology.vertex_faces
    for i in range(mesh.n_vertices):
        assert np.array_equal(np.flatnonzero(marks[[i]].toarray()), mesh.face_ring(i))


@pytest.mark.chapter("U7")
@pytest.mark.parametrize("name", [*IRREGULAR, "leaves"])
def test_the_surface_around_a_vertex(name):
    mesh = MESHES[name]()
    _check_area(mesh, _ring)
    for wrong in (_as_printed, _first):
        with pytest.raises(AssertionError):
            _check_area(mesh, wrong)
    for i in range(0, mesh.n_vertices, 13):
        piece = Mesh(mesh.vertices, mesh.faces[mesh.face_ring(i)])
        assert piece.area == pytest.approx(mesh.face_areas[mesh.face_ring(i)].sum())
        assert (piece.faces == i).any(axis=1).all()
