"""Fairing of faces that are small beside the error of the positions."""

import numpy as np
import pytest

from beltrami.diffusion.blind import blind_choice
from beltrami.diffusion.choice import apply
from beltrami.diffusion.denoise import denoise
from beltrami.diffusion.fairing import faired
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh
from made_once import creature


def uneven(mesh):
    """Invert at a sphere around a point outside: angles stay, and sizes of faces become uneven."""
    away = mesh.vertices - [1.7, 0, 0]
    return Mesh(away / (away**2).sum(axis=1, keepdims=True), mesh.faces[:, ::-1])


TRUTH = uneven(creature(2500))
EDGE = TRUTH.edge_lengths.mean()
SIGMA = 0.1 * EDGE


def noisy(seed=0, sigma=SIGMA):
    noise = np.random.default_rng(seed).normal(0, sigma, TRUTH.n_vertices)
    return TRUTH.with_vertices(TRUTH.vertices + noise[:, None] * TRUTH.vertex_normals)


def angles(x):
    cosine = np.einsum("ij,ij->i", TRUTH.with_vertices(x).face_normals, TRUTH.face_normals)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def rms(x):
    return np.sqrt(((x - TRUTH.vertices) ** 2).sum(axis=1).mean())


def test_against_the_matrix():
    mesh = uneven(shapes.icosphere(2))
    mean = mesh.edge_lengths.mean()
    for error, r in ((0.05 * mean, 0.06 * mean), (3 * mean, 0.15 * mean)):
        L = np.zeros((mesh.n_vertices, mesh.n_vertices))
        for (i, j), length in zip(mesh.edges, mesh.edge_lengths, strict=True):
            w = (1 + (length / r) ** 2) ** -0.75
            L[[i, j], [i, j]] += w
            L[[i, j], [j, i]] -= w
        expected = np.linalg.solve(np.eye(len(L)) + L @ L, mesh.vertices)
        moved = np.abs(expected - mesh.vertices).max()
        assert moved > 1e-3 * mean
        assert np.allclose(faired(mesh, error), expected, rtol=0, atol=1e-7 * moved)


def test_the_normals_of_small_faces_gain_and_the_positions_lose_nothing():
    """Large faces hardly move; equal weights would move them, and the shape with them."""
    sizes = np.sqrt(TRUTH.face_areas)
    small, large = sizes < np.quantile(sizes, 0.2), sizes > np.quantile(sizes, 0.6)
    for seed in range(3):
        x = noisy(seed).vertices
        found = faired(noisy(seed), SIGMA)
        assert angles(found)[small].mean() < 0.75 * angles(x)[small].mean()
        assert angles(found)[large].mean() < 1.001 * angles(x)[large].mean()
        assert rms(found) < rms(x)


def test_where_all_edges_are_long_nothing_moves():
    mesh = noisy()
    shortest = mesh.edge_lengths.min()
    for error in (0.0, 0.049 * shortest):
        assert np.array_equal(faired(mesh, error), mesh.vertices)
    assert not np.array_equal(faired(mesh, 0.051 * shortest), mesh.vertices)


def test_a_large_error_is_taken_for_no_more_than_faces_bear():
    mesh = noisy()
    assert np.array_equal(faired(mesh, EDGE), faired(mesh, 1e200))
    assert rms(faired(mesh, 1e200)) < 1.2 * rms(mesh.vertices)


@pytest.mark.parametrize("unit", [1e-9, 2.0**-30, 1e9])
def test_units_places_and_numbers_do_not_matter(unit):
    mesh = noisy()
    found = faired(mesh, SIGMA)
    scaled = faired(mesh.with_vertices(unit * mesh.vertices), unit * SIGMA) / unit
    assert np.allclose(scaled, found, rtol=0, atol=1e-11 * EDGE)
    if unit == 2.0**-30:
        assert np.array_equal(scaled, found)
    shifted = faired(mesh.with_vertices(mesh.vertices + 100), SIGMA) - 100
    assert np.allclose(shifted, found, rtol=0, atol=1e-9 * EDGE)
    order = np.random.default_rng(1).permutation(mesh.n_vertices)
    other = Mesh(mesh.vertices[order], np.argsort(order)[mesh.faces])
    assert np.allclose(faired(other, SIGMA), found[order], rtol=0, atol=1e-11 * EDGE)


def test_vertices_of_no_face_stay_and_flat_or_no_faces_are_fine():
    mesh = noisy()
    more = Mesh(np.concatenate([mesh.vertices, [[7.0, 1, 2]]]), mesh.faces)
    found = faired(more, SIGMA)
    assert np.array_equal(found[-1], more.vertices[-1])
    assert np.array_equal(found[:-1], faired(mesh, SIGMA))
    point = Mesh(np.ones((3, 3)), [[0, 1, 2]])
    assert np.array_equal(faired(point, 1.0), point.vertices)
    none = Mesh(np.ones((3, 3)), np.zeros((0, 3), int))
    assert np.array_equal(faired(none, 1.0), none.vertices)
    doubled = Mesh([[0, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0.0]], [[0, 1, 3], [1, 2, 3]])
    assert np.isfinite(faired(doubled, 0.1)).all()


def test_denoise_ends_with_it():
    """The normals of an unevenly sampled shape are better for it, and the distances no worse."""
    mesh = noisy(sigma=0.3 * EDGE)
    blind = blind_choice(mesh, None, 40_000, linear=True)
    before = apply(mesh, blind.bench, blind.choice)
    found = denoise(mesh, "linear")
    after = found.mesh.vertices
    assert np.array_equal(after, faired(mesh.with_vertices(before), found.predicted_error))
    assert angles(after).mean() < 0.93 * angles(before).mean()
    assert rms(after) < rms(before)
