"""Definition 15: the normalised Laplacian, with its middle expression corrected (E43, E45)."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import MASSES
from beltrami.operators.weights import WEIGHTS
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("D15")


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("kind", WEIGHTS)
def test_three_expressions(name, kind):
    mesh = MESHES[name]()
    pair = laplacian(mesh, kind)
    W = oracle.weights(mesh, kind)
    d = W.sum(axis=1)
    root, inverse = np.diag(np.sqrt(d)), np.diag(1 / np.sqrt(d))
    one = np.eye(len(d))
    N = pair.normalized.toarray()
    assert np.allclose(N, inverse @ oracle.stiffness(W) @ inverse, atol=1e-9)
    assert np.allclose(N, one - inverse @ W @ inverse, atol=1e-9)
    assert np.allclose(N, one - root @ (W / d[:, None]) @ inverse, atol=1e-9)
    printed = one - inverse @ W @ root
    assert np.abs(N - printed).max() > 0.5
    assert np.abs(printed - printed.T).max() > 0.5
    assert np.abs(N - N.T).max() < 1e-13


@pytest.mark.chapter("T7", "P32")
@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("kind", WEIGHTS)
def test_diagonal_trace_and_kernel(name, kind):
    pair = laplacian(MESHES[name](), kind)
    N = pair.normalized.toarray()
    assert np.allclose(N.diagonal(), 1, atol=1e-14)
    assert np.trace(N) == pytest.approx(pair.n)
    assert np.abs(N @ np.sqrt(pair.degrees)).max() < 1e-10 * np.sqrt(pair.degrees.max())
    assert np.abs(N @ np.ones(pair.n)).max() > 0.1  # constants are not in its kernel (E45)


def test_always_with_d_whatever_the_mass():
    mesh = MESHES["bad"]()
    N = laplacian(mesh, mass="degree").normalized
    for mass in MASSES:
        assert abs(laplacian(mesh, mass=mass).normalized - N).max() < 1e-15
