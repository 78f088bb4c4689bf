"""Dirichlet energies, integrals and pointwise Laplacians of smooth functions under refinement."""

import numpy as np
import pytest

from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere
from beltrami.operators.areas import vertex_areas
from beltrami.operators.laplacian import laplacian


def _square(k):
    """A grid of k x k cells, sheared inside, with a parallel diagonal: irregular angles."""
    i, j = np.meshgrid(np.arange(k + 1), np.arange(k + 1))
    x, y = i.ravel() / k, j.ravel() / k
    bulge = 0.1 * np.sin(np.pi * x) * np.sin(np.pi * y)
    at = (j * (k + 1) + i)[:-1, :-1].ravel()
    quads = np.stack([at, at + 1, at + k + 2, at + k + 1], axis=1)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return Mesh(np.stack([x + bulge, y - 0.7 * bulge], axis=1), faces)


def _slope(errors):
    sizes = 2.0 ** -np.arange(len(errors))
    return np.polyfit(np.log(sizes), np.log(np.abs(errors)), 1)[0]


@pytest.mark.chapter("Q3.5", "P21")
def test_dirichlet_energy_on_the_square():
    cc, ss = (1 / 2 + np.sin(6) / 12), (1 / 2 - np.sin(6) / 12)  # ∫cos² 3x, ∫sin² 3x
    c2, s2 = (1 / 2 + np.sin(4) / 8), (1 / 2 - np.sin(4) / 8)
    exact = 9 * cc * c2 + 4 * ss * s2
    assert exact == pytest.approx(2.9839, abs=1e-4)
    errors = []
    for k in (8, 16, 32):
        mesh = _square(k)
        x, y = mesh.vertices.T
        errors.append(laplacian(mesh).dirichlet_energy(np.sin(3 * x) * np.cos(2 * y)) - exact)
    assert _slope(errors) == pytest.approx(2, abs=0.1)
    assert max(errors) < 0  # the interpolant has less


@pytest.mark.chapter("Q3.5", "P21", "P23")
def test_dirichlet_energy_on_the_sphere():
    errors = []
    for s in (2, 3, 4):
        x, y, _ = icosphere(s).vertices.T
        errors.append(laplacian(icosphere(s)).dirichlet_energy(x * y) - 6 * 4 * np.pi / 15)
    assert _slope(errors) == pytest.approx(2, abs=0.1)


@pytest.mark.chapter("U14")
@pytest.mark.parametrize("kind", ["barycentric", "circumcentric"])
def test_integrals_on_the_square(kind):
    exact = (np.e - 1) * np.sin(1)
    errors = []
    for k in (16, 32, 64):
        mesh = _square(k)
        x, y = mesh.vertices.T
        errors.append(vertex_areas(mesh, kind) @ (np.exp(x) * np.cos(y)) - exact)
    assert _slope(errors) == pytest.approx(2, abs=0.2)
