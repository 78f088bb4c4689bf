"""Borders in denoise: low passes that average them along themselves."""

import numpy as np
import pytest

from beltrami.diffusion.blind import blind_choice
from beltrami.diffusion.candidates import Bench, along_normals, filtered
from beltrami.diffusion.choice import ALL, apply, choose, with_borders
from beltrami.diffusion.denoise import denoise
from beltrami.diffusion.linear_filters import (
    AT_BORDERS,
    LINEAR,
    Linear,
    equal_rows,
    low_passed,
    rows_along_borders,
    rows_by_length,
)
from beltrami.diffusion.patches import sample_of
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh


def noisy(truth, level, seed=0):
    """White noise along the normals, its level in mean edge lengths."""
    sigma = level * truth.edge_lengths.mean()
    noise = np.random.default_rng(seed).normal(0, sigma, truth.n_vertices)
    return truth.with_vertices(truth.vertices + noise[:, None] * truth.vertex_normals), sigma


def angle(x, truth):
    cosine = np.einsum("ij,ij->i", truth.with_vertices(x).face_normals, truth.face_normals)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1))).mean()


def rms(x, truth):
    return np.sqrt(((x - truth.vertices) ** 2).sum(axis=1).mean())


def torn():
    """A sphere with ragged holes, irregular: some border vertices have four border edges."""
    sphere = shapes.icosphere(2)
    kept = np.random.default_rng(3).random(sphere.n_faces) < 0.85
    return Mesh(sphere.vertices * [1, 1.5, 0.7], sphere.faces[kept])


def matrix_of(rows):
    """Return it dense, in the old numbers."""
    n = len(rows.order)
    W = np.zeros((n, n))
    for i in range(n):
        part = slice(rows.indptr[i], rows.indptr[i + 1])
        np.add.at(W[rows.order[i]], rows.order[rows.indices[part]], rows.data[part])
    return W


def means_along_borders(mesh, along, lengths):
    """Return W̃ vertex by vertex."""
    edges = [tuple(sorted((f[a], f[a - 1]))) for f in mesh.faces.tolist() for a in range(3)]
    W = np.zeros((mesh.n_vertices, mesh.n_vertices))
    for i in range(mesh.n_vertices):
        own = {e for e in edges if i in e}
        border = {e for e in own if edges.count(e) == 1}
        for i_j in border or own:
            j = sum(i_j) - i
            apart = np.linalg.norm(mesh.vertices[i] - mesh.vertices[j])
            W[i, j] = 1 / apart if lengths else 1
        if own:
            W[i] *= (along if border else 1) / W[i].sum()
            W[i, i] = 1 - along if border else 0
    return W


@pytest.mark.parametrize("by_length", [False, True])
@pytest.mark.parametrize("along", [0.5, 1.0])
def test_the_rows_against_means_vertex_by_vertex(along, by_length):
    mesh = torn()
    expected = means_along_borders(mesh, along, by_length)
    found = matrix_of(rows_along_borders(mesh, along, by_length=by_length))
    assert np.abs(found - expected).max() < 1e-14
    k = np.linalg.eigvals(found)
    assert np.abs(k.imag).max() < 1e-6
    assert np.abs(k.real).max() < 1 + 1e-9


def test_a_third_along_the_border_is_the_mean_with_mirror_images():
    """Of a regular grid: two neighbours along the border, two inside, and two behind it."""
    grid = shapes.grid(6, 6)
    f = np.random.default_rng(0).random(grid.n_vertices)
    found = matrix_of(rows_along_borders(grid, 1 / 3, by_length=False)) @ f
    degrees = np.diff(grid.topology.adjacency.indptr)
    sides = np.flatnonzero(grid.topology.on_boundary & (degrees == 4))
    assert len(sides) == 20
    for i in sides:
        around = grid.topology.adjacency[[int(i)]].indices
        inside = [j for j in around if not grid.topology.on_boundary[j]]
        if len(inside) == 2:  # not beside a corner
            mean = (f[around].sum() + (2 * f[i] - f[inside]).sum()) / 6
            assert found[i] == pytest.approx(mean, abs=1e-14)


def test_a_slope_is_kept_at_the_border_where_other_means_bend_it():
    tube = shapes.cylinder(24, 20, caps=False)
    for one in (Linear(0.05, along=1.0), Linear(0.05, True, along=0.7)):
        rows = rows_along_borders(tube, one.along, by_length=one.by_length)
        alike = rows_by_length(tube) if one.by_length else equal_rows(tube)
        height = np.ptp(tube.vertices[:, 2])
        kept, bent = (
            np.abs((low_passed(r, tube.vertices, one) - tube.vertices)[:, 2]).max() / height
            for r in (rows, alike)
        )
        assert kept < 2e-3
        assert bent > 0.03


