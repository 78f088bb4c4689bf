"""Conformal maps with a free boundary: against dense algebra, and maps that are known."""

import numpy as np
import pytest
import scipy.linalg

from beltrami.errors import FoldedMapError, MeshError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cylinder, grid, icosphere, torus
from beltrami.mesh.tree_cotree import cut_to_disk
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.conformal import (
    _boundary_mass,
    conformal_energy,
    least_squares_conformal,
    spectral_conformal,
)
from beltrami.parameterization.distortion import distortion, slopes
from beltrami.parameterization.flatten import flatten
from beltrami.parameterization.parameterize import parameterize
from meshes_of_the_errata import bad, cur, flipped, open_

METHODS = ("least_squares_conformal", "spectral_conformal")


def energy(mesh, x):
    return 0.5 * x.ravel() @ (conformal_energy(mesh) @ x.ravel())


@pytest.mark.chapter("P76")
@pytest.mark.parametrize("make", [open_, cur, bad], ids=lambda make: make.__name__)
def test_the_energy_is_that_of_the_singular_values(make):
    """Half of (σ₁ - σ₂)² on faces that keep their side, of (σ₁ + σ₂)² on the others."""
    mesh = make()
    x = np.random.default_rng(0).normal(size=(mesh.n_vertices, 2))
    found = distortion(mesh, x)
    a, b, c = x[mesh.faces].transpose(1, 0, 2)
    side = np.sign(np.linalg.det(np.stack([b - a, c - a], axis=1)))
    assert (side < 0).any()
    assert (side > 0).any()
    s = found.singular_values
    truth = mesh.face_areas @ (s[:, 0] - side * s[:, 1]) ** 2 / 2
    assert energy(mesh, x) == pytest.approx(truth, rel=1e-10)


def test_obtuse_angles_do_not_make_it_indefinite():
    """Cotangent weights of a stretched sheet are negative; the energy of maps is not."""
    mesh = flipped(1, 20, 10)
    M = conformal_energy(mesh).toarray()
    np.testing.assert_array_equal(M, M.T)
    values = np.linalg.eigvalsh(M)
    assert values[0] > -1e-12 * values[-1]
    assert np.abs(M @ np.tile([1.0, 0.0], mesh.n_vertices)).max() < 1e-12 * values[-1]


@pytest.mark.parametrize("method", METHODS)
def test_what_can_be_unrolled_is(method):
    x, y = grid(12, 12).vertices[:, :2].T
    bent = grid(12, 12).with_vertices(np.stack([np.sin(2 * x), np.cos(2 * x), y], axis=1))
    for mesh in (open_(), bent, cylinder(24, 6)):
        psi = parameterize(mesh, method)
        assert psi.is_bijective
        np.testing.assert_allclose(psi.distortion.singular_values, 1, atol=1e-6)


@pytest.mark.parametrize("method", METHODS)
def test_the_stereographic_projection_is_found(method):
    """A cap of the sphere has a conformal map to the disk; ours converges to one."""
    errors = []
    for level in (3, 4):
        ball = icosphere(level)
        low = (ball.vertices[ball.faces][:, :, 2] < 0.3).all(axis=1)
        used, local = np.unique(ball.faces[low], return_inverse=True)
        psi = parameterize(Mesh(ball.vertices[used], local.reshape(-1, 3)), method)
        assert psi.is_bijective
        away = (psi.distortion.conformal - 1) ** 2
        errors.append(away @ psi.distortion.areas / psi.distortion.areas.sum())
    assert errors[1] < 0.27 * errors[0]  # second order: a quarter


def test_least_squares_are_those_of_numpy():
    """The text of 2002: the equations of Cauchy and Riemann on each face, in least squares."""
    mesh, held = cur(), np.array([3, 40])
    g = slopes(mesh) * np.sqrt(mesh.face_areas)[:, None, None]
    A = np.zeros((mesh.n_faces, mesh.n_vertices), complex)
    for c in range(3):  # d/dx + i d/dy of u + i v is 0
        np.add.at(A, (np.arange(mesh.n_faces), mesh.faces[:, c]), g[:, c, 0] + 1j * g[:, c, 1])
    others = np.setdiff1d(np.arange(mesh.n_vertices), held)
    z = np.zeros(mesh.n_vertices, complex)
    z[held[1]] = 1
    z[others] = np.linalg.lstsq(A[:, others], -A[:, held] @ z[held])[0]
    found = least_squares_conformal(mesh, held) @ [1, 1j]
    turned = (found - found[held[0]]) / (found[held[1]] - found[held[0]])
    np.testing.assert_allclose(turned, z, atol=1e-9)


