"""The free boundary: derivatives against differences, no fold on the way, isometries found."""

from types import SimpleNamespace

import numpy as np
import pytest

from beltrami.errors import SingularMatrixError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cylinder, grid, icosphere, torus
from beltrami.parameterization import relaxation, stepping
from beltrami.parameterization.block_pattern import block_pattern
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.distortion import distortion
from beltrami.parameterization.isometric_energy import (
    first_collapse,
    isometric_energy,
    shrinking,
)
from beltrami.parameterization.parameterize import parameterize
from beltrami.parameterization.predicates import orientation
from beltrami.parameterization.relaxation import relax
from meshes_of_the_errata import cur, open_


def shaken(mesh, size, seed=0):
    x = mesh.vertices[:, :2]
    return x + size * np.random.default_rng(seed).normal(size=x.shape)


def total(mesh, x, t=1.0):
    grown, shrunk = isometric_energy(mesh).sums(x)
    return grown * t**2 + shrunk / t**2


def derivatives(mesh, x, t=1.0, free=None):
    free = np.ones(mesh.n_vertices, bool) if free is None else free
    pattern = block_pattern(mesh, free)
    gradient, entries = isometric_energy(mesh).derivatives(x, t, pattern)
    return gradient.ravel(), pattern.matrix(entries)


def test_the_energy_is_that_of_the_singular_values():
    mesh = cur()
    x = mesh.vertices[:, :2] * [1.2, 0.8]
    s = distortion(mesh, x).singular_values
    grown, shrunk = isometric_energy(mesh).sums(x)
    assert grown == pytest.approx(mesh.face_areas @ (s**2).sum(axis=1) / mesh.area)
    assert shrunk == pytest.approx(mesh.face_areas @ (s**-2).sum(axis=1) / mesh.area)
    assert isometric_energy(mesh).sums(x * [-1, 1]) == (np.inf, np.inf)


@pytest.mark.parametrize("t", [1.0, 0.7])
def test_the_gradient_is_that_of_differences(t):
    mesh = open_()
    x = shaken(mesh, 1e-3)
    gradient, _ = derivatives(mesh, x, t)
    rng = np.random.default_rng(1)
    for _ in range(5):
        d = rng.normal(size=x.shape)
        h = 1e-7
        ahead, behind = (total(mesh, x + step * d, t) for step in (h, -h))
        assert gradient @ d.ravel() == pytest.approx((ahead - behind) / (2 * h), rel=1e-5)


def test_the_gradient_alone_is_the_same():
    mesh = open_()
    free = ~mesh.topology.on_boundary
    pattern = block_pattern(mesh, free)
    energy = isometric_energy(mesh)
    for x in (shaken(mesh, 1e-2), mesh.vertices[:, :2] * [3.0, 0.2]):
        whole, _ = energy.derivatives(x, 0.8, pattern)
        size = np.abs(energy.derivatives(x, 0.8, block_pattern(mesh, free | True))[0]).max()
        np.testing.assert_allclose(
            energy.gradient(x, 0.8, pattern), whole, rtol=1e-10, atol=1e-13 * size
        )


def test_the_hessian_is_that_of_differences_where_nothing_is_projected():
    """Near a dilation by 1.2 all curvatures are positive, so the projection changes nothing."""
    mesh = open_()
    x = 1.2 * mesh.vertices + 1e-4 * np.random.default_rng(0).normal(size=(mesh.n_vertices, 2))
    _, H = derivatives(mesh, x)
    d = np.random.default_rng(1).normal(size=x.shape)
    h = 1e-6
    ahead, behind = (derivatives(mesh, x + t * d)[0] for t in (h, -h))
    truth = (ahead - behind) / (2 * h)
    np.testing.assert_allclose(H @ d.ravel(), truth, atol=1e-5 * np.abs(truth).max())


def test_the_hessian_is_definite_where_the_energy_is_not_convex():
    mesh = open_()
    x = 0.4 * mesh.vertices  # far too small: the plain Hessian has negative eigenvalues
    gradient, H = derivatives(mesh, x)
    assert abs(H - H.T).max() < 1e-14 * abs(H).max()
    assert np.linalg.eigvalsh(H.toarray()).min() > -1e-13 * abs(H).max()
    d = np.stack([-x[:, 1], x[:, 0]], axis=1)  # turning: negative curvature of a shrunk map
    h = 1e-6
    ahead, behind = (derivatives(mesh, x + t * d)[0] for t in (h, -h))
    assert d.ravel() @ (ahead - behind) < 0
    assert gradient @ x.ravel() < 0


