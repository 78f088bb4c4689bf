"""Distortion: against numpy's singular values, and maps of which all is known."""

import numpy as np
import pytest

from beltrami.errors import DimensionError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import grid, icosphere
from beltrami.parameterization.distortion import distortion
from meshes_of_the_errata import cur, open_

pytestmark = pytest.mark.chapter("P74")


def test_singular_values_are_those_of_numpy():
    mesh = cur()
    uv = np.random.default_rng(0).normal(size=(mesh.n_vertices, 2))
    found = distortion(mesh, uv)
    for f in range(0, mesh.n_faces, 17):
        x, y = mesh.vertices[mesh.faces[f]], uv[mesh.faces[f]]
        sides = np.stack([x[1] - x[0], x[2] - x[0]], axis=1)
        q, r = np.linalg.qr(sides)
        J = np.stack([y[1] - y[0], y[2] - y[0]], axis=1) @ np.linalg.inv(r)
        assert q.shape == (3, 2)
        truth = np.linalg.svd(J, compute_uv=False)
        np.testing.assert_allclose(found.singular_values[f], truth, rtol=1e-9)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 7.0])
def test_isometries_are_those_without_distortion(scale):
    mesh = open_()
    t = 0.7
    turn = scale * np.array([[np.cos(t), -np.sin(t)], [np.sin(t), np.cos(t)]])
    found = distortion(mesh, mesh.vertices @ turn)
    np.testing.assert_allclose(found.singular_values, scale, rtol=1e-9)
    for summary in (found.mean_conformal, found.mean_area, found.symmetric_dirichlet):
        assert summary == pytest.approx(1, abs=1e-9)
    assert found.scale == pytest.approx(scale)


def test_a_linear_map():
    found = distortion(open_(), open_().vertices @ [[3, 0], [0, 2]])
    np.testing.assert_allclose(found.singular_values, [[3, 2]] * open_().n_faces)
    np.testing.assert_allclose(found.conformal, 1.5)
    np.testing.assert_allclose(found.area, 1)
    # at the scale s: s²(9 + 4) + (1/9 + 1/4)/s², smallest where both are equal
    truth = np.sqrt(13 * (1 / 9 + 1 / 4)) / 2
    assert found.symmetric_dirichlet == pytest.approx(truth)
    np.testing.assert_allclose(found.energy, truth)


def test_conformal_maps_keep_angles_and_change_areas():
    """Stereographic projection of a fine sphere."""
    mesh = icosphere(4)
    x = mesh.vertices
    low = (x[mesh.faces][:, :, 2] < 0.5).all(axis=1)
    part = Mesh(x, mesh.faces[low])
    found = distortion(part, x[:, :2] / (1 - np.minimum(x[:, 2], 0.9))[:, None])
    assert found.mean_conformal < 1.05
    assert found.area.max() / found.area.min() > 4


def test_collapsed_faces_are_infinitely_distorted():
    mesh = grid(2, 2)
    found = distortion(mesh, mesh.vertices[:, :2] * [1, 0])
    assert found.symmetric_dirichlet == np.inf
    assert (found.conformal == np.inf).all()
    assert (found.energy == np.inf).all()
    assert distortion(mesh, np.zeros((mesh.n_vertices, 2))).symmetric_dirichlet == np.inf


@pytest.mark.parametrize("unit", [1e-100, 1e-9, 1e9, 1e100])
def test_the_unit_of_the_surface_does_not_matter(unit):
    mesh = cur()
    uv = mesh.vertices[:, :2]
    one, other = distortion(mesh, uv), distortion(mesh.with_vertices(mesh.vertices * unit), uv)
    assert other.symmetric_dirichlet == pytest.approx(one.symmetric_dirichlet, rel=1e-9)
    assert other.mean_conformal == pytest.approx(one.mean_conformal, rel=1e-9)


def test_bad_input():
    with pytest.raises(DimensionError):
        distortion(cur(), np.zeros((3, 2)))
    with pytest.raises(DimensionError):
        distortion(cur(), cur().vertices)
