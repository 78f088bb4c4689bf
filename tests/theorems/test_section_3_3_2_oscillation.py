"""Section 3.3.2: large eigenvalues oscillate more (P51): energies, and Courant's theorem."""

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.stats import spearmanr

from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.nodal_domains import nodal_domains
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("P51")

PAIRS = (
    ("combinatorial", "degree"),
    ("combinatorial", "unit"),
    ("distance", "unit"),
    ("clamped", "voronoi"),
)


def _counts(pair, basis, kind):
    return [nodal_domains(pair, u, kind).count for u in basis.eigenvectors.T]


def _excess(basis, counts, allowed):
    """By how many domains some eigenvector exceeds what is allowed for (k, r), at most."""
    values = basis.eigenvalues
    near = 1e-9 * values[-1]
    k = np.searchsorted(values, values - near) + 1
    r = np.searchsorted(values, values + near) - k + 1
    return (counts - allowed(k, r)).max()


def _strong(k, r):
    return k + r - 1


def _weak(k, r):
    return k


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize(("kind", "mass"), PAIRS)
def test_courant(name, kind, mass):
    pair = laplacian(MESHES[name](), kind, mass)
    basis = fourier_basis(pair, pair.n)
    weak = _counts(pair, basis, "weak")
    assert _excess(basis, _counts(pair, basis, "strong"), _strong) == 0
    assert _excess(basis, weak, _weak) == 0  # reached by the first and the second
    assert _excess(basis, weak, lambda k, r: k - 1) == 1  # so no smaller bound holds


def test_multiple_eigenvalues_have_more_strong_domains():
    """On a star the bound k for strong domains fails, and k + r - 1 is sharp."""
    n = 8
    W = np.zeros((n, n))
    W[0, 1:] = W[1:, 0] = 1
    pair = laplacian(csr_array(W), mass="unit")
    basis = fourier_basis(pair, n)
    assert np.allclose(basis.eigenvalues, [0, *[1] * (n - 2), n])
    f = np.zeros(n)
    f[1:] = [1, 2, 3, 4, -2, -3, -5]
    assert np.allclose(pair.apply(f), f)  # λ = 1, zero in the middle
    assert nodal_domains(pair, f).count == n - 1 == _strong(2, n - 2)
    assert nodal_domains(pair, f, "weak").count == 2
    assert _excess(basis, _counts(pair, basis, "strong"), _strong) <= 0
    assert _excess(basis, _counts(pair, basis, "weak"), _weak) == 0


def test_negative_weights_are_not_covered():
    """A positive semi-definite L with a simple λ_2 whose eigenvector has three weak domains."""
    W = np.zeros((6, 6))
    for i, j, w in [(0, 1, 1), (0, 2, -1), (0, 3, 2), (0, 4, 3), (0, 5, -1), (1, 3, 3), (1, 4, 2),
                    (1, 5, 3), (2, 3, 2), (3, 4, 2)]:  # fmt: skip
        W[i, j] = W[j, i] = w
    pair = laplacian(csr_array(W), mass="unit")
    basis = fourier_basis(pair, 6)
    assert basis.eigenvalues[1] > 0.3
    assert basis.eigenvalues[2] - basis.eigenvalues[1] > 0.5
    assert nodal_domains(pair, basis.eigenvectors[:, 1], "weak").count == 3


@pytest.mark.parametrize("name", IRREGULAR)
def test_the_second_eigenvector_cuts_in_two(name):
    pair = laplacian(MESHES[name](), "combinatorial")
    u = fourier_basis(pair, 2).eigenvectors
    assert nodal_domains(pair, u[:, 0]).count == 1
    assert nodal_domains(pair, u[:, 1]).count == 2


def test_on_a_path_the_k_th_has_k_domains():
    """Sturm: in one dimension the count is exact, and the order is that of the eigenvalues."""
    W = np.diag(np.random.default_rng(3).uniform(0.2, 5, 29), 1)
    pair = laplacian(csr_array(W + W.T))
    basis = fourier_basis(pair, 30)
    counts = [nodal_domains(pair, u).count for u in basis.eigenvectors.T]
    assert counts == list(range(1, 31))
    of_averaging = counts[::-1]  # W̃ has the eigenvalues 1 - λ: its large ones oscillate least
    assert of_averaging != sorted(of_averaging)


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize(("kind", "mass"), [*PAIRS, ("cotangent", "voronoi")])
def test_the_eigenvalue_is_the_energy(name, kind, mass):
    """What oscillation means without counting: <Lu, u> = λ for <u, u>_B = 1."""
    pair = laplacian(MESHES[name](), kind, mass)
    basis = fourier_basis(pair, pair.n)
    energies = [pair.dirichlet_energy(u) for u in basis.eigenvectors.T]
    assert np.allclose(energies, basis.eigenvalues, atol=1e-11 * basis.eigenvalues[-1])
    assert (np.diff(energies) >= -1e-11 * basis.eigenvalues[-1]).all()


@pytest.mark.parametrize("name", IRREGULAR)
def test_signs_change_along_more_and_more_edges(name):
    """A trend only: single steps may go back, so a test of each step would be wrong."""
    pair = laplacian(MESHES[name](), "combinatorial", "degree")
    u = fourier_basis(pair, pair.n).eigenvectors
    i, j = pair.edges.T
    changes = (u[i] * u[j] < 0).sum(axis=0)
    assert spearmanr(np.arange(pair.n), changes).statistic > 0.95
    assert (np.diff(changes) < 0).any()
    assert changes[-1] > 0.55 * len(pair.edges)
    domains = [nodal_domains(pair, column).count for column in u.T]
    assert spearmanr(np.arange(pair.n), domains).statistic > 0.8


def test_zonal_harmonics():
    """The zonal one of degree l has l + 1 domains, and l (l + 1) is the (l² + 1)th eigenvalue."""
    mesh = icosphere(4)
    z = mesh.vertices @ [0.36, 0.48, 0.8]
    for degree in range(7):
        f = np.polynomial.legendre.Legendre.basis(degree)(z)
        assert nodal_domains(mesh, f).count == degree + 1
    assert nodal_domains(mesh, f, "weak").count == degree + 1