def test_held_vertices_are_left_out():
    """Gradient and Hessian are the parts of the whole ones."""
    mesh = cur()
    x = mesh.vertices[:, :2] + 1e-3 * np.random.default_rng(0).normal(size=(mesh.n_vertices, 2))
    free = ~mesh.topology.on_boundary
    gradient, H = derivatives(mesh, x)
    part, P = derivatives(mesh, x, free=free)
    both = np.repeat(free, 2)
    np.testing.assert_allclose(part, gradient[both])
    np.testing.assert_allclose(P.toarray(), H.toarray()[np.ix_(both, both)])
    assert P.has_sorted_indices


def test_the_first_collapse():
    rng = np.random.default_rng(0)
    x, d = rng.normal(size=(2, 200, 3, 2))
    one = Mesh(np.eye(3, 2), [[0, 1, 2]])
    for f in range(200):
        u, v = np.diff(x[f], axis=0)
        if u[0] * v[1] - u[1] * v[0] < 0:
            x[f] = x[f][[0, 2, 1]]
        t = first_collapse(one, x[f], d[f])
        for part in np.linspace(0, min(t, 100), 23)[:-1]:
            u, v = np.diff(x[f] + part * d[f], axis=0)
            assert u[0] * v[1] - u[1] * v[0] > 0
        if np.isfinite(t):
            u, v = np.diff(x[f] + t * d[f], axis=0)
            assert abs(u[0] * v[1] - u[1] * v[0]) < 1e-9 * max(1, t * t)
    still = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    assert first_collapse(one, still, 0 * still) == np.inf
    assert first_collapse(one, still, -still) == pytest.approx(1)


def test_which_faces_a_step_leaves_little_of():
    mesh = open_()
    rng = np.random.default_rng(3)
    x, d = mesh.vertices[:, :2], 0.1 * rng.normal(size=(mesh.n_vertices, 2))

    def areas(y):
        u, v = (y[mesh.faces[:, k]] - y[mesh.faces[:, 0]] for k in (1, 2))
        return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]

    for share in (0.2, 0.9):
        expected = areas(x + d) < share * areas(x)
        assert 0 < expected.sum() < mesh.n_faces
        np.testing.assert_array_equal(shrinking(mesh, x, d, share), expected)


def test_steps_by_a_factor_that_is_kept_lower_the_energy_more(monkeypatch):
    mesh = Mesh(icosphere(3).vertices, icosphere(3).faces[1:])
    held = mesh.topology.on_boundary
    start = parameterize(mesh, "tutte", cut=False).uv

    def energy(kept, steps):
        monkeypatch.setattr(relaxation, "_KEPT", kept)
        x, done = relax(mesh, start, steps, held, 1e-9)
        assert done == steps
        return distortion(mesh, x).symmetric_dirichlet

    assert energy(3, 6) < energy(1, 6)


def test_a_fixed_boundary_stays_and_the_inside_is_stationary():
    mesh = torus(20, 14)
    start = parameterize(mesh, "tutte", "clamped")
    disk, held = start.mesh, start.mesh.topology.on_boundary
    x, steps = relax(disk, start.uv, 50, held, 1e-9)
    assert steps > 3
    np.testing.assert_array_equal(x[held], start.uv[held])
    assert certify(disk.topology, x).is_bijective
    before, after = (distortion(disk, at).symmetric_dirichlet for at in (start.uv, x))
    assert after < 0.97 * before
    sums = isometric_energy(disk).sums(x)
    t = (sums[1] / sums[0]) ** 0.25  # at the best scale
    gradient, _ = derivatives(disk, x, t, ~held)
    whole, _ = derivatives(disk, start.uv, t, ~held)
    assert np.abs(gradient).max() < 1e-4 * np.abs(whole).max()
    assert (
        relax(disk, start.uv, 50, np.ones(disk.n_vertices, bool), 1e-4)[1] == 0
    )  # nothing can move


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
        assert free.distortion.symmetric_dirichlet < 0.999 * fixed.distortion.symmetric_dirichlet
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
    x, steps = relax(wound, start.vertices, 60, None, 1e-4)
    assert steps > 0
    assert certify(wound.topology, x).is_bijective
    before = distortion(wound, start.vertices).symmetric_dirichlet
    assert distortion(wound, x).symmetric_dirichlet < before
    monkeypatch.setattr(stepping, "crossings", lambda x, edges: edges[:0])
    unchecked = certify(wound.topology, relax(wound, start.vertices, 60, None, 1e-4)[0])
    assert len(unchecked.flipped) == 0
    assert len(unchecked.crossings) > 0


