"""Theorem 12: the spectrum of a torus of n1 x n2 points, n1 != n2 (E70)."""

import numpy as np
import pytest

from beltrami.grids.grid import Grid
from beltrami.grids.transform import dft

pytestmark = pytest.mark.chapter("T12")
SHAPES = [(6, 9), (4, 7), (2, 3), (1, 5), (8, 8), (3, 4, 5)]


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("real", [True, False])
def test_each_mode_of_l_and_of_the_normalised_one(shape, real):
    grid = Grid(shape)
    pair = grid.make_laplacian(mass="unit")
    found = grid.fourier_modes(mass="unit", real=real)
    n, U = grid.n_vertices, found.modes
    assert np.abs(U.conj().T @ U - np.eye(n)).max() < 1e-13
    assert np.abs(pair.stiffness @ U - U * found.eigenvalues).max() < 1e-13
    roots = sum(np.sin(np.pi * found.frequencies[:, a] / p) ** 2 for a, p in enumerate(shape))
    assert np.allclose(found.eigenvalues, 4 * roots, atol=1e-13)
    degree = 2 * sum(p > 1 for p in shape)
    half = grid.fourier_modes(real=real)
    assert np.allclose(half.eigenvalues, 4 * roots / degree, atol=1e-13)
    assert np.abs(pair.normalized @ U - U * half.eigenvalues).max() < 1e-13
    assert np.allclose(half.modes * np.sqrt(degree), U, atol=1e-14)


@pytest.mark.parametrize("shape", SHAPES)
def test_the_whole_spectrum_against_a_dense_solver(shape):
    grid = Grid(shape)
    for mass in ("unit", "degree"):
        pair = grid.make_laplacian(mass=mass)
        dense = np.linalg.eigvalsh((pair.stiffness / pair.masses[0]).toarray())
        assert np.abs(np.sort(grid.eigenvalues(mass=mass), axis=None) - dense).max() < 1e-13
        assert grid.eigenvalues(mass=mass).shape == shape


@pytest.mark.parametrize("shape", SHAPES)
def test_the_transform_makes_l_diagonal_in_its_order(shape):
    grid = Grid(shape)
    f = np.random.default_rng(13).normal(size=shape)
    Lf = (grid.make_laplacian(mass="unit").stiffness @ f.ravel()).reshape(shape)
    assert np.abs(dft(Lf) - grid.eigenvalues(mass="unit") * dft(f)).max() < 1e-13


def test_as_printed_it_fails():
    """E70: the vectors are not eigenvectors, nor the numbers eigenvalues."""
    n1, n2 = 6, 9
    n = n1 * n2
    grid = Grid((n1, n2))
    L = grid.make_laplacian(mass="unit").stiffness
    k1, k2 = np.indices((n1, n2)).reshape(2, -1)
    printed = np.exp(2j * np.pi / n * (np.outer(k1, k1) + np.outer(k2, k2))) / np.sqrt(n)
    rayleigh = np.einsum("kw,kw->w", printed.conj(), L @ printed).real
    residual = np.linalg.norm(L @ printed - printed * rayleigh, axis=0)
    assert np.median(residual) > 0.5
    assert 0.9 < abs(np.vdot(printed[:, 0], printed[:, n2])) < 0.99  # nor orthogonal
    right = np.exp(2j * np.pi * (np.outer(k1, k1) / n1 + np.outer(k2, k2) / n2)) / np.sqrt(n)
    found = grid.fourier_modes(mass="unit", real=False)
    which = np.ravel_multi_index(found.frequencies.T, grid.shape)
    assert np.abs(found.modes - right[:, which]).max() < 1e-14
    numbers = 4 * (np.sin(2 * np.pi * k1 / n1) ** 2 + np.sin(2 * np.pi * k2 / n2) ** 2)
    wrong = np.linalg.norm(L @ right - right * numbers, axis=0)
    assert wrong.max() > 4
    true = grid.eigenvalues(mass="unit").ravel()
    assert np.linalg.norm(L @ right - right * true, axis=0).max() < 1e-13


@pytest.mark.chapter("P29", "P56")
def test_eigenvectors_span_the_same_spaces():
    grid = Grid((6, 9))
    values, vectors = np.linalg.eigh(grid.make_laplacian().normalized.toarray())
    starts = np.flatnonzero(np.diff(values, prepend=-1) > 1e-9)
    for real in (True, False):
        U = grid.fourier_modes(mass="unit", real=real).modes
        for space in np.split(np.arange(54), starts[1:]):
            projectors = [b[:, space] @ b[:, space].conj().T for b in (vectors, U)]
            assert np.abs(projectors[0] - projectors[1]).max() < 1e-12