def test_the_filters_look_at_the_evened_mesh_and_move_along_normals():
    truth = shapes.cylinder(24, 10, caps=False)
    mesh, _ = noisy(truth, 0.2)
    bench, one = Bench.of(mesh), Linear(0.1, True, along=0.7)
    evened = mesh.with_vertices(low_passed(bench.rows, mesh.vertices, bench.evening))
    rows = rows_along_borders(evened, 0.7, by_length=True)
    expected = along_normals(mesh, low_passed(rows, mesh.vertices, one))
    found = filtered(mesh, bench, [one])[0]
    assert np.array_equal(found, expected)
    other = rows_along_borders(mesh, 0.7, by_length=True)
    assert not np.allclose(along_normals(mesh, low_passed(other, mesh.vertices, one)), expected)
    assert str(one) == "linear, frequencies below 0.1, weights by length, 0.7 along borders"


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_nothing_grows_on_ragged_borders(unit):
    """The matrix is not symmetric: powers of it might grow, though its spectrum is in [-1, 1]."""
    mesh = torn()
    lone = Mesh([*mesh.vertices, [9.0, 9, 9], *np.eye(3)], [*mesh.faces, [163, 164, 165]])
    lone = lone.with_vertices(unit * lone.vertices)  # a vertex of no face, and a single triangle
    box = np.abs(lone.vertices).max(axis=0)
    for one in AT_BORDERS:
        rows = rows_along_borders(lone, one.along, by_length=one.by_length)
        moved = low_passed(rows, lone.vertices, one)
        assert (np.abs(moved) <= 1.05 * box).all()
        assert moved[162] == pytest.approx(lone.vertices[162], rel=1e-14)


def test_they_are_tried_where_there_are_borders():
    assert with_borders(LINEAR) == (*LINEAR, *AT_BORDERS)
    assert with_borders(ALL)[: len(LINEAR)] == LINEAR
    assert set(with_borders(ALL)) == {*ALL, *AT_BORDERS}
    assert len(with_borders(ALL)) == 131
    closed, _ = noisy(shapes.icosphere(3), 0.2)
    assert blind_choice(closed, None, 10**6, linear=True).choice.filters == LINEAR
    # patches have borders that the mesh has not
    assert blind_choice(closed, None, 600, linear=True).choice.filters == LINEAR
    opened, _ = noisy(Mesh(closed.vertices, closed.faces[20:]), 0.2)
    assert blind_choice(opened, None, 10**6, linear=True).choice.filters == with_borders(LINEAR)
    hardly, _ = noisy(Mesh(closed.vertices, closed.faces[1:]), 0.2)  # three vertices of 642
    assert blind_choice(hardly, None, 10**6, linear=True).choice.filters == LINEAR


@pytest.mark.chapter("P43")
@pytest.mark.parametrize("level", [0.1, 0.25])
def test_they_leave_less_noise_of_open_shapes(level):
    """Nothing was chosen on this shape."""
    plane = shapes.grid(32, 32, dimension=3)
    x, y, _ = plane.vertices.T
    truth = plane.with_vertices(np.stack([x, y, 0.4 * x**2 * y + 0.3 * y**2], axis=1))
    errors = []
    for seed in range(3):
        mesh, sigma = noisy(truth, level, seed)
        bench, sample = Bench.of(mesh), sample_of(mesh, 10**6)
        for filters in (with_borders(LINEAR), LINEAR):
            x = apply(mesh, bench, choose(sample, sigma, truth.vertex_normals, filters))
            errors.append((angle(x, truth), rms(x, truth)))
    with_, without = np.reshape(errors, (3, 2, 2)).mean(axis=0)
    assert with_[0] < 0.88 * without[0]
    assert with_[1] < 0.96 * without[1]


def test_the_border_of_a_tube_stays_a_circle_in_its_plane():
    truth = shapes.cylinder(40, 14, caps=False)
    mesh, sigma = noisy(truth, 0.2)
    found = denoise(mesh)
    assert "along borders" in str(found.mixture)
    rim = truth.topology.on_boundary
    x, before = found.mesh.vertices[rim], truth.vertices[rim]
    assert np.abs(x[:, 2] - before[:, 2]).max() < 0.2 * sigma
    assert np.hypot(*x[:, :2].T).mean() == pytest.approx(np.hypot(*before[0, :2]), abs=0.1 * sigma)
    assert np.sqrt(((x - before) ** 2).sum(axis=1).mean()) < 0.4 * sigma
