"""Equation 3.6: F' = (1 - δ) F + δ D⁻¹W F (E51)."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.diffusion.smoothing import smooth
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("Q3.6")


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("delta", [0.25, 0.9, 1.0])
def test_one_step(name, delta):
    mesh = MESHES[name]()
    pair = laplacian(mesh, "combinatorial", "degree")
    W = oracle.weights(mesh, "combinatorial")
    A = W / W.sum(axis=1)[:, None]
    f = oracle.rough_functions(mesh)
    expected = (1 - delta) * f + delta * A @ f
    assert np.allclose(heat(pair, f, delta, "explicit", 1), expected, atol=1e-13)
    assert np.allclose(smooth(pair, f, 1, delta), expected, atol=1e-13)
    literal = (np.eye(len(W)) - delta) @ f + delta * A @ f  # "Id - δ", on every entry
    assert np.abs(literal - expected).max() > 0.5


@pytest.mark.parametrize("name", IRREGULAR)
def test_the_symbol_is_one_minus_delta_lambda(name):
    mesh = MESHES[name]()
    pair = laplacian(mesh, "cotangent", "degree")
    values, U = np.linalg.eigh(pair.normalized.toarray())
    modes = U / np.sqrt(pair.degrees)[:, None]
    got = heat(pair, modes, 0.6, "explicit", 1)
    assert np.allclose(got, modes * (1 - 0.6 * values), atol=1e-9)
