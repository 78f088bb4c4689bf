"""Our own eigensolver against LAPACK, where eigenvalues repeat and where they do not."""

import numpy as np
import pytest

from beltrami.compression.block_basis import BlockBasis, fill_laplacian
from beltrami.compression.numbers import surroundings
from beltrami.compression.tridiagonal import tridiagonalise, turn_back
from beltrami.compression.tridiagonal_pairs import lowest_eigenvalues, tridiagonal_vectors
from beltrami.mesh import shapes


def eigenpairs(A, count):
    n = len(A)
    d, e, scales, reflectors = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros((n, n))
    values, vectors = np.zeros(count), np.zeros((n, count))
    tridiagonalise(A.copy(), d, e, reflectors, scales)
    width = lowest_eigenvalues(d, e, values)
    tridiagonal_vectors(d, e, values, width, vectors)
    turn_back(reflectors, scales, vectors)
    return values, vectors


def laplacian_of(mesh):
    L = -mesh.topology.adjacency.toarray().astype(float)
    return L - np.diag(L.sum(axis=1))


def star(n):
    A = np.zeros((n, n))
    A[0, 1:] = A[1:, 0] = -1.0
    return A - np.diag(A.sum(axis=1))


RANDOM = np.random.default_rng(0).normal(size=(60, 60))
MATRICES = {
    "icosphere": laplacian_of(shapes.icosphere(2)),
    "torus": laplacian_of(shapes.torus(12, 8)),
    "cube": laplacian_of(shapes.cube(4)),
    "disk": laplacian_of(shapes.disk(6)),
    "star": star(80),
    "nothing": np.zeros((40, 40)),
    "random": RANDOM + RANDOM.T,
    "large": 1e6 * (RANDOM + RANDOM.T),
    "one": np.array([[3.0]]),
    "two": np.array([[1.0, -1.0], [-1.0, 1.0]]),
    "three": np.array([[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, -1.0]]),
}


@pytest.mark.parametrize("name", MATRICES)
def test_eigenpairs(name):
    A = MATRICES[name]
    scale = max(abs(A).sum(axis=1).max(), 1.0)
    for count in {1, (len(A) + 2) // 3, len(A)}:
        values, vectors = eigenpairs(A, count)
        np.testing.assert_allclose(values, np.linalg.eigvalsh(A)[:count], atol=1e-13 * scale)
        assert abs(A @ vectors - vectors * values).max() < 1e-12 * scale
        assert abs(vectors.T @ vectors - np.eye(count)).max() < 1e-10


@pytest.mark.parametrize("mesh", [shapes.icosphere(2), shapes.torus(12, 8), shapes.disk(6)])
def test_the_basis_is_that_of_a_laplacian_of_the_faces(mesh):
    n = mesh.n_vertices
    everything, basis = np.arange(n), BlockBasis(surroundings(mesh.faces, n))
    U = basis.vectors(everything, n)
    np.testing.assert_allclose(U.T @ U, np.eye(n), atol=1e-10)
    assert (U[:, 0] == 1 / np.sqrt(n)).all()
    L = laplacian_of(mesh)
    exact = np.linalg.eigvalsh(L)
    np.testing.assert_allclose(np.diag(U.T @ L @ U), exact, rtol=2.5e-4, atol=1e-9)
    leading = U[(abs(U) >= 0.5 / np.sqrt(n)).argmax(axis=0), np.arange(n)]
    assert (leading > 0).all()
    np.testing.assert_array_equal(basis.vectors(everything, 7), U[:, :7])


def test_the_weights_break_ties_and_hardly_anything_else():
    mesh = shapes.icosphere(2)
    n = mesh.n_vertices
    A = np.zeros((n, n))
    fill_laplacian(np.arange(n), surroundings(mesh.faces, n), np.arange(n), A)
    L = A + 1 / n
    assert (L == L.T).all()
    assert abs(L.sum(axis=1)).max() < 1e-12
    difference = L - laplacian_of(mesh)
    assert 0 < abs(difference[~np.eye(n, dtype=bool)]).max() < 2.5e-4
    plain, tied = np.linalg.eigvalsh(laplacian_of(mesh)), np.linalg.eigvalsh(L)
    assert np.ptp(plain[1:4]) < 1e-12
    assert np.diff(tied[:4]).min() > 1e-7


@pytest.mark.chapter("P58")
def test_the_basis_follows_the_faces_and_the_block():
    mesh = shapes.disk(6)
    n = mesh.n_vertices
    first, second = (BlockBasis(surroundings(mesh.faces, n)) for _ in range(2))
    part = np.arange(0, n, 2)
    for basis in (first, second):
        basis.note(basis.vectors(part, 9))
    assert first.digest() == second.digest()
    second.note(second.vectors(part, 1))
    assert first.digest() != second.digest()
    more, fewer = (BlockBasis(surroundings(faces, n)) for faces in (mesh.faces, mesh.faces[:-1]))
    for basis in (more, fewer):
        basis.note(basis.vectors(np.arange(n), 9))
    assert more.digest() != fewer.digest()
