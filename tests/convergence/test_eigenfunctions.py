"""Eigenvectors converge to eigenfunctions at order two in L²: lines, or whole eigenspaces (E61)."""

import numpy as np
import pytest
from scipy.special import jn_zeros, jv

import analytic_spectra as truth
from beltrami.mesh.shapes import disk, icosphere
from beltrami.operators.laplacian import laplacian

pytestmark = pytest.mark.chapter("P64", "U27")


def _off(pair, f, space):
    """Distance of f / |f| from the span of B-orthonormal columns."""
    f = f / pair.norm(f)
    return pair.norm(f - space @ (space.T @ (pair.mass @ f)))


@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
def test_simple_ones_of_the_rectangle(mass):
    width = 1.3
    errors = []
    for k in (12, 24, 48):
        mesh = truth.sheared_rectangle(k, width)
        x, y = np.pi * mesh.vertices.T / [[width], [1]]
        pair = laplacian(mesh, mass=mass)
        _, u = truth.smallest_pairs(pair, 6)
        exact = [np.cos(x), np.cos(y), np.cos(x) * np.cos(y), np.cos(2 * x)]
        errors.append([_off(pair, f, u[:, [i + 1]]) for i, f in enumerate(exact)])
    for column in np.transpose(errors):
        assert truth.order(column) == pytest.approx(2, abs=0.15)


def test_eigenspaces_of_the_sphere():
    """The single vectors are any rotation of the harmonics; the spaces converge."""
    errors = []
    for s in (2, 3, 4):
        mesh = icosphere(s)
        x, y, z = mesh.vertices.T
        pair = laplacian(mesh)
        _, u = truth.smallest_pairs(pair, 16)
        harmonics = {
            (4, 9): [x * y, y * z, 3 * z * z - 1],
            (9, 16): [x * y * z, z * (5 * z * z - 3)],
        }
        errors.append(
            [max(_off(pair, f, u[:, a:b]) for f in fs) for (a, b), fs in harmonics.items()]
        )
        assert min(_off(pair, z, u[:, [i]]) for i in (1, 2, 3)) > 0.05
        assert _off(pair, z, u[:, 1:4]) < 1e-3
    for column in np.transpose(errors):
        assert truth.order(column) == pytest.approx(2, abs=0.2)


def test_bessel_functions_on_a_held_disk():
    errors = []
    for rings in (8, 16, 32):
        mesh = disk(rings)
        r = np.linalg.norm(mesh.vertices, axis=1)
        angle = np.arctan2(mesh.vertices[:, 1], mesh.vertices[:, 0])
        pair = laplacian(mesh)
        _, u = truth.smallest_pairs(pair, 6, r > 1 - 1e-9)
        exact = {
            (0, 1): jv(0, jn_zeros(0, 1)[0] * r),
            (1, 3): jv(1, jn_zeros(1, 1)[0] * r) * np.cos(angle - 0.4),
            (5, 6): jv(0, jn_zeros(0, 2)[1] * r),
        }
        errors.append([_off(pair, f, u[:, a:b]) for (a, b), f in exact.items()])
    for column in np.transpose(errors):
        assert 1.85 < truth.order(column) < 2.4
