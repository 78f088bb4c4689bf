"""The Laplacians of graphs against scipy's."""

import numpy as np
import pytest
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components
from scipy.sparse.csgraph import laplacian as csgraph_laplacian

from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import WEIGHTS
from meshes_of_the_errata import MESHES


@pytest.mark.chapter("D14")
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("kind", WEIGHTS)
def test_laplacian_and_degrees(name, kind):
    pair = laplacian(MESHES[name](), kind, "degree")
    L, d = csgraph_laplacian(csr_matrix(pair.weights), return_diag=True)
    assert np.allclose(pair.stiffness.toarray(), L.toarray(), rtol=1e-10, atol=1e-9)
    assert np.allclose(pair.degrees, d, rtol=1e-10)


@pytest.mark.chapter("D15", "P33")
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("kind", WEIGHTS)
def test_normalised(name, kind):
    pair = laplacian(MESHES[name](), kind)
    N, root = csgraph_laplacian(csr_matrix(pair.weights), normed=True, return_diag=True)
    assert np.allclose(pair.normalized.toarray(), N.toarray(), rtol=1e-9, atol=1e-10)
    assert np.allclose(np.sqrt(pair.degrees), root, rtol=1e-10)


@pytest.mark.chapter("P7", "P33")
@pytest.mark.parametrize("seed", [123456789, 987654321])
def test_random_graphs(seed):
    rng = np.random.default_rng(seed)
    W = np.triu(rng.uniform(size=(30, 30)) * (rng.uniform(size=(30, 30)) < 0.15), 1)
    W[np.arange(29), np.arange(1, 30)] += 0.1
    W = csr_matrix(W + W.T)
    pair = laplacian(W)
    assert connected_components(W)[0] == 1
    assert np.allclose(pair.stiffness.toarray(), csgraph_laplacian(W).toarray(), atol=1e-13)
    normed = csgraph_laplacian(W, normed=True).toarray()
    assert np.allclose(pair.normalized.toarray(), normed, atol=1e-13)
