"""Functional maps: permutations come back, the minimum is one, points and matrices agree."""

from functools import cache

import numpy as np
import pytest

import spectra
from beltrami.errors import BeltramiError, DimensionError, MeshError, NonFiniteError
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.correspondence import (
    functional_map_from_points,
    unit_eigenvalues,
    unit_vectors,
)
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.functional_map import functional_map
from beltrami.spectrum.heat_kernel import heat_kernel_signature
from beltrami.spectrum.wave_kernel import wave_kernel_signature


@cache
def copied(unit=1.0):
    """The creature, and the same with other numbers, in another unit; target i was order[i]."""
    mesh = spectra.mesh_of("creature")
    other, order = spectra.permuted(mesh)
    other = other.with_vertices(unit * other.vertices)
    return spectra.basis_of("creature", 40), fourier_basis(laplacian(other), 40), order


@pytest.mark.parametrize("unit", [1.0, 1e-9, 1e9])
def test_a_permutation_comes_back_from_signatures_alone(unit):
    source, target, order = copied(unit)
    descriptors = [
        np.hstack(
            [
                heat_kernel_signature(basis, scale_invariant=True, count=40),
                wave_kernel_signature(basis, scale_invariant=True, count=40),
            ]
        )
        for basis in (source, target)
    ]
    found = functional_map(source, target, *descriptors, commutativity=1e-4)
    assert np.array_equal(found.point_map, order)
    assert np.array_equal(found.backward(), np.argsort(order))
    assert found.descriptor_residual < 1e-3


@pytest.mark.parametrize("unit", [1.0, 1e9])
def test_a_permutation_comes_back_from_landmarks(unit):
    source, target, order = copied(unit)
    at = np.arange(0, target.n, 10)
    pairs = np.column_stack([order[at], at])
    found = functional_map(source, target, landmarks=pairs)
    assert np.array_equal(found.point_map, order)
    assert found.orthogonality < 1e-6
    assert found.commutativity_residual < 1e-6
    assert found.descriptor_residual < 1e-6
    f = source.eigenvectors[:, 3] + 2
    np.testing.assert_allclose(found.transfer(f), f[order], atol=1e-5 * np.abs(f).max())
    np.testing.assert_allclose(found.transfer(np.ones((source.n, 2))), 1, atol=1e-6)


def test_the_signs_of_eigenvectors_do_not_matter():
    source, target, order = copied()
    pairs = np.column_stack([order[::20], np.arange(target.n)[::20]])
    one = functional_map(source, target, landmarks=pairs)
    two = functional_map(spectra.turned(source), target, landmarks=pairs)
    assert np.array_equal(one.point_map, two.point_map)
    assert not np.allclose(one.matrix, two.matrix, atol=0.1)
    assert two.orthogonality == pytest.approx(one.orthogonality, abs=1e-6)


@pytest.mark.parametrize("alpha", [0.0, 1e-3, 0.1, 10.0])
def test_it_is_the_minimum(alpha):
    """Against the system of all entries at once; energies of others are larger."""
    source, target = spectra.basis_of("closed", 12), spectra.basis_of("obt", 9)
    rng = np.random.default_rng(4)
    F, G = rng.normal(size=(source.n, 15)), rng.normal(size=(target.n, 15)) * 1e3
    C = functional_map(source, target, F, G, commutativity=alpha).matrix
    A = unit_vectors(source, 12).T @ source.mass @ F / source.mass.sum()
    B = unit_vectors(target, 9).T @ target.mass @ G / target.mass.sum()
    sizes = np.sqrt((A**2).sum(axis=0) + (B**2).sum(axis=0))
    A, B = A / sizes, B / sizes
    s, t = unit_eigenvalues(source), unit_eigenvalues(target)
    gap = (s[None, :] - t[:, None]) / max(s.max(), t.max())
    system = np.kron(np.eye(9), A @ A.T / 15) + alpha * np.diag((gap**2).ravel())
    whole = np.linalg.solve(system, (B @ A.T / 15).ravel()).reshape(9, 12)
    np.testing.assert_allclose(C, whole, rtol=1e-6, atol=1e-9 * np.abs(whole).max())

    def energy(X):
        misfit = ((X @ A - B) ** 2).sum() / 15
        return misfit + alpha * ((X * s - t[:, None] * X) ** 2).sum() / max(s.max(), t.max()) ** 2

    for _ in range(5):
        assert energy(C) < energy(C + 1e-3 * rng.normal(size=C.shape))


def test_what_descriptors_leave_open_is_small():
    source, target, order = copied()
    few = functional_map(source, target, landmarks=[[order[0], 0]], commutativity=0)
    assert np.linalg.matrix_rank(few.matrix, tol=1e-9) == 1
    assert few.descriptor_residual < 1e-9


