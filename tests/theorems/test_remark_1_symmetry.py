"""Remark 1, formulas of section 3.2.5: symmetry, constants, and both energies (E28, E43)."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import WEIGHTS
from meshes_of_the_errata import IRREGULAR, MESHES


def _printed_normalized(pair):
    """Id - D^-1/2 W D^1/2, the middle expression of definition 15 (E43)."""
    root = np.sqrt(pair.degrees)
    return np.eye(pair.n) - pair.weights.toarray() * root / root[:, None]


def _random_walk(pair):
    return np.eye(pair.n) - pair.weights.toarray() / pair.degrees[:, None]


def _check_symmetric(matrix):
    assert np.abs(matrix - matrix.T).max() < 1e-12 * np.abs(matrix).max()


@pytest.mark.chapter("R1", "D14", "D15", "P32")
@pytest.mark.parametrize("kind", WEIGHTS)
@pytest.mark.parametrize("name", IRREGULAR)
def test_both_laplacians_are_symmetric_and_one_kills_constants(name, kind):
    pair = laplacian(MESHES[name](), kind)
    L, N = pair.stiffness.toarray(), pair.normalized.toarray()
    ones = np.ones(pair.n)
    for matrix in (L, N):
        _check_symmetric(matrix)
    for wrong in (_printed_normalized(pair), _random_walk(pair)):
        with pytest.raises(AssertionError):
            _check_symmetric(wrong)
        assert np.allclose(wrong.diagonal(), 1)  # which the diagonal does not see
    assert np.abs(L @ ones).max() < 1e-12 * L.max()
    assert np.abs(N @ ones).max() > 0.1
    assert np.allclose(N.diagonal(), 1, atol=4e-16)


@pytest.mark.chapter("R1")
def test_a_regular_mesh_hides_that_the_others_are_not_symmetric():
    """Where all degrees are equal, here 6, all are symmetric."""
    pair = laplacian(MESHES["tor"](), "combinatorial")
    N = pair.normalized.toarray()
    for matrix in (N, _printed_normalized(pair), _random_walk(pair)):
        _check_symmetric(matrix)
    assert np.allclose(N, _random_walk(pair), atol=1e-14)
    assert np.abs(N @ np.ones(pair.n)).max() < 1e-14


def _over_edges(scale):
    """Sum of w (f_i / s_i - f_j / s_j)² over each edge once."""

    def energy(pair, f):
        g, (i, j) = f / scale(pair), pair.edges.T
        return pair.edge_weight @ (g[i] - g[j]) ** 2

    return energy


def _check_energy(pair, matrix, energy):
    f = np.random.default_rng(662607015).normal(size=pair.n)
    assert f @ (matrix @ f) == pytest.approx(energy(pair, f), rel=1e-9)


@pytest.mark.chapter("U19", "U20", "T6")
@pytest.mark.parametrize("kind", WEIGHTS)
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_energies_are_sums_over_each_edge_once(name, kind):
    pair = laplacian(MESHES[name](), kind)
    plain = _over_edges(lambda pair: 1)
    normalized = _over_edges(lambda pair: np.sqrt(pair.degrees))
    _check_energy(pair, pair.stiffness, plain)
    _check_energy(pair, pair.normalized, normalized)
    twice = [lambda p, f, e=e: 2 * e(p, f) for e in (plain, normalized)]  # over E (E28)
    inverse = _over_edges(lambda pair: 1 / np.sqrt(pair.degrees))
    walk = _over_edges(lambda pair: pair.degrees)
    for wrong in (normalized, twice[0]):
        with pytest.raises(AssertionError):
            _check_energy(pair, pair.stiffness, wrong)
    for wrong in (plain, twice[1], inverse, walk):
        with pytest.raises(AssertionError):
            _check_energy(pair, pair.normalized, wrong)


@pytest.mark.chapter("U19", "P30")
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_gradient_squared_is_the_energy(name):
    pair = laplacian(MESHES[name](), "distance")
    f = oracle.rough_functions(MESHES[name](), 1)[:, 0]
    i, j = pair.edges.T
    assert np.allclose(pair.gradient @ f, (f[j] - f[i]) * np.sqrt(pair.edge_weight), rtol=1e-10)
    assert ((pair.gradient @ f) ** 2).sum() == pytest.approx(pair.dirichlet_energy(f))
