"""Drawings: regions counted by flooding, every disk without a fold, numbers that are whole."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from beltrami.errors import MeshError, NotADiskError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cylinder, disk, grid, icosphere, torus
from beltrami.mesh.topology import Topology
from beltrami.mesh.tree_cotree import cut_to_disk
from beltrami.parameterization import components, schnyder
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.parameterize import parameterize
from beltrami.parameterization.schnyder import draw
from made_once import MadeOnce, creature
from meshes_of_the_errata import bad, cur
from strategies import arrays, sheet

pytestmark = pytest.mark.chapter("T21")


def tube(around, along):
    mesh = cylinder(around, along, height=along * 2 * np.pi / around, caps=True)
    return Mesh(mesh.vertices, mesh.faces[:-1])


def split(seed, steps):
    """A triangle, divided at random inside its faces: vertices of degree 3, long chords."""
    rng = np.random.default_rng(seed)
    faces = [[0, 1, 2]]
    for v in range(3, 3 + steps):
        a, b, c = faces.pop(int(rng.integers(len(faces))))
        faces += [[a, b, v], [b, c, v], [c, a, v]]
    return Topology(faces)


DISKS = MadeOnce(
    {
        "one triangle": Topology([[0, 1, 2]]),
        "two triangles": Topology([[0, 1, 2], [0, 2, 3]]),
        "fan": Topology([[0, k, k + 1] for k in range(1, 9)]),  # all inner edges are chords
        "grid": grid(7, 5).topology,
        "disk": disk(5).topology,
        "curved": cur().topology,
        "not Delaunay": bad().topology,
        "torus, cut": lambda: cut_to_disk(torus(12, 8)).mesh.topology,
        "sphere less a triangle": Topology(icosphere(2).faces[1:]),
        "blob, cut": lambda: cut_to_disk(creature(1500)).mesh.topology,
        "long tube": tube(6, 300).topology,
        "split": split(0, 200),
    }
)


@pytest.mark.parametrize("name", DISKS)
def test_every_disk_is_drawn_without_a_fold(name):
    disk = DISKS[name]
    x = draw(disk)
    assert certify(disk, x).is_bijective
    np.testing.assert_array_equal(x, np.round(x))
    closing = 0 if len(disk.boundary_loops[0]) == 3 else 1
    assert x.min() >= 0
    assert x.sum(axis=1).max() <= 2 * (disk.n_vertices + closing) - 5


@given(arrays(sheet))
def test_disks_nobody_thought_of(pair):
    used, local = np.unique(pair[1], return_inverse=True)
    disk = Topology(local.reshape(-1, 3), len(used))
    assert certify(disk, draw(disk)).is_bijective


@given(st.integers(0, 10**6), st.integers(0, 30))
def test_divided_triangles(seed, steps):
    disk = split(seed, steps)
    assert certify(disk, draw(disk)).is_bijective


def test_regions_are_those_between_the_paths():
    """Flood the faces between the three paths of each vertex, and count."""
    disk = split(3, 40)
    n, faces = disk.n_vertices, disk.faces
    corners = disk.boundary_loops[0]
    kept = {}

    def seen(order, parents, at):
        kept.update(order=order, parents=parents)
        return regions(order, parents, at)

    regions, schnyder._regions = schnyder._regions, seen
    try:
        x = draw(disk)
    finally:
        schnyder._regions = regions
    f, side = np.divmod(np.flatnonzero(disk.twins.ravel() >= 0), 3)
    across = disk.twins[f, side] // 3
    ends = np.sort(np.stack([faces[f, (side + 1) % 3], faces[f, (side + 2) % 3]], axis=1))
    for v in np.setdiff1d(np.arange(n), corners):
        walls = set()
        for tree in range(3):
            path = [v]
            while kept["parents"][tree, path[-1]] >= 0:
                path.append(int(kept["parents"][tree, path[-1]]))
            assert path[-1] == corners[tree]
            walls |= {tuple(sorted(pair)) for pair in itertools.pairwise(path)}
        open_ = np.array([tuple(pair) not in walls for pair in ends.tolist()])
        graph = csr_array(
            (np.ones(open_.sum()), (f[open_], across[open_])), shape=(len(faces),) * 2
        )
        count, label = connected_components(graph, directed=False)
        assert count == 3
        for tree in (1, 2):  # opposite corner i lies the side of the other two
            others = np.delete(corners, tree)
            (at,) = np.flatnonzero(np.isin(faces, others).sum(axis=1) == 2)
            assert x[v, tree - 1] == np.count_nonzero(label == label[at])


def test_tubes_that_no_solve_maps_are_drawn():
    mesh = tube(4, 120)
    plain = parameterize(mesh, cut=False, strict=False)
    assert len(plain.flipped) > 0
    psi = parameterize(mesh, cut=False)
    assert psi.is_bijective
    assert "Schnyder" in psi.method
    assert len(psi.cut_edges) == 0
    seamed = parameterize(mesh)  # a seam is better, and comes first
    assert "Schnyder" not in seamed.method
    assert seamed.distortion.symmetric_dirichlet < psi.distortion.symmetric_dirichlet


def test_the_drawing_is_improved(monkeypatch):
    mesh = tube(4, 120)
    better = parameterize(mesh, cut=False).distortion.symmetric_dirichlet
    monkeypatch.setattr(components, "relax", lambda part, x, *rest: (x, 0))
    assert better < 0.9 * parameterize(mesh, cut=False).distortion.symmetric_dirichlet


def test_what_is_no_disk(monkeypatch):
    for mesh in (icosphere(1), torus(6, 5), cylinder(8, 3)):
        with pytest.raises(NotADiskError):
            draw(mesh.topology)
    two = np.concatenate([grid(1, 1).faces, grid(1, 1).faces + 4])
    with pytest.raises(NotADiskError):
        draw(Topology(two))
    monkeypatch.setattr(schnyder, "LARGEST", 5)
    with pytest.raises(MeshError, match="exact"):
        draw(disk(3).topology)
