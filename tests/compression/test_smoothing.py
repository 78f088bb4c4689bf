"""Smoothing within cells: the minimiser, against plain linear algebra."""

import numpy as np
import pytest

from beltrami.compression.neighbourhood import look_around
from beltrami.compression.smoothing import WEIGHTS, best_choice, choice_near, smoothed
from beltrami.mesh import shapes


def parallelograms(mesh):
    """P: one row for each two faces with a common side."""
    rows = []
    for h, t in enumerate(mesh.topology.twins.ravel()):
        if t > h:
            a, b, c = mesh.faces[h // 3, (h + np.arange(3)) % 3]
            row = np.zeros(mesh.n_vertices)
            row[[a, mesh.faces[t // 3, t % 3]]] += 1
            row[[b, c]] -= 1
            rows.append(row)
    return np.array(rows).reshape(-1, mesh.n_vertices)


@pytest.mark.parametrize("choice", range(1, len(WEIGHTS) + 1))
@pytest.mark.parametrize("mesh", [shapes.icosphere(2), shapes.disk(5)], ids=["sphere", "disk"])
def test_it_minimises_and_stays_in_the_cells(mesh, choice):
    q = np.rint(30 * mesh.vertices).astype(np.int64)
    P = parallelograms(mesh)
    exact = np.linalg.solve(np.eye(len(q)) + WEIGHTS[choice - 1] / 6 * P.T @ P, q)
    found = smoothed(q, look_around(mesh.faces, mesh.n_vertices), choice)
    np.testing.assert_allclose(found, np.clip(exact, q - 0.5, q + 0.5), atol=1e-3)


def test_a_vertex_of_many_faces_does_not_make_it_diverge():
    fan = np.array([[0, i, i % 200 + 1] for i in range(1, 201)])
    q = np.random.default_rng(0).integers(-1000, 1000, (201, 3))
    found = smoothed(q, look_around(fan, 201), len(WEIGHTS))
    assert np.isfinite(found).all()
    assert abs(found - q).max() <= 0.5


def test_without_faces_nothing_moves():
    q = np.arange(12).reshape(4, 3)
    near = look_around(np.array([[0, 1, 2]]), 4)
    for choice in range(len(WEIGHTS) + 1):
        np.testing.assert_array_equal(smoothed(q, near, choice), q)


def test_the_best_choice_follows_the_noise():
    mesh = shapes.icosphere(3)
    near = look_around(mesh.faces, mesh.n_vertices)
    coarse, fine = 6 * mesh.vertices, 1e6 * mesh.vertices
    assert best_choice(coarse, np.rint(coarse).astype(np.int64), near) > 2
    noise = fine + np.random.default_rng(0).normal(size=fine.shape) * 1e5
    assert best_choice(noise, np.rint(noise).astype(np.int64), near) == 0


def test_of_the_smoothings_that_keep_a_bound_the_nearest_in_the_mean():
    mesh = shapes.icosphere(3)
    near = look_around(mesh.faces, mesh.n_vertices)
    x = 6 * mesh.vertices
    numbers = np.rint(x).astype(np.int64)
    off = [
        np.linalg.norm(smoothed(numbers, near, choice) - x, axis=1)
        for choice in range(len(WEIGHTS) + 1)
    ]
    largest, mean = [one.max() for one in off], [(one**2).sum() for one in off]
    for most in (*sorted(largest)[:6], min(largest) / 2, np.inf):
        kept = [c for c in range(len(off)) if largest[c] <= most * (1 + 1e-12)]
        expected = min(kept, key=mean.__getitem__, default=0)
        assert best_choice(x, numbers, near, most * (1 + 1e-9)) == expected


@pytest.mark.parametrize("start", range(len(WEIGHTS) + 1))
def test_the_best_choice_is_found_from_everywhere(start):
    mesh = shapes.icosphere(3)
    near = look_around(mesh.faces, mesh.n_vertices)
    x = 6 * mesh.vertices
    numbers = np.rint(x)
    assert choice_near(x, numbers, near, start) == best_choice(x, numbers, near)