def test_two_different_sizes():
    source, target = spectra.basis_of("closed", 12), spectra.basis_of("obt", 9)
    pairs = np.column_stack([np.arange(0, 300, 15)] * 2)
    found = functional_map(source, target, landmarks=pairs)
    C = found.matrix
    assert C.shape == (9, 12)
    assert found.orthogonality == pytest.approx(np.linalg.norm(C.T @ C - np.eye(12)) / 12**0.5)
    right, left = C * unit_eigenvalues(source), unit_eigenvalues(target)[:, None] * C
    whole = np.linalg.norm(right) + np.linalg.norm(left)
    assert found.commutativity_residual == pytest.approx(np.linalg.norm(right - left) / whole)
    assert functional_map(source, target, landmarks=pairs, k=5).matrix.shape == (5, 5)
    assert found.point_map.shape == (target.n,)
    assert found.backward().shape == (source.n,)
    assert found.transfer(np.ones((source.n, 3))).shape == (target.n, 3)


def test_points_to_matrix_and_back():
    source, target, order = copied()
    found = functional_map_from_points(source, target, order)
    assert np.array_equal(found.point_map, order)
    assert found.descriptor_residual is None
    np.testing.assert_allclose(np.abs(np.linalg.det(found.matrix)), 1, rtol=1e-6)
    assert found.orthogonality < 1e-8
    expected = np.linalg.lstsq(unit_vectors(target, 40), unit_vectors(source, 40)[order])[0]
    np.testing.assert_allclose(found.matrix, expected, rtol=1e-6, atol=1e-6)
    noisy = order.copy()
    noisy[::3] = 0
    assert functional_map_from_points(source, target, noisy, k=8).orthogonality > 0.1


def test_nearest_points_are_the_nearest():
    """By all distances in the space of the target's coefficients."""
    source, target = spectra.basis_of("closed", 12), spectra.basis_of("obt", 9)
    found = functional_map(source, target, landmarks=[[i, i] for i in range(0, 300, 20)])
    x = unit_vectors(source, 12) @ found.matrix.T
    y = unit_vectors(target, 9)
    squares = ((y[:, None] - x[None, :]) ** 2).sum(axis=2)
    assert np.array_equal(found.point_map, squares.argmin(axis=1))
    assert np.array_equal(found.backward(), squares.argmin(axis=0))


def test_what_it_tells_of_itself():
    source = spectra.basis_of("creature", 40)
    same = functional_map_from_points(source, source, np.arange(source.n), k=6)
    assert same.orthogonality < 1e-9
    assert same.commutativity_residual < 1e-9
    assert repr(same).startswith(f"<FunctionalMap: {source.n} to {source.n} vertices, 6 x 6, ortho")
    one_point = functional_map_from_points(source, source, np.zeros(source.n, int), k=6)
    assert one_point.orthogonality > 0.5
    with pytest.raises(ValueError, match="read-only"):
        same.matrix[0, 0] = 2


def test_wrong_input():
    a, b = spectra.basis_of("pl", 6), spectra.basis_of("closed", 6)
    F, G = np.ones((a.n, 2)), np.ones((b.n, 2))
    for words, error, match in (
        ((F, None), MeshError, "on both surfaces"),
        ((F, G[:, :1]), DimensionError, "2 descriptors on the source and 1"),
        ((G, G), DimensionError, "shape"),
        ((np.nan * F, G), NonFiniteError, "NaN"),
        ((), MeshError, "needs descriptors or landmarks"),
    ):
        with pytest.raises(error, match=match):
            functional_map(a, b, *words)
    with pytest.raises(MeshError) as caught:
        functional_map(a, b, landmarks=[[0, 0], [56, 1]])
    assert caught.value.vertices.tolist() == [56]
    for pairs in ([0, 1], [[0, 1, 2]], [[0.5, 1]]):
        with pytest.raises(MeshError):
            functional_map(a, b, landmarks=pairs)
    for k in (0, 7, 2.5):
        with pytest.raises(BeltramiError):
            functional_map(a, b, F, G, k=k)
    for alpha in (-1, np.nan, np.inf):
        with pytest.raises(BeltramiError, match="commutativity"):
            functional_map(a, b, F, G, commutativity=alpha)
    with pytest.raises(DimensionError, match="for each of 300 target vertices"):
        functional_map_from_points(a, b, np.zeros(56, int))
    with pytest.raises(MeshError):
        functional_map_from_points(a, b, np.full(300, 56))
    zeros = functional_map(a, b, 0 * F, 0 * G)
    assert not zeros.matrix.any()
    assert zeros.descriptor_residual == 0
