"""Filling: unknown vertices come back to where the others say, and all others stay."""

import numpy as np
import pytest

from beltrami.diffusion.candidates import along_normals
from beltrami.diffusion.filling import error_of_filling, filled
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh

BLOB = shapes.blob(600)


def lost(mesh, share, seed=0):
    """Return which vertices are lost, and the mesh with them two mean edges off."""
    unknown = np.random.default_rng(seed).random(mesh.n_vertices) < share
    off = 2 * mesh.edge_lengths.mean() * unknown[:, None] * mesh.vertex_normals
    return unknown, mesh.with_vertices(mesh.vertices + off)


def rms(x, mesh):
    return np.sqrt(((x - mesh.vertices) ** 2).sum(axis=1).mean()) / mesh.edge_lengths.mean()


@pytest.mark.parametrize("share", [0.1, 0.5])
def test_against_least_squares(share):
    unknown, mesh = lost(BLOB, share)
    A = mesh.topology.adjacency.toarray()
    K = np.eye(len(A)) - A / A.sum(axis=1)[:, None]
    known = K[:, ~unknown] @ mesh.vertices[~unknown]
    moved = mesh.vertices.copy()
    moved[unknown] = -np.linalg.lstsq(K[:, unknown], known, rcond=None)[0]
    found = filled(mesh, unknown)
    assert np.allclose(found[unknown], along_normals(mesh, moved)[unknown], atol=1e-4)
    assert np.array_equal(found[~unknown], mesh.vertices[~unknown])
    assert rms(found, BLOB) < (0.1 if share < 0.2 else 0.3) * rms(mesh.vertices, BLOB)


def test_creases_come_back_by_their_planes():
    cube = shapes.cube(12)
    unknown, mesh = lost(cube, 0.1)
    plain, creased = (filled(mesh, unknown, way) for way in ("plain", "creased"))
    assert rms(creased, cube) < 0.3 * rms(plain, cube)
    assert np.array_equal(creased[~unknown], mesh.vertices[~unknown])


def test_beside_noise_they_come_down_in_their_place():
    """Noise tilts the normals, and what is far off would come down beside."""
    sphere = shapes.icosphere(4)
    unknown, mesh = lost(sphere, 0.1)
    noise = np.random.default_rng(1).normal(0, 0.01, len(unknown)) * ~unknown
    mesh = mesh.with_vertices(mesh.vertices + noise[:, None] * sphere.vertices)
    plain, evened = (filled(mesh, unknown, way)[unknown] for way in ("plain", "noise"))
    errors = [np.sqrt(((x - sphere.vertices[unknown]) ** 2).sum(1).mean()) for x in (plain, evened)]
    assert errors[1] < 0.75 * errors[0]


@pytest.mark.parametrize(("truth", "better"), [(shapes.cube(12), "creased"), (BLOB, "plain")])
def test_the_errors_on_known_vertices_tell_the_better_way(truth, better):
    unknown, mesh = lost(truth, 0.1)
    errors = {way: error_of_filling(mesh, unknown, way) for way in ("plain", "creased")}
    assert min(errors, key=errors.get) == better
    x = filled(mesh, unknown, better)
    true = np.sqrt(((x - truth.vertices)[unknown] ** 2).sum(axis=1).mean())
    assert 0.3 * true < errors[better] < max(3 * true, 0.15 * truth.edge_lengths.mean())


def test_what_cannot_be_filled_is_a_number_and_stays_near():
    one = shapes.icosphere(1)
    n = one.n_vertices
    two = Mesh(np.concatenate([one.vertices, one.vertices + 9, [[7.0, 0, 0]]]),
               np.concatenate([one.faces, one.faces + n]))  # fmt: skip
    unknown = np.arange(2 * n + 1) >= n  # a whole component, and a vertex of no face
    found = filled(two, unknown)
    assert np.abs(found - two.vertices).max() < 2
    assert np.array_equal(found[2 * n], two.vertices[2 * n])
    assert error_of_filling(two, np.ones(2 * n + 1, bool), "plain") == np.inf
    assert np.array_equal(filled(one, np.zeros(n, bool)), one.vertices)


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_the_unit_and_the_place_do_not_matter(unit):
    unknown, mesh = lost(BLOB, 0.2)
    here = filled(mesh, unknown)
    there = filled(mesh.with_vertices((mesh.vertices + 50) * unit), unknown)
    assert np.allclose(there / unit - 50, here, atol=1e-5)
