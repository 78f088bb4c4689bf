"""The smallest eigenvalues of (L, B) on the sphere: 0, 2, 2, 2, 6 (five times), at order 2."""

import numpy as np
import pytest
from scipy.sparse import csc_array
from scipy.sparse.linalg import eigsh

from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian

pytestmark = pytest.mark.chapter("P35")

EXACT = np.array([0, 2, 2, 2, 6, 6, 6, 6, 6])


def _smallest(subdivisions, mass):
    pair = laplacian(icosphere(subdivisions), mass=mass)
    start = np.random.default_rng(6022140).normal(size=pair.n)
    values = eigsh(
        csc_array(pair.stiffness),
        9,
        csc_array(pair.mass),
        sigma=-0.5,
        v0=start,
        return_eigenvectors=False,
    )
    return np.sort(values)


@pytest.mark.parametrize("mass", ["voronoi", "barycentric", "consistent"])
def test_order_two(mass):
    errors = np.array([np.abs(_smallest(s, mass) - EXACT) for s in (2, 3, 4)])
    assert errors[:, 0].max() < 1e-10  # constants
    assert errors[-1].max() < 0.02  # with the constant of the text: 4 and 12 (E29)
    for first, last in ((1, 4), (4, 9)):
        error = errors[:, first:last].mean(axis=1)
        slope = np.polyfit(np.log([4, 2, 1]), np.log(error), 1)[0]
        if first == 1 and mass != "consistent":
            assert slope > 3  # an inscribed mesh has <Lx, x> = 2 <x, x>_B: only the split is left
        else:
            assert slope == pytest.approx(2, abs=0.1)


def test_with_the_degree_mass_they_are_not_those_of_the_sphere():
    assert _smallest(3, "degree")[1:].max() < 0.5
