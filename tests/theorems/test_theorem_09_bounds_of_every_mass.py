"""Theorem 9 for every mass, and for graphs: the bound is exact on one face or edge (E62)."""

import numpy as np
import pytest
from scipy.sparse import csr_array

import dense_oracles as oracle
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import MASSES
from beltrami.operators.weights import WEIGHTS
from meshes_of_the_errata import MESHES, triangle

pytestmark = pytest.mark.chapter("T9", "T16")


def _largest(pair):
    return oracle.spectrum(pair.stiffness.toarray(), pair.mass.toarray())[-1]


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("weights", WEIGHTS)
@pytest.mark.parametrize("angles", [(60, 60), (40, 75), (15, 150), (25, 30)])
def test_one_face_attains_it(angles, weights, mass):
    pair = laplacian(triangle(*angles), weights, mass)
    assert pair.spectral_bound() == pytest.approx(_largest(pair), rel=1e-7)  # roots of a square


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("weights", WEIGHTS)
@pytest.mark.parametrize("name", ["leaves", "pl"])
def test_it_holds_where_faces_share_their_vertices(name, weights, mass):
    """A face brings its part of a mass, not the whole: else the bound of unit masses is wrong."""
    pair = laplacian(MESHES[name](), weights, mass)
    assert _largest(pair) <= pair.spectral_bound() * (1 + 1e-9)


@pytest.mark.parametrize("weight", [0.2, 1.0, 7.0])
def test_one_edge_attains_that_of_a_graph(weight):
    """L = w (1, -1; -1, 1): 2 for the degree mass, 2 w for unit masses."""
    W = csr_array(weight * (1 - np.eye(2)))
    for mass, value in (("degree", 2), ("unit", 2 * weight)):
        pair = laplacian(W, mass=mass)
        assert pair.spectral_bound() == pytest.approx(value) == pytest.approx(_largest(pair))


@pytest.mark.parametrize("mass", ["degree", "unit"])
def test_weights_of_either_sign_on_a_graph(mass):
    """As the disks of Gershgorin say: (Σ w + Σ |w|) / b, also where a path has a weight < 0."""
    W = np.zeros((3, 3))
    W[0, 1] = W[1, 0] = 3
    W[1, 2] = W[2, 1] = 2
    W[0, 2] = W[2, 0] = -1
    pair = laplacian(csr_array(W), mass=mass)
    d, reach = W.sum(axis=1), np.abs(W).sum(axis=1)
    b = d if mass == "degree" else np.ones(3)
    assert pair.spectral_bound() == pytest.approx(((d + reach) / b).max())
    assert _largest(pair) <= pair.spectral_bound()
