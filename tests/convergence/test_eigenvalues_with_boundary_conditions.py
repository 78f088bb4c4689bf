"""Dirichlet, Neumann and mixed boundaries: rectangle, disk, tube; at order two."""

import numpy as np
import pytest

import analytic_spectra as truth
from beltrami.mesh.shapes import cylinder, disk
from beltrami.operators.laplacian import laplacian

pytestmark = pytest.mark.chapter("P64")

D, N = "dirichlet", "neumann"
AROUND = [(D, D, D, D), (D, N, N, N), (D, D, N, N), (D, N, D, N), (N, N, N, N)]
WIDTH = 1.3  # so that few eigenvalues of the rectangle are equal


def _rectangle(k, around, mass):
    mesh = truth.sheared_rectangle(k, WIDTH)
    held = [m for m, side in zip(truth.sides(mesh, WIDTH), around, strict=True) if side == D]
    hold = np.any(held, axis=0) if held else None
    return truth.smallest(laplacian(mesh, mass=mass), 8, hold)


@pytest.mark.parametrize("around", AROUND, ids="".join)
@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
def test_rectangle(around, mass):
    exact = truth.sums(8, truth.interval(WIDTH, *around[:2]), truth.interval(1, *around[2:]))
    found = [_rectangle(k, around, mass) for k in (12, 24, 48)]
    errors = [np.abs(values - exact).max() for values in found]
    assert truth.order(errors) == pytest.approx(2, abs=0.15)
    assert errors[-1] < 0.01 * exact[-1]
    wrong = truth.sums(8, truth.interval(WIDTH, D, N), truth.interval(1, N, D))
    assert around == (D, N, D, N) or np.abs(found[-1] - wrong).max() > 1


@pytest.mark.parametrize("around", AROUND, ids="".join)
def test_with_the_consistent_mass_they_come_from_above(around):
    """A subspace of the functions of the surface: each λ is a minimum over less (Courant, Fischer).

    The sides of the rectangle are exact, so that nothing else is approximated; lumped masses do
    not have this.
    """
    exact = truth.sums(8, truth.interval(WIDTH, *around[:2]), truth.interval(1, *around[2:]))
    assert (_rectangle(16, around, "consistent") >= exact - 1e-9).all()
    assert (_rectangle(16, around, "voronoi") < exact - 1e-3).any()


@pytest.mark.parametrize("boundary", [D, N])
@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
def test_disk(boundary, mass):
    exact = truth.disk(9, boundary)
    errors = []
    for rings in (8, 16, 32):
        mesh = disk(rings)
        rim = np.linalg.norm(mesh.vertices, axis=1) > 1 - 1e-9
        values = truth.smallest(laplacian(mesh, mass=mass), 9, rim if boundary == D else None)
        errors.append(np.abs(values - exact).max())
    assert truth.order(errors) == pytest.approx(2, abs=0.1)
    assert errors[-1] < 0.01 * exact[-1]
    for i in [1, 3] if boundary == N else [1, 3, 6]:  # m >= 1 comes twice, as cosine and sine
        assert values[i + 1] - values[i] < 0.1
    assert values[1] - values[0] > 3


@pytest.mark.parametrize(("below", "above"), [(D, D), (D, N), (N, N)])
def test_tube(below, above):
    """The side of a cylinder is flat: circle times interval, whatever the radius."""
    radius, height = 0.7, 1.5
    exact = truth.sums(8, truth.circle(2 * np.pi * radius), truth.interval(height, below, above))
    errors = []
    for k in (1, 2, 4):
        mesh = cylinder(16 * k, 6 * k, radius, height)
        z = mesh.vertices[:, 2]
        hold = (z < -0.74) & (below == D) | (z > 0.74) & (above == D)
        values = truth.smallest(laplacian(mesh), 8, hold)
        errors.append(np.abs(values - exact).max())
    assert truth.order(errors) == pytest.approx(2, abs=0.15)
    assert errors[-1] < 0.02 * exact[-1]


def test_more_held_is_higher():
    """Bracketing: each eigenvalue grows with the part of the boundary that is held."""
    chain = [(N, N, N, N), (D, N, N, N), (D, D, N, N), (D, D, D, N), (D, D, D, D)]
    values = np.array([_rectangle(16, around, "voronoi") for around in chain])
    assert (np.diff(values, axis=0) > 0).all()
