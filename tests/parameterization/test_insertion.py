"""Insertion: vertices come back into a map without a fold, and not far from where they belong."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import grid, icosphere
from beltrami.mesh.tree_cotree import cut_to_disk
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.distortion import distortion
from beltrami.parameterization.harmonic import harmonic
from beltrami.parameterization.insertion import _middle, inserted
from beltrami.parameterization.parameterize import parameterize
from beltrami.parameterization.thinning import thinned
from made_once import creature


def less_one(mesh):
    return Mesh(mesh.vertices, mesh.faces[1:])


def test_a_plane_comes_back_as_it_was():
    mesh = grid(16, 12)
    coarse = thinned(mesh, 60)
    assert len(coarse.removed) > 60
    x = inserted(mesh, coarse, mesh.vertices[coarse.kept, :2], 1.0)
    np.testing.assert_allclose(x, mesh.vertices[:, :2], atol=2e-2 / 12)


@pytest.mark.parametrize(
    "make",
    [
        lambda: less_one(icosphere(3)),
        lambda: cut_to_disk(creature(1500)).mesh,
        lambda: less_one(creature(1500)),
    ],
)
def test_what_was_without_a_fold_remains_so(make):
    mesh = make()
    coarse = thinned(mesh, mesh.n_vertices // 4)
    psi = parameterize(coarse.mesh, cut=False)
    x = inserted(mesh, coarse, psi.uv, 1 / psi.distortion.scale)
    assert certify(mesh, x).is_bijective
    np.testing.assert_array_equal(x[coarse.kept], psi.uv)
    assert distortion(mesh, x).symmetric_dirichlet < 4 * psi.distortion.symmetric_dirichlet


@given(st.integers(0, 10**6))
@settings(max_examples=10)
def test_however_bad_the_map_is(seed):
    """The geometry may be any: an insertion is about the faces in the plane."""
    mesh = less_one(icosphere(3))
    coarse = thinned(mesh, 200)
    loop = coarse.mesh.boundary_loops[0]
    turn = np.sort(np.random.default_rng(seed).uniform(0, 2 * np.pi, len(loop)))
    held = np.column_stack([np.cos(turn), np.sin(turn)])
    uv = harmonic(coarse.mesh, loop, held, "combinatorial")
    if certify(coarse.mesh, uv).is_bijective:  # not where three random corners are in line
        assert certify(mesh, inserted(mesh, coarse, uv, 1.0)).is_bijective


def test_where_there_is_no_room_the_vertex_stays_at_its_neighbour():
    """So its faces have no area, which the certificate sees."""
    mesh = grid(6, 6)
    coarse = thinned(mesh, 30)
    x = inserted(mesh, coarse, np.zeros((len(coarse.kept), 2)), 1.0)
    np.testing.assert_array_equal(x, 0)
    assert not certify(mesh, x).is_bijective


def test_the_middle_is_seen_from_all_sides():
    ring = np.array([[0, 0], [4, 0], [4, 4], [2.5, 1.5], [0, 1]], float)  # not convex
    sides = np.column_stack([ring, np.roll(ring, -1, axis=0)])
    spare = np.empty((14, 2))
    p = np.array(_middle(sides, 5, 4.0, np.empty((14, 2)), spare))
    a, b = sides[:, :2], sides[:, 2:]
    left = (b - a)[:, 0] * (p - a)[:, 1] - (b - a)[:, 1] * (p - a)[:, 0]
    assert (left > 0).all()
    assert _middle(sides[:, [2, 3, 0, 1]], 5, 4.0, np.empty((14, 2)), spare) == (0.0, 0.0)
