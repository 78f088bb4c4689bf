"""Curvatures of smooth surfaces under refinement: at each vertex, and in the mean."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import blob, icosphere, torus
from beltrami.operators.curvature import curvature

pytestmark = pytest.mark.chapter("P3", "P35")


def _slope(errors):
    sizes = 2.0 ** -np.arange(len(errors))
    return np.polyfit(np.log(sizes), np.log(np.abs(errors)), 1)[0]


def _rms(error, areas):
    return np.sqrt(areas @ error**2 / areas.sum())


def test_each_vertex_of_a_regular_torus():
    gaussian, mean = [], []
    for k in (1, 2, 4):
        mesh = torus(32 * k, 16 * k, 1.0, 0.4)
        found = curvature(mesh)
        r = np.hypot(*mesh.vertices[:, :2].T)
        across = (r - 1) / 0.4 / r
        gaussian.append(np.abs(found.gaussian - across / 0.4).max())
        mean.append(np.abs(found.mean - (1 / 0.4 + across) / 2).max())
    assert _slope(gaussian) == pytest.approx(2, abs=0.3)
    assert _slope(mean) == pytest.approx(2, abs=0.3)


def test_the_sphere():
    errors = []
    for s in (2, 3, 4):
        found = curvature(icosphere(s))
        errors.append([found.areas @ found.mean - 4 * np.pi, _rms(found.gaussian - 1, found.areas)])
    mean, gaussian = np.array(errors).T
    assert _slope(mean) == pytest.approx(2, abs=0.1)
    assert _slope(gaussian) > 1
    assert np.abs(errors[-1]).max() < 0.05


def _ellipsoid(n, axes):
    """The hull of n random points: irregular at every size; and exact K and H."""
    x = np.random.default_rng(5).normal(size=(n, 3))
    x /= np.linalg.norm(x, axis=1)[:, None]
    f = ConvexHull(x).simplices
    a, b, c = x[f].transpose(1, 0, 2)
    inwards = (np.cross(b - a, c - a) * a).sum(axis=1) < 0
    f[inwards] = f[inwards][:, ::-1]
    x = x * axes
    q, volume = (x**2 / axes**4).sum(axis=1), np.prod(axes)
    K = 1 / (volume * q) ** 2
    H = np.abs((x**2).sum(axis=1) - (axes**2).sum()) / (2 * volume**2 * q**1.5)
    return Mesh(x, f), K, H


def test_on_irregular_meshes_means_converge_and_single_values_need_not():
    """E30: half of the values of H are off by a tenth at any size, and yet ∫HF converges."""
    single, whole = [], []
    for n in (400, 1600, 6400):
        mesh, K, H = _ellipsoid(n, np.array([1, 1.3, 1.8]))
        found = curvature(mesh)
        single.append(_rms(found.mean - H, found.areas))
        weight = mesh.vertices[:, 0] ** 2
        whole.append(
            [
                found.areas @ (weight * (found.mean - H)) / (found.areas @ weight),
                found.areas @ (weight * (found.gaussian - K)) / (found.areas @ weight),
            ]
        )
    assert min(single) > 0.1
    assert single[-1] > 0.8 * single[0]
    mean, gaussian = np.abs(whole).T
    assert mean[-1] < 0.01
    assert gaussian[-1] < 0.02
    assert _slope(gaussian) > 1
    assert _slope(mean) > 1


def test_a_blob():
    """No formula: two sizes of the same surface agree, and K adds to 4π at each."""
    totals = []
    for n in (1500, 6000, 24000):
        found = curvature(blob(n))
        assert found.areas @ found.gaussian == pytest.approx(4 * np.pi, rel=1e-10)
        totals.append([found.areas @ found.mean, found.areas.sum()])
    change = np.abs(np.diff(totals, axis=0)) / totals[-1]
    assert (change[1] < change[0] / 2).all()
    assert (change[1] < 0.02).all()
