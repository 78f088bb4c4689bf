"""Theorem 8: L̃ = UΛU' with orthonormal U, and expansions in it (E61, E71)."""

import numpy as np
import pytest
import scipy.linalg

import dense_oracles as oracle
from beltrami.grids.grid import Grid
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import WEIGHTS
from beltrami.spectrum.fourier_basis import fourier_basis
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("T8")


def _decomposition(name, kind="combinatorial"):
    """The pair with the degree mass, its whole basis, and U = D^½ Φ."""
    pair = laplacian(MESHES[name](), kind, "degree")
    basis = fourier_basis(pair, pair.n)
    return pair, basis, np.sqrt(pair.degrees)[:, None] * basis.eigenvectors


def _near(left, right, tolerance=1e-12):
    return np.abs(left - right).max() <= tolerance * np.abs(right).max()


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("kind", WEIGHTS)
def test_the_decomposition(name, kind):
    pair, basis, U = _decomposition(name, kind)
    values = basis.eigenvalues

    def is_decomposition(matrix):
        return _near(U @ np.diag(values) @ U.T, matrix)

    assert _near(U.T @ U, np.eye(pair.n))
    assert _near(U @ U.T, np.eye(pair.n))
    assert is_decomposition(pair.normalized.toarray())
    assert not is_decomposition(pair.stiffness.toarray())  # L, whose U is another one
    assert not is_decomposition(np.diag(1 / pair.degrees) @ pair.stiffness.toarray())
    assert (np.diff(values) >= 0).all()
    assert abs(values[0]) < 1e-12
    assert np.allclose(values, oracle.spectrum(pair.stiffness.toarray(), pair.mass.toarray()))
    assert basis.residuals[1:].max() < 1e-9


@pytest.mark.chapter("P50", "U27")
@pytest.mark.parametrize("name", IRREGULAR)
def test_orthogonality_is_that_of_the_mass(name):
    """<u, u'> = δ for L̃; the functions φ = D^-½ u of (L, D) are orthonormal for D, not plainly."""
    pair, basis, U = _decomposition(name)
    phi = basis.eigenvectors
    assert phi.shape == (pair.n, pair.n)  # each column is a function on the vertices
    assert _near(U.T @ U, np.eye(pair.n))
    assert _near(phi.T @ (pair.mass @ phi), np.eye(pair.n))
    plain = phi.T @ phi
    off = plain - np.diag(np.diag(plain))
    assert np.abs(off).max() > 1e-2 * np.abs(plain).max()
    assert pair.inner(phi[:, 3], phi[:, 4]) == pytest.approx(0, abs=1e-12)
    assert np.ptp(phi[:, 0]) < 1e-10  # φ_1 is constant, u_1 = D^½ 1 is not
    assert np.ptp(U[:, 0]) > 1e-2


@pytest.mark.chapter("U28")
@pytest.mark.parametrize("name", IRREGULAR)
def test_expansions(name):
    pair, basis, U = _decomposition(name)
    f = oracle.rough_functions(MESHES[name]())

    def expansion(vectors, coefficients):
        return _near(vectors @ coefficients, f)

    phi = basis.eigenvectors
    assert expansion(U, U.T @ f)
    assert expansion(phi, basis.forward(f))
    assert _near(basis.inverse(basis.forward(f)), f)
    assert not expansion(phi, phi.T @ f)  # the mass left out
    assert not expansion(phi, U.T @ f)  # one convention there, the other back
    assert not expansion(U, basis.forward(f))
    for m in (1, 10, 50):  # a part of the basis projects, orthogonally for the mass
        part = fourier_basis(pair, m)
        rest = f - part.inverse(part.forward(f))
        assert np.abs(part.forward(rest)).max() < 1e-11
        assert np.allclose(part.forward(f), basis.forward(f)[:m] * _signs(part, basis)[:, None])


def _signs(part, basis):
    """The signs of simple eigenvectors, which are all that two computations may differ in."""
    m = part.k
    return np.sign(np.einsum("ik,ik->k", part.eigenvectors, basis.eigenvectors[:, :m]))


@pytest.mark.chapter("U29")
@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("kind", WEIGHTS)
def test_parseval(name, kind):
    pair, basis, U = _decomposition(name, kind)
    f = oracle.rough_functions(MESHES[name](), 1)[:, 0]
    g = MESHES[name]().vertices[:, 0]
    plain, hat = U.T @ f, basis.forward(f)
    assert plain @ plain == pytest.approx(f @ f, rel=1e-12)
    assert hat @ hat == pytest.approx(f @ (pair.degrees * f), rel=1e-12)
    assert hat @ hat == pytest.approx(pair.norm(f) ** 2, rel=1e-12)
    assert abs(hat @ hat / (f @ f) - 1) > 0.1  # printed for U; wrong for the transform
    assert hat @ basis.forward(g) == pytest.approx(pair.inner(f, g), rel=1e-10, abs=1e-11)
    energy = basis.eigenvalues * hat**2
    assert energy.sum() == pytest.approx(pair.dirichlet_energy(f), rel=1e-10)


def test_only_projectors_can_be_compared():
    """E61: on the sphere the three vectors of λ = 2 are any rotation of any others."""
    pair = laplacian(icosphere(2), "combinatorial", "degree")
    phi = fourier_basis(pair, pair.n)
    ours = np.sqrt(pair.degrees)[:, None] * phi.eigenvectors
    values, theirs = scipy.linalg.eigh(pair.normalized.toarray(), driver="ev")
    order = np.random.default_rng(5).permutation(pair.n)  # the same mesh, in another order
    shuffled = pair.normalized.toarray()[order][:, order]
    other = np.empty_like(theirs)
    other[order] = scipy.linalg.eigh(shuffled)[1]
    assert np.allclose(phi.eigenvalues, values, atol=1e-12)
    assert np.ptp(values[1:4]) < 1e-12
    for one, two in ((ours, theirs), (ours, other)):
        space, same = one[:, 1:4], two[:, 1:4]
        assert np.allclose(space @ space.T, same @ same.T, atol=1e-10)
    overlap = np.abs((ours[:, 1:4] * other[:, 1:4]).sum(axis=0))
    assert overlap.min() < 0.99


@pytest.mark.parametrize("n", [15, 16])
def test_complex_modes_need_the_conjugate_and_come_in_another_order(n):
    """E71: U*U = Id; U'U = Id holds for real eigenvectors only."""
    grid = Grid(n)
    omega = np.arange(n)
    modes = np.exp(2j * np.pi * np.outer(omega, omega) / n) / np.sqrt(n)
    matrix = laplacian(grid).normalized.toarray()
    values = 2 * np.sin(np.pi * omega / n) ** 2
    assert np.allclose(matrix @ modes, modes * values)

    def orthonormal(adjoint):
        return np.allclose(adjoint @ modes, np.eye(n))

    assert orthonormal(modes.conj().T)
    assert not orthonormal(modes.T)
    assert abs(modes[:, 1] @ modes[:, 1]) < 1e-14  # u'u = 0 for a vector of length 1
    ours = fourier_basis(laplacian(grid, mass="degree"), n).eigenvalues
    assert not np.allclose(ours, values)
    assert np.allclose(ours, np.sort(values))
    pairs = modes[:, [1, n - 1]]  # the real eigenvectors lie in the span of e^{iωk} and e^{-iωk}
    phi = fourier_basis(laplacian(grid, mass="unit"), 3).eigenvectors[:, 1:]
    assert np.allclose(pairs @ (pairs.conj().T @ phi), phi)
    assert np.allclose(np.abs(pairs.conj().T @ phi), np.sqrt(0.5))
