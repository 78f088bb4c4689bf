"""The free boundary: derivatives against differences, no fold on the way, isometries found."""

import numpy as np
import pytest

from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cylinder, grid, icosphere, torus
from beltrami.parameterization import relaxation
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.distortion import distortion, slopes
from beltrami.parameterization.parameterize import parameterize
from beltrami.parameterization.relaxation import _derivatives, _energy, _first_collapse, relax
from meshes_of_the_errata import cur, open_


def shaken(mesh, size, seed=0):
    x = mesh.vertices[:, :2]
    return x + size * np.random.default_rng(seed).normal(size=x.shape)


def parts(mesh):
    return slopes(mesh), mesh.face_areas


def test_the_energy_is_that_of_the_singular_values():
    mesh = cur()
    x = mesh.vertices[:, :2] * [1.2, 0.8]
    s = distortion(mesh, x).singular_values
    truth = mesh.face_areas @ (s**2 + s**-2).sum(axis=1) / 4
    assert _energy(*parts(mesh), x[mesh.faces]) == pytest.approx(truth)
    assert _energy(*parts(mesh), (x * [-1, 1])[mesh.faces]) == np.inf


def test_the_gradient_is_that_of_differences():
    mesh = open_()
    x = shaken(mesh, 1e-3)
    gradient, _ = _derivatives(mesh, *parts(mesh), x)
    rng = np.random.default_rng(1)
    for _ in range(5):
        d = rng.normal(size=x.shape)
        h = 1e-7
        ahead, behind = (_energy(*parts(mesh), (x + t * d)[mesh.faces]) for t in (h, -h))
        assert gradient @ d.ravel() == pytest.approx(4 * (ahead - behind) / (2 * h), rel=1e-5)


def test_the_hessian_is_that_of_differences_where_nothing_is_projected():
    """Near a dilation by 1.2 all curvatures are positive, so the projection changes nothing."""
    mesh = open_()
    x = 1.2 * mesh.vertices + 1e-4 * np.random.default_rng(0).normal(size=(mesh.n_vertices, 2))
    _, H = _derivatives(mesh, *parts(mesh), x)
    d = np.random.default_rng(1).normal(size=x.shape)
    h = 1e-6
    ahead, behind = (_derivatives(mesh, *parts(mesh), x + t * d)[0] for t in (h, -h))
    truth = (ahead - behind) / (2 * h)
    np.testing.assert_allclose(H @ d.ravel(), truth, atol=1e-5 * np.abs(truth).max())


def test_the_hessian_is_symmetric_and_definite_where_the_energy_is_not_convex():
    mesh = open_()
    x = 0.4 * mesh.vertices  # far too small: the plain Hessian has negative eigenvalues
    gradient, H = _derivatives(mesh, *parts(mesh), x)
    assert abs(H - H.T).max() == 0
    assert np.linalg.eigvalsh(H.toarray()).min() > 0
    d = np.stack([-x[:, 1], x[:, 0]], axis=1)  # turning: negative curvature of a shrunk map
    h = 1e-6
    ahead, behind = (_derivatives(mesh, *parts(mesh), x + t * d)[0] for t in (h, -h))
    assert d.ravel() @ (ahead - behind) < 0
    assert gradient @ x.ravel() < 0


def test_the_first_collapse():
    rng = np.random.default_rng(0)
    x, d = rng.normal(size=(2, 200, 3, 2))
    turn = (x[:, 1] - x[:, 0])[:, 0] * (x[:, 2] - x[:, 0])[:, 1] - (x[:, 1] - x[:, 0])[:, 1] * (
        x[:, 2] - x[:, 0]
    )[:, 0]
    x[turn < 0] = x[turn < 0][:, [0, 2, 1]]
    for f in range(200):
        t = _first_collapse(x[f : f + 1], d[f : f + 1])
        for part in np.linspace(0, min(t, 100), 23)[:-1]:
            u, v = np.diff(x[f] + part * d[f], axis=0)
            assert u[0] * v[1] - u[1] * v[0] > 0
        if np.isfinite(t):
            u, v = np.diff(x[f] + t * d[f], axis=0)
            assert abs(u[0] * v[1] - u[1] * v[0]) < 1e-9 * max(1, t * t)
    still = np.array([[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]])
    assert _first_collapse(still, 0 * still) == np.inf
    assert _first_collapse(still, -still) == pytest.approx(1)


@pytest.mark.chapter("P74")
def test_what_can_be_unrolled_is():
    """Planar, cylindrical and bent sheets have isometric maps, whatever they start from."""
    x, y = grid(12, 12).vertices[:, :2].T
    bent = grid(12, 12).with_vertices(np.stack([np.sin(2 * x), np.cos(2 * x), y], axis=1))
    for mesh in (open_(), bent, cylinder(24, 6)):
        psi = parameterize(mesh, "free")
        assert psi.is_bijective
        assert psi.distortion.symmetric_dirichlet < 1.002
        np.testing.assert_allclose(psi.distortion.singular_values, 1, atol=0.12)


def test_it_is_better_than_any_fixed_boundary_and_stays_a_bijection():
    for mesh in (torus(20, 14), icosphere(2), Mesh(icosphere(3).vertices, icosphere(3).faces[1:])):
        fixed, free = parameterize(mesh), parameterize(mesh, "free")
        assert free.is_bijective
        assert free.distortion.symmetric_dirichlet < 0.95 * fixed.distortion.symmetric_dirichlet
        assert free.distortion.scale == pytest.approx(1, abs=0.5)  # in the unit of length


def test_the_boundary_does_not_cross_itself(monkeypatch):
    """A strip whose isometry overlaps itself: without the check it gets there."""
    n = 40
    t = np.linspace(0, 1.9 * np.pi, n)
    inner, outer = np.stack([np.cos(t), np.sin(t)], 1), 1.3 * np.stack([np.cos(t), np.sin(t)], 1)
    k = np.arange(n - 1)
    faces = np.concatenate([np.stack([k, n + k, n + k + 1], 1), np.stack([k, n + k + 1, k + 1], 1)])
    start = Mesh(np.concatenate([inner, outer]), faces)
    # the same strip with 1.4 times the angle: its isometry overlaps itself
    s = 1.4 * t
    ring = np.stack([np.cos(s), np.sin(s), 0.2 * s], axis=1)
    wound = start.with_vertices(np.concatenate([ring, ring * [1.3, 1.3, 1]]))
    x, steps = relax(wound, start.vertices, 60)
    assert steps > 0
    assert certify(wound.topology, x).is_bijective
    before = distortion(wound, start.vertices).symmetric_dirichlet
    assert distortion(wound, x).symmetric_dirichlet < before
    monkeypatch.setattr(relaxation, "crossings", lambda x, edges: edges[:0])
    unchecked = certify(wound.topology, relax(wound, start.vertices, 60)[0])
    assert len(unchecked.flipped) == 0
    assert len(unchecked.crossings) > 0


def test_what_folds_at_the_start_is_left_as_it_is():
    mesh = open_()
    x = mesh.vertices * [-1, 1]
    found, steps = relax(mesh, x, 10)
    assert steps == 0
    np.testing.assert_allclose(found, x, rtol=1e-9)


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_the_unit_of_length_does_not_matter(unit):
    mesh = torus(12, 8)
    psi, scaled = (
        parameterize(m, "free") for m in (mesh, mesh.with_vertices(mesh.vertices * unit))
    )
    np.testing.assert_allclose(scaled.uv, psi.uv * unit, atol=1e-6 * unit)