@pytest.mark.parametrize(
    "make",
    [
        cur,
        lambda: cut_to_disk(torus(12, 8)).mesh,
        lambda: Mesh(icosphere(1).vertices, icosphere(1).faces[1:]),
    ],
)
def test_the_eigenvector_is_that_of_dense_algebra(make):
    mesh = make()
    M, b = conformal_energy(mesh).toarray(), np.repeat(_boundary_mass(mesh), 2)
    assert b.sum() == pytest.approx(2)
    shares, _ = scipy.linalg.eigh(np.diag(b), M + np.diag(b))  # 1 / (1 + λ), the least λ last
    values = 1 / shares[::-1][:6] - 1
    np.testing.assert_allclose(values[:2], 0, atol=1e-9)  # the constants
    assert values[3] == pytest.approx(values[2], rel=1e-6)  # a turn by 90 degrees
    x = spectral_conformal(mesh)
    x = x - _boundary_mass(mesh) @ x
    quotient = x.ravel() @ M @ x.ravel() / (x.ravel() @ (b * x.ravel()))
    assert quotient == pytest.approx(values[2], rel=1e-8)


@pytest.mark.chapter("P76", "T22")
def test_one_eigenvector_keeps_angles_where_two_do_not():
    """Theorem 22 takes a pair of eigenvectors, which on a long sheet are no conformal pair."""
    mesh = grid(20, 8)
    long = mesh.with_vertices(mesh.vertices * [3, 1])
    assert len(flatten(long).flipped) > 20
    psi = parameterize(long, "spectral_conformal")
    assert psi.is_bijective
    assert psi.distortion.mean_conformal < 1.0001


def test_held_vertices_and_errors():
    mesh = torus(12, 8)
    one = parameterize(mesh, "least_squares_conformal", corners=[0, 40], strict=False)
    other = parameterize(mesh, "least_squares_conformal", corners=[0, 7], strict=False)
    assert abs(one.distortion.mean_conformal - other.distortion.mean_conformal) > 1e-6
    for wrong in ([0, 0], [0], [0, 1, 2], [0, 10**6]):
        with pytest.raises(MeshError):
            parameterize(mesh, "least_squares_conformal", corners=wrong)
    with pytest.raises(MeshError, match="hold no vertex"):
        parameterize(mesh, "spectral_conformal", corners=[0, 1])
    for option in (
        {"weights": "clamped"},
        {"boundary": "square"},
        {"bulge": 0.01},
        {"spacing": "uniform"},
    ):
        with pytest.raises(MeshError, match="free boundary"):
            parameterize(mesh, "spectral_conformal", **option)
    two = Mesh(
        np.tile(grid(2, 2).vertices, (2, 1)),
        np.concatenate([grid(2, 2).faces, grid(2, 2).faces + 9]),
    )
    with pytest.raises(MeshError, match="component") as caught:
        parameterize(two, "least_squares_conformal", corners=[0, 8])
    assert caught.value.vertices.tolist() == [0, 8]
    assert parameterize(two, "spectral_conformal").is_bijective


def test_overlaps_are_told():
    """An open ring of more than a turn: its isometry, which is conformal, overlaps itself."""
    t = np.linspace(0, 2.6 * np.pi, 50)
    ring = np.stack([np.cos(t), np.sin(t), 0.2 * t], axis=1)
    k = np.arange(49)
    faces = np.concatenate([np.stack([k, 50 + k, 51 + k], 1), np.stack([k, 51 + k, k + 1], 1)])
    mesh = Mesh(np.concatenate([ring, ring * [1.3, 1.3, 1]]), faces)
    psi = parameterize(mesh, "spectral_conformal", strict=False)
    assert len(psi.flipped) == 0
    assert len(psi.overlaps) > 0
    assert np.isin(psi.overlaps, psi.mesh.boundary_loops[0]).all()
    with pytest.raises(FoldedMapError, match="cross"):
        parameterize(mesh, "spectral_conformal")
    assert parameterize(mesh, "free").is_bijective


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_the_unit_of_length_does_not_matter(method, unit):
    mesh = cur()
    psi = parameterize(mesh, method, strict=False)
    scaled = parameterize(mesh.with_vertices(mesh.vertices * unit), method, strict=False)
    np.testing.assert_allclose(scaled.uv, psi.uv * unit, atol=1e-5 * unit)


def test_one_triangle():
    mesh = Mesh(np.eye(3), [[0, 1, 2]])
    for method in METHODS:
        np.testing.assert_allclose(parameterize(mesh, method).distortion.singular_values, 1)


def test_large_enough_for_cholesky():
    mesh = grid(60, 60)
    x, y = mesh.vertices[:, :2].T
    bump = mesh.with_vertices(np.stack([x, y, 0.3 * np.exp(-8 * (x**2 + y**2))], axis=1))
    for method in METHODS:
        psi = parameterize(bump, method)
        assert certify(bump.topology, psi.uv).is_bijective
        assert psi.distortion.mean_conformal < 1.02
