"""Eigenvalues of (L, B) on the square and on the flat torus of R⁴, at order two (P35, E30)."""

import numpy as np
import pytest
from scipy.sparse import csc_array
from scipy.sparse.linalg import eigsh

from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian

pytestmark = pytest.mark.chapter("P21", "P35")
SQUARE = np.pi**2 * np.array([0, 1, 1, 2, 4, 4, 5, 5])
TORUS = np.array([0, 1, 1, 1, 1, 2, 2, 2, 2])


def _square(k):
    """A sheared grid of k x k cells: irregular angles, natural boundary."""
    i, j = np.meshgrid(np.arange(k + 1), np.arange(k + 1))
    x, y = i.ravel() / k, j.ravel() / k
    bulge = 0.1 * np.sin(np.pi * x) * np.sin(np.pi * y)
    at = (j * (k + 1) + i)[:-1, :-1].ravel()
    quads = np.stack([at, at + 1, at + k + 2, at + k + 1], axis=1)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return Mesh(np.stack([x + bulge, y - 0.7 * bulge], axis=1), faces)


def _torus(k):
    """(cos u, sin u, cos v, sin v), with u and v pushed off the grid."""
    i, j = np.meshgrid(np.arange(k), np.arange(k))
    s, t = 2 * np.pi * i.ravel() / k, 2 * np.pi * j.ravel() / k
    u, v = s + 0.2 * np.sin(t), t + 0.15 * np.sin(s)
    at = [((j + b) % k * k + (i + a) % k).ravel() for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    faces = np.concatenate([np.stack(at[:3], 1), np.stack([at[0], at[2], at[3]], 1)])
    return Mesh(np.stack([np.cos(u), np.sin(u), np.cos(v), np.sin(v)], axis=1), faces)


def _smallest(mesh, mass, count):
    pair = laplacian(mesh, mass=mass)
    start = np.random.default_rng(6022141).normal(size=pair.n)
    B = csc_array(pair.mass)
    L = csc_array(pair.stiffness)
    return np.sort(eigsh(L, count, B, sigma=-0.5, v0=start, return_eigenvectors=False))


@pytest.mark.parametrize("mass", ["voronoi", "barycentric", "consistent"])
@pytest.mark.parametrize(("make", "exact"), [(_square, SQUARE), (_torus, TORUS)])
def test_order_two(make, exact, mass):
    errors = [np.abs(_smallest(make(k), mass, len(exact)) - exact).max() for k in (12, 24, 48)]
    assert np.polyfit(np.log([4, 2, 1]), np.log(errors), 1)[0] == pytest.approx(2, abs=0.2)
    assert errors[-1] < 0.02 * exact[-1]


@pytest.mark.parametrize(("make", "exact"), [(_square, SQUARE), (_torus, TORUS)])
def test_the_masses_without_areas_are_not_of_the_surface(make, exact):
    for mass in ("degree", "unit"):
        values = _smallest(make(24), mass, len(exact))
        assert values[1:].max() < 0.5 * exact[1]
