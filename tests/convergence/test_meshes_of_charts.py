"""Meshes of parametric surfaces: areas, energies and Laplacians tend to those of the surface."""

import numpy as np
import pytest

import charts
from beltrami.operators.laplacian import laplacian

SIZES = np.array([12, 24, 48])


def f(x, y, z, *_):
    return z + x * y


def _rate(errors):
    return np.polyfit(np.log(SIZES), np.log(np.abs(errors)), 1)[0]


@pytest.mark.chapter("D1")
@pytest.mark.parametrize(
    ("name", "area"), [("sphere", 4 * np.pi), ("torus", 4 * np.pi**2 * 2 * 0.7)]
)
def test_areas(name, area):
    meshes = [getattr(charts, name)().mesh(2 * int(n), int(n)) for n in SIZES]
    errors = [mesh.area - area for mesh in meshes]
    assert _rate(errors) == pytest.approx(-2, abs=0.1)
    assert max(errors) < 0  # inscribed


@pytest.mark.chapter("D1")
def test_the_area_of_a_disk_on_the_sphere():
    exact = 4 * np.pi * 1.5**2 / (1 + 1.5**2)  # 2π (1 - z) at the rim
    errors = [charts.stereographic().mesh(6 * int(n), int(n)).area - exact for n in SIZES]
    assert _rate(errors) == pytest.approx(-2, abs=0.1)


@pytest.mark.chapter("D16")
def test_dirichlet_energies_of_the_cotangent_weights():
    exact = 4 * np.pi * (2 / 3 + 6 / 15)  # -∫ f Δf with f of degrees 1 and 2
    errors = []
    for n in SIZES:
        mesh = charts.sphere().mesh(2 * int(n), int(n))
        errors.append(laplacian(mesh).dirichlet_energy(f(*mesh.vertices.T)) - exact)
    assert _rate(errors) == pytest.approx(-2, abs=0.15)


@pytest.mark.chapter("D16")
@pytest.mark.parametrize("name", ["torus", "klein", "skewed_sphere"])
def test_the_stiffness_is_minus_laplace_beltrami_against_test_functions(name):
    """<Lf, g> tends to -<Δf, g>_B for g that vanishes at the boundary: the mesh is irregular."""
    surface = getattr(charts, name)()
    errors = []
    for n in SIZES:
        mesh = surface.mesh(2 * int(n), int(n))
        u, v = mesh.vertex_data["parameters"].T
        x, y, z = mesh.vertices[:, :3].T
        g = np.exp((x + y) / 3 + z)
        if not mesh.is_closed:
            (u0, u1), (v0, v1) = surface.domain.u, surface.domain.v
            g = g * ((u - u0) * (u1 - u) * (v - v0) * (v1 - v)) ** 2
        pair = laplacian(mesh, mass="barycentric")
        delta = surface.laplace_beltrami(f)(u, v)
        weak = g @ pair.stiffness @ f(*mesh.vertices.T)
        errors.append(weak + pair.inner(delta, g))
    assert _rate(errors) == pytest.approx(-2, abs=0.4)
    assert abs(errors[-1]) < 0.03 * abs(weak)
