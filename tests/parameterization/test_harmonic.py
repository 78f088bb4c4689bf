"""Harmonic maps: sparse solves against dense ones, of every size and sign, and what is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltrami.errors import DimensionError, MeshError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import grid, icosphere
from beltrami.operators.weights import edge_weights
from beltrami.parameterization.harmonic import harmonic, plan_harmonic, solve_harmonic
from meshes_of_the_errata import cur, flipped

pytestmark = pytest.mark.chapter("U39", "P72")


def dense(W, held, values):
    W = W.toarray()
    L = np.diag(W.sum(axis=1)) - W
    free = np.setdiff1d(np.arange(len(W)), held)
    psi = np.zeros((len(W), *values.shape[1:]))
    psi[held] = values
    psi[free] = np.linalg.solve(L[np.ix_(free, free)], -L[np.ix_(free, held)] @ values)
    return psi


@given(st.integers(0, 10**6), st.booleans())
def test_against_dense_algebra(seed, symmetric):
    """Weights of both directions over ten decades, some negative, several columns."""
    mesh, rng = icosphere(1), np.random.default_rng(seed)
    W = edge_weights(mesh, "combinatorial").copy()
    W.data = 10.0 ** rng.uniform(-5, 5, W.nnz)
    if symmetric:
        W = (W + W.T).tocsr()
    held = rng.permutation(mesh.n_vertices)[: int(rng.integers(1, 20))]
    values = rng.normal(size=(len(held), 3))
    found = solve_harmonic(W, held, values, mesh.vertices, symmetric=symmetric)
    np.testing.assert_allclose(found, dense(W, held, values), atol=1e-8)
    one = solve_harmonic(W, held, values[:, 0], mesh.vertices, symmetric=symmetric)
    np.testing.assert_allclose(one, found[:, 0], atol=1e-8)


def test_a_plan_serves_other_weights():
    mesh = cur()
    (loop,) = mesh.boundary_loops
    W = edge_weights(mesh, "clamped")
    plan = plan_harmonic(W, loop, mesh.vertices)
    values = mesh.vertices[loop]
    for kind in ("combinatorial", "distance", "cotangent"):
        other = edge_weights(mesh, kind)
        found = solve_harmonic(other, loop, values, mesh.vertices, symmetric=True, plan=plan)
        np.testing.assert_allclose(found, dense(other, loop, values), atol=1e-10)
    everything = np.arange(mesh.n_vertices)
    assert plan_harmonic(W, everything, mesh.vertices) is None
    np.testing.assert_array_equal(harmonic(mesh, everything, mesh.vertices), mesh.vertices)


def test_large_and_indefinite():
    """Enough unknowns for Cholesky; where weights are negative it may not do, and is not used."""
    for mesh in (grid(80, 80), flipped(1, 80, 10)):
        (loop,) = mesh.boundary_loops
        x = mesh.vertices[:, :2]
        found = harmonic(mesh, loop, x[loop], "cotangent")
        W = edge_weights(mesh, "cotangent")
        inner = np.setdiff1d(np.arange(mesh.n_vertices), loop)
        residual = (W @ found - W.sum(axis=1)[:, None] * found)[inner]
        assert np.abs(residual).max() < 1e-10 * np.abs(W.sum(axis=1)).max()


@pytest.mark.parametrize("kind", ["clamped", "mean_value"])
@pytest.mark.parametrize("size", [5, 75])
def test_nothing_held_in_a_component(size, kind):
    one = grid(size, size)
    n = one.n_vertices
    two = Mesh(np.tile(one.vertices, (2, 1)), np.concatenate([one.faces, one.faces + n]))
    loop = one.boundary_loops[0]
    with pytest.raises(MeshError, match="nothing is held") as caught:
        harmonic(two, loop, one.vertices[loop], kind)
    assert caught.value.vertices.tolist() == [n]
    both = np.append(loop, n + 3)
    psi = harmonic(two, both, np.append(np.zeros(len(loop)), 7.0), kind)
    np.testing.assert_allclose(psi[n:], 7, rtol=1e-9)


def test_bad_input():
    mesh = cur()
    with pytest.raises(MeshError, match="twice"):
        harmonic(mesh, [3, 3], [0.0, 1.0])
    with pytest.raises(DimensionError):
        harmonic(mesh, [3, 4], [0.0])
    with pytest.raises(MeshError, match="add to nothing"):
        harmonic(mesh, [3, 4], [0.0, 1.0], lambda domain: np.zeros(len(domain.edges)))
