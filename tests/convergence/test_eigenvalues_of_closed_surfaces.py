"""The discrete spectrum of closed surfaces (P64): sphere, tori; multiplicities; Weyl's law."""

import numpy as np
import pytest

import analytic_spectra as truth
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import disk, icosphere, torus
from beltrami.operators.laplacian import laplacian

pytestmark = pytest.mark.chapter("P64")


@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
def test_the_sphere_has_clusters_of_2l_plus_1(mass):
    values = truth.smallest(laplacian(icosphere(4), mass=mass), 64)
    assert np.allclose(values, truth.sphere(64), rtol=0.025, atol=1e-9)
    gaps = np.diff(values)
    largest = np.sort(np.argsort(gaps)[-7:]) + 1  # where the seven largest gaps are
    assert largest.tolist() == [1, 4, 9, 16, 25, 36, 49]  # (l + 1)² eigenvalues up to l


def test_relative_errors_grow_like_the_eigenvalue():
    """|λ_h - λ| <= c h² λ²: the high end of the spectrum of a mesh is not that of the surface."""
    exact = truth.sphere(64)
    values = truth.smallest(laplacian(icosphere(3), mass="consistent"), 64)
    relative = (values[1:] - exact[1:]) / exact[1:]
    assert np.polyfit(np.log(exact[1:]), np.log(relative), 1)[0] == pytest.approx(1, abs=0.15)


@pytest.mark.parametrize("mass", ["voronoi", "barycentric", "consistent"])
def test_torus_of_revolution(mass):
    """Curved, of both signs; its spectrum from ordinary differential equations."""
    exact = truth.torus_of_revolution(9, 1, 0.4)
    errors = []
    for k in (1, 2, 4):
        pair = laplacian(torus(24 * k, 12 * k, 1, 0.4), mass=mass)
        errors.append(np.abs(truth.smallest(pair, 9) - exact).max())
    assert truth.order(errors) == pytest.approx(2, abs=0.1)
    flat = truth.sums(9, truth.circle(2 * np.pi), truth.circle(0.8 * np.pi))
    assert np.abs(exact - flat).max() > 0.2  # not that of the flat torus with the same circles


def test_flat_torus_with_two_lengths():
    a, b = 1.0, 1.7
    exact = truth.sums(5, truth.circle(a), truth.circle(b))
    errors = []
    for k in (12, 24, 48):
        u, v = np.meshgrid(2 * np.pi * np.arange(k) / k, 2 * np.pi * np.arange(k) / k)
        u, v = u + 0.2 * np.sin(v), v + 0.15 * np.sin(u)
        x = np.stack([a * np.cos(u), a * np.sin(u), b * np.cos(v), b * np.sin(v)], axis=-1)
        i, j = np.meshgrid(np.arange(k), np.arange(k))
        at = [((j + t) % k * k + (i + s) % k).ravel() for s, t in ((0, 0), (1, 0), (1, 1), (0, 1))]
        faces = np.concatenate([np.stack(at[:3], 1), np.stack([at[0], at[2], at[3]], 1)])
        mesh = Mesh(x.reshape(-1, 4) / (2 * np.pi), faces)
        errors.append(np.abs(truth.smallest(laplacian(mesh), 5) - exact).max())
    assert truth.order(errors) == pytest.approx(2, abs=0.15)


def _refined_means(make, kind, mass):
    return [truth.smallest(laplacian(make(s), kind, mass), 4)[1:].mean() for s in (2, 3, 4)]


def test_the_gap_stays_open():
    """A discrete spectrum: λ_2 tends to 2 on the sphere, and not to 0 as without areas."""
    assert np.allclose(_refined_means(icosphere, "cotangent", "voronoi"), 2, atol=1e-3)
    for kind, mass in (("cotangent", "degree"), ("combinatorial", "degree"), ("cotangent", "unit")):
        means = _refined_means(icosphere, kind, mass)
        assert means[2] < 0.3 * means[1] < 0.1 * means[0]


@pytest.mark.parametrize(
    ("make", "area"),
    [(lambda: icosphere(4), 4 * np.pi), (lambda: torus(96, 40, 1, 0.4), 1.6 * np.pi**2)],
)
def test_weyl(make, area):
    """λ_k ~ 4π k / area on every closed surface, whatever its shape."""
    k = np.arange(60, 140)
    values = truth.smallest(laplacian(make()), 140)[60:]
    assert (values * area / (4 * np.pi * k)).mean() == pytest.approx(1, abs=0.04)
    assert (values * area / (2 * np.pi * k)).mean() > 1.9  # not half of it (E29)


def test_weyl_with_a_boundary():
    """N(λ) = (area λ ∓ length √λ) / 4π + ...: held boundaries take modes away, free ones add."""
    mesh = disk(32)
    rim = np.linalg.norm(mesh.vertices, axis=1) > 1 - 1e-9
    pair = laplacian(mesh)
    for sign, hold in ((-1, rim), (1, None)):
        values = truth.smallest(pair, 120, hold)[40:]
        count = np.arange(40, 120) + 0.5
        area, length = np.pi, 2 * np.pi
        two = (area * values + sign * length * np.sqrt(values)) / (4 * np.pi)
        one = area * values / (4 * np.pi)
        assert np.abs((two - count).mean()) < 3
        assert sign * (count - one).mean() > 6


def test_the_eigenvectors_are_a_basis_of_the_functions_on_the_surface():
    """Orthogonal for the integral over the surface; smooth functions are nearly in few of them."""
    mesh = icosphere(4)
    pair = laplacian(mesh, mass="consistent")  # products of linear functions integrate exactly
    _, u = truth.smallest_pairs(pair, 81)
    assert np.allclose(u.T @ (pair.mass @ u), np.eye(81), atol=1e-10)
    f = np.exp(mesh.vertices @ [0.3, -0.5, 0.8])
    errors = []
    for degree in range(5):
        part = u[:, : (degree + 1) ** 2]
        errors.append(pair.norm(f - part @ (part.T @ (pair.mass @ f))))
    ratios = np.array(errors[1:]) / errors[:-1]
    assert (ratios < 0.4).all()
    assert (np.diff(ratios) < 0).all()  # faster than any geometric series: f is analytic