def test_lost_pivots_are_no_disaster(monkeypatch):
    """LU serves where Cholesky does not; where neither does, the map stays as it was."""
    mesh = open_()
    x = shaken(mesh, 1e-3)
    usual, _ = relax(mesh, x, 3, None, 1e-9)

    def fails(*given):
        raise SingularMatrixError("no pivot")

    monkeypatch.setattr(relaxation, "factorize_cholesky", fails)
    np.testing.assert_allclose(relax(mesh, x, 3, None, 1e-9)[0], usual, atol=1e-7)
    monkeypatch.setattr(relaxation, "factorize", fails)
    same, steps = relax(mesh, x, 3, None, 1e-9)
    assert steps == 0
    assert certify(mesh.topology, same).is_bijective


def test_what_folds_at_the_start_is_left_as_it_is():
    mesh = open_()
    x = mesh.vertices * [-1, 1]
    found, steps = relax(mesh, x, 10, None, 1e-4)
    assert steps == 0
    np.testing.assert_allclose(found, x, rtol=1e-9)


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_the_unit_of_length_does_not_matter(unit):
    mesh = torus(12, 8)
    psi, scaled = (
        parameterize(m, "free") for m in (mesh, mesh.with_vertices(mesh.vertices * unit))
    )
    np.testing.assert_allclose(scaled.uv, psi.uv * unit, atol=1e-6 * unit)


CORNER = Mesh([[0.0, 0], [1, 0], [0, 1]], [[0, 1, 2]])  # its map has the determinant u × v
THIN = np.array([[0.0, 0], [1, 0], [0.5, 1e-30]])
TURNED = np.array(  # over, by less than the rounding of the determinant, 9e-16
    [
        [3.773675439784382, 3.4355118193187146],
        [1.1165413367618093, 1.0164867171041838],
        [1.9891478109538643, 1.810897869715688],
    ]
)


def evened(before, after):
    """Return what is left of a sweep over a triangle, and whether it was taken."""
    around = SimpleNamespace(swept=lambda x, scale, count, rough: after)
    x, energy = relaxation._evened(
        isometric_energy(CORNER), before, 1.0, around, 7.0, np.ones(3, bool)
    )
    assert (energy == 7.0) == (x is before)
    return x, x is not before


def rounded(a, b, c):
    u, v = b - a, c - a
    return np.sign(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).astype(np.int8)


def test_a_sweep_that_turns_a_face_over_by_less_than_a_rounding_is_not_taken(monkeypatch):
    """Its energy is finite, and less than before: only the exact sign tells. Rounded ones err."""
    corners = [corner[None] for corner in TURNED]
    assert (orientation(*corners), rounded(*corners)) == (-1, 1)
    assert np.isfinite(total(CORNER, TURNED))
    assert total(CORNER, TURNED) < total(CORNER, THIN)
    x, taken = evened(THIN, TURNED)
    assert not taken
    assert certify(CORNER, x).is_bijective
    monkeypatch.setattr(relaxation, "orientation", rounded)
    x, taken = evened(THIN, TURNED)
    assert taken
    assert not certify(CORNER, x).is_bijective


def test_a_sweep_is_taken_if_the_energy_falls():
    right = CORNER.vertices[:, :2]
    x, taken = evened(THIN, right)
    assert taken
    np.testing.assert_array_equal(x, right)
    assert not evened(right, THIN)[1]
    assert not evened(right, right)[1]
    assert not evened(right, right * [1, np.nan])[1]
