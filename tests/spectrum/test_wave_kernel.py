"""The wave kernel signature against its definition, and what must not matter."""

import numpy as np
import pytest

import spectra
from beltrami.errors import BeltramiError, MeshError
from beltrami.mesh.shapes import icosphere, octahedron
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.wave_kernel import wave_kernel_signature


@pytest.mark.parametrize("name", ["closed", "bad", "two"])
def test_against_its_definition(name):
    basis = spectra.basis_of(name, 20)
    zeros = 2 if name == "two" else 1
    energies, sigma = [0.5, 2.0], 0.3
    wave = wave_kernel_signature(basis, energies, sigma=sigma)
    for column, e in enumerate(energies):
        total = np.zeros(basis.n)
        weights = 0.0
        for i in range(zeros, basis.k):
            w = np.exp(-((e - np.log(basis.eigenvalues[i])) ** 2) / (2 * sigma**2))
            total += w * basis.eigenvectors[:, i] ** 2
            weights += w
        np.testing.assert_allclose(wave.values[:, column], total / weights, rtol=1e-12)


def test_it_is_a_distribution_over_the_surface():
    for name in ("obt", "open", "creature"):
        basis = spectra.basis_of(name, 30)
        wave = wave_kernel_signature(basis)
        np.testing.assert_allclose(basis.mass.sum(axis=1) @ wave.values, 1, rtol=1e-9)


def test_on_the_sphere_it_is_one_over_the_area():
    basis = spectra.basis_of("sphere", 81)
    wave = wave_kernel_signature(basis, count=30)
    assert np.abs(4 * np.pi * wave.values - 1).max() < 0.03
    cut = wave_kernel_signature(spectra.basis_of("sphere", 12), count=30)  # within l = 3
    assert np.abs(4 * np.pi * cut.values[:, -1] - 1).max() > 0.05


def test_it_is_exactly_constant_where_all_vertices_are_alike():
    for basis in (spectra.flat_torus(), fourier_basis(laplacian(octahedron()), 6)):
        wave = wave_kernel_signature(basis, count=20)
        np.testing.assert_allclose(wave.values, 1 / basis.mass.sum(), rtol=1e-11)


@pytest.mark.parametrize("name", ["closed", "cur", "creature"])
def test_numbers_of_vertices_do_not_matter(name):
    other, order = spectra.permuted(spectra.mesh_of(name))
    one = wave_kernel_signature(spectra.basis_of(name, 30))
    two = wave_kernel_signature(fourier_basis(laplacian(other), 30))
    np.testing.assert_allclose(two.at, one.at, rtol=1e-8)
    np.testing.assert_allclose(two.values, one.values[order], rtol=1e-6)


def test_isometries_do_not_matter():
    one, two = (wave_kernel_signature(basis) for basis in spectra.sheet_and_scroll())
    np.testing.assert_allclose(two.values, one.values, rtol=1e-6)


def test_the_choice_within_eigenspaces_does_not_matter():
    for basis in (spectra.flat_torus(), spectra.basis_of("tor")):
        one, two = (wave_kernel_signature(b) for b in (basis, spectra.turned(basis)))
        np.testing.assert_allclose(two.values, one.values, rtol=1e-5)


@pytest.mark.parametrize("unit", [1e-9, 2.0, 1e9])
def test_units(unit):
    mesh = spectra.mesh_of("cur")
    basis = spectra.basis_of("cur", 30)
    large = fourier_basis(laplacian(mesh.with_vertices(unit * mesh.vertices)), 30)
    one, two = wave_kernel_signature(basis), wave_kernel_signature(large)
    np.testing.assert_allclose(two.at, one.at - 2 * np.log(unit), rtol=1e-8)
    np.testing.assert_allclose(two.values, one.values / unit**2, rtol=1e-6)
    one, two = (wave_kernel_signature(b, scale_invariant=True) for b in (basis, large))
    np.testing.assert_allclose(two.at, one.at, rtol=1e-8)
    np.testing.assert_allclose(two.values, one.values, rtol=1e-6)


def test_energies_are_those_of_the_paper():
    basis = spectra.basis_of("two", 40)
    for count in (2, 10, 100):
        at = wave_kernel_signature(basis, count=count).at
        step = np.diff(at)
        assert len(at) == count
        np.testing.assert_allclose(step, step[0])
        ends = np.log(basis.eigenvalues[[2, -1]])
        np.testing.assert_allclose(at[[0, -1]], ends + 14 * step[0] * np.array([1, -1]))


def test_bands_are_seven_steps_wide():
    basis = spectra.basis_of("closed", 40)
    chosen = wave_kernel_signature(basis, count=50)
    given = wave_kernel_signature(basis, chosen.at)
    wide = wave_kernel_signature(basis, chosen.at, sigma=7 * (chosen.at[1] - chosen.at[0]))
    np.testing.assert_allclose(given.values, chosen.values, rtol=1e-9)
    np.testing.assert_allclose(wide.values, chosen.values, rtol=1e-9)


@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
def test_the_truncation_bounds_what_is_left_out(mass):
    whole = spectra.basis_of("closed", None, mass)
    for k in (30, 60, 200):
        part = wave_kernel_signature(spectra.basis_of("closed", k, mass))
        sigma = 7 * (part.at[1] - part.at[0])
        exact = wave_kernel_signature(whole, part.at, sigma=sigma)
        assert np.array_equal(exact.truncation, np.zeros(100))
        change = np.abs(exact.values / part.values - 1).max(axis=0)
        assert (change <= part.truncation + 1e-7).all()
        assert part.truncation[0] < 1e-6 < 0.1 < part.truncation[-1]
        beyond = wave_kernel_signature(
            spectra.basis_of("closed", k, mass), part.at[-1] + 5 * sigma, sigma=sigma
        )
        assert beyond.truncation[0] > 1  # nothing is known there


def test_the_bound_holds_at_the_energy_of_the_one_mode_left_out():
    whole, short = spectra.basis_of("closed"), spectra.basis_of("closed", 299)
    at, gap = np.log(whole.eigenvalues[-1]), np.log(whole.eigenvalues[-1] / whole.eigenvalues[-2])
    exact, part = (wave_kernel_signature(b, at, sigma=gap / 3) for b in (whole, short))
    change = np.abs(exact.values / part.values - 1).max()
    assert 20 < change <= part.truncation[0]


def test_wrong_input():
    basis = spectra.basis_of("pl", 10)
    for sigma in (0, -1.0, np.nan, np.inf):
        with pytest.raises(BeltramiError, match="sigma must be positive"):
            wave_kernel_signature(basis, sigma=sigma)
    for count in (1, 0, 2.5):
        with pytest.raises(BeltramiError, match="whole number >= 2"):
            wave_kernel_signature(basis, count=count)
    with pytest.raises(BeltramiError, match="no eigenvalue of the basis is near"):
        wave_kernel_signature(basis, [1.0, 1e6], sigma=0.1)
    with pytest.raises(BeltramiError):
        wave_kernel_signature(basis, [np.inf])
    with pytest.raises(MeshError, match="all zero"):
        wave_kernel_signature(fourier_basis(laplacian(icosphere(1)), 1))
    with pytest.raises(MeshError, match="two different eigenvalues"):
        wave_kernel_signature(fourier_basis(laplacian(octahedron()), 3))
    alone = wave_kernel_signature(fourier_basis(laplacian(octahedron()), 3), 0.0, sigma=1.0)
    assert np.isfinite(alone.values).all()
