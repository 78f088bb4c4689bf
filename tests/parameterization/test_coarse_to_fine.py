"""Large disks: mapped from coarser ones, at least as well, and as they are where that is not so."""

import numpy as np
import pytest

from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import blob, cylinder, disk, icosphere
from beltrami.parameterization import coarse_to_fine
from beltrami.parameterization.boundary import place_boundary
from beltrami.parameterization.coarse_to_fine import disk_map
from beltrami.parameterization.parameterize import parameterize

WEIGHTS = ("clamped", "mean_value", "combinatorial")


def less_one(mesh):
    return Mesh(mesh.vertices, mesh.faces[1:])


def mapped(mesh, weights=WEIGHTS, free=False, settled=3e-3, rough=False):
    loop = mesh.boundary_loops[0]
    placed = place_boundary(mesh, loop, "circle")
    return disk_map(mesh, weights, loop, placed, free=free, settled=settled, rough=rough)


@pytest.fixture
def sizes(monkeypatch):
    """Take coarser meshes from 300 vertices on, and note how many vertices are reweighted."""
    found = []
    reweighted = coarse_to_fine.reweighted

    def noted(mesh, *rest, **options):
        found.append(mesh.n_vertices)
        return reweighted(mesh, *rest, **options)

    monkeypatch.setattr(coarse_to_fine, "_LARGE", 300)
    monkeypatch.setattr(coarse_to_fine, "_ROUGH", (300, 4))
    monkeypatch.setattr(coarse_to_fine, "reweighted", noted)
    return found


def test_a_free_boundary_is_not_that_of_a_coarser_mesh(sizes):
    mesh = less_one(icosphere(3))
    mapped(mesh, free=True)
    assert set(sizes) == {mesh.n_vertices}


def test_unless_the_map_need_only_be_rough(sizes):
    """Of a cap: the rough map is all of the coarser mesh, folds nowhere, and is nearly as good."""
    ball = icosphere(4)
    cap = ball.vertices[ball.faces][..., 2].min(axis=1) > 0.3
    used, local = np.unique(ball.faces[cap], return_inverse=True)
    mesh = Mesh(ball.vertices[used], local.reshape(-1, 3))
    rough = mapped(mesh, free=True, settled=1e-2, rough=True)
    assert max(sizes) < mesh.n_vertices / 2
    assert rough.flips == 0
    assert len(rough.uv) == mesh.n_vertices
    fine = mapped(mesh, free=True, settled=1e-2)
    assert rough.rank[1] < 1.1 * fine.rank[1]


def test_weights_of_the_users_own_are_for_the_mesh_as_it_is(sizes):
    mesh = less_one(icosphere(3))
    mapped(mesh, (lambda of: np.ones(len(mesh.edges)),))
    assert set(sizes) == {mesh.n_vertices}


def test_what_can_not_be_thinned_is_mapped_as_it_is(sizes, monkeypatch):
    mesh = less_one(icosphere(3))
    monkeypatch.setattr(coarse_to_fine, "_HARDLY", 50.0)
    assert mapped(mesh).flips == 0
    assert set(sizes) == {mesh.n_vertices}


def test_an_insertion_that_folds_is_not_taken(sizes, monkeypatch):
    mesh = less_one(icosphere(3))
    monkeypatch.setattr(
        coarse_to_fine, "inserted", lambda fine, *rest: np.zeros((fine.n_vertices, 2))
    )
    step = mapped(mesh)
    assert step.flips == 0
    assert mesh.n_vertices in sizes


def test_a_coarser_map_that_folds_is_not_taken(sizes, monkeypatch):
    mesh = less_one(icosphere(3))
    reweighted = coarse_to_fine.reweighted

    def folded(of, *rest, **options):
        step, done = reweighted(of, *rest, **options)
        if of.n_vertices < mesh.n_vertices:
            step = coarse_to_fine.assess(of, step.uv * [-1, 1])
        return step, done

    monkeypatch.setattr(coarse_to_fine, "reweighted", folded)
    assert mapped(mesh).flips == 0


def test_large_disks_come_from_coarser_ones_and_are_as_good(monkeypatch):
    mesh = less_one(blob(5200))
    found = []
    thinned = coarse_to_fine.thinned
    monkeypatch.setattr(
        coarse_to_fine, "thinned", lambda *given: found.append(given) or thinned(*given)
    )
    psi = parameterize(mesh, cut=False)
    assert psi.is_bijective
    assert len(found) == 1
    rim = psi.mesh.topology.on_boundary
    np.testing.assert_allclose(np.linalg.norm(psi.uv[rim], axis=1), 1)
    monkeypatch.setattr(coarse_to_fine, "_LARGE", 10**9)
    alone = parameterize(mesh, cut=False)
    assert len(found) == 1
    energies = [one.distortion.symmetric_dirichlet for one in (psi, alone)]
    assert energies[0] < 1.05 * energies[1]


def test_the_best_start_is_relaxed_first_and_others_where_it_ends_badly(monkeypatch):
    """Of a tube maps from different weights differ; a good start is enough for what is flat."""
    kinds = []
    edge_weights = coarse_to_fine.edge_weights

    def noted(mesh, kind):
        kinds.append(kind)
        return edge_weights(mesh, kind)

    monkeypatch.setattr(coarse_to_fine, "edge_weights", noted)
    mapped(disk(6))
    assert kinds == [WEIGHTS[0]]
    tube = less_one(cylinder(12, 20, height=20 * np.pi / 6, caps=True))
    all_of_them = mapped(tube)
    assert sorted(kinds[1:]) == sorted(WEIGHTS)
    alone = [mapped(tube, (kind,)).rank for kind in WEIGHTS]
    assert all_of_them.rank == min(alone)
    assert min(alone) < max(alone)
