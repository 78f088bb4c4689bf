"""Equation 3.7: ((1 + δ) Id - δ D⁻¹W) F' = F, made symmetric: (D + δL) F' = D F (E54)."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("Q3.7")


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("weights", ["combinatorial", "cotangent"])
@pytest.mark.parametrize("delta", [0.5, 5.0, 1000.0])
def test_it_solves_the_printed_equation(name, weights, delta):
    mesh = MESHES[name]()
    pair = laplacian(mesh, weights, "degree")
    W = oracle.weights(mesh, weights)
    A = W / W.sum(axis=1)[:, None]
    f = oracle.rough_functions(mesh)
    printed = (1 + delta) * np.eye(len(W)) - delta * A
    assert np.abs(printed - printed.T).max() > 0.05  # right, but not symmetric
    got = heat(pair, f, delta, steps=1)
    assert np.allclose(printed @ got, f, atol=1e-8 * max(1, delta))
    assert np.allclose(got, np.linalg.solve(printed, f), rtol=1e-7, atol=1e-8)


@pytest.mark.parametrize("name", IRREGULAR)
def test_the_symbol_is_one_over_one_plus_delta_lambda(name):
    mesh = MESHES[name]()
    pair = laplacian(mesh, "cotangent", "degree")
    values, U = np.linalg.eigh(pair.normalized.toarray())
    modes = U / np.sqrt(pair.degrees)[:, None]
    got = heat(pair, modes, 3.0, steps=1)
    assert np.allclose(got, modes / (1 + 3 * values), atol=1e-9)


@pytest.mark.parametrize("method", ["implicit", "explicit"])
@pytest.mark.parametrize("name", ["open", "bad"])
def test_with_its_boundary_held_a_linear_function_stays(name, method):
    """Whatever the signs of the cotangents: what is held enters on the right with its sign."""
    mesh = MESHES[name]()
    x = mesh.vertices
    boundary = np.unique(mesh.topology.boundary_edges)
    pair = laplacian(mesh, "cotangent", "degree")
    assert np.allclose(heat(pair, x, 5.0, method, 20, hold=boundary), x, atol=1e-10)
    assert np.abs(heat(pair, x, 5.0, method, 20) - x).max() > 0.01
    rough = oracle.rough_functions(mesh, 2)
    rough[boundary] = x[boundary]
    settled = heat(pair, rough, 3000.0, "implicit", 30, hold=boundary)
    assert np.allclose(settled, x, atol=1e-6)
