"""The heat kernel signature against the matrix exponential, and what must not matter."""

import numpy as np
import pytest
from scipy.linalg import eigh, expm

import spectra
from beltrami.errors import BeltramiError, MeshError, NonFiniteError
from beltrami.mesh.shapes import icosphere, octahedron
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.heat_kernel import heat_kernel_signature


def on_the_sphere(t, degree=60):
    """Sum (2l + 1) / 4π exp(-l (l + 1) t), by the addition theorem."""
    n = np.arange(degree)
    return ((2 * n + 1) * np.exp(-n * (n + 1) * t)).sum() / (4 * np.pi)


@pytest.mark.parametrize("mass", ["voronoi", "consistent", "degree"])
@pytest.mark.parametrize("name", ["closed", "obt", "open", "bad", "cur"])
def test_all_modes_are_the_matrix_exponential(name, mass):
    pair = spectra.pair_of(name, mass)
    B = pair.mass.toarray()
    basis = spectra.basis_of(name, None, mass)
    times = [0.0, 1 / basis.eigenvalues[5], 3 / basis.eigenvalues[1]]
    heat = heat_kernel_signature(basis, times)
    for column, t in enumerate(times):
        kernel = expm(-t * np.linalg.solve(B, pair.stiffness.toarray())) @ np.linalg.inv(B)
        np.testing.assert_allclose(heat.values[:, column], kernel.diagonal(), rtol=1e-7)
    assert np.array_equal(heat.truncation, np.zeros(3))


def test_on_the_sphere_it_is_constant_and_known():
    heat = heat_kernel_signature(spectra.basis_of("sphere", 81), [0.2, 0.5, 1.0, 5.0])
    exact = [on_the_sphere(t) for t in heat.at]
    assert np.abs(heat.values / exact - 1).max() < 0.02
    assert (np.ptp(heat.values, axis=0) / exact < [5e-3, 2e-3, 1e-4, 1e-6]).all()
    without_degeneracy = [(np.exp(-np.arange(60) * np.arange(1, 61) * t)).sum() for t in heat.at]
    assert np.abs(heat.values / without_degeneracy * 4 * np.pi - 1).max() > 0.2


def test_it_is_exactly_constant_where_all_vertices_are_alike():
    for basis in (spectra.flat_torus(), fourier_basis(laplacian(octahedron()), 6)):
        heat = heat_kernel_signature(basis, count=20)
        assert (np.ptp(heat.values, axis=0) < 1e-12 * heat.values.max(axis=0)).all()
        trace = np.exp(-np.outer(basis.eigenvalues, heat.at)).sum(axis=0)
        np.testing.assert_allclose(heat.values[0] * basis.mass.sum(), trace, rtol=1e-12)


def test_short_times_see_tips_and_long_ones_the_area_of_the_component():
    mesh = spectra.mesh_of("two")
    basis = spectra.basis_of("two", 60)
    late = heat_kernel_signature(basis, 1e6).values[:, 0]
    areas = np.repeat([mesh.face_areas[:320].sum(), mesh.face_areas[320:].sum()], [162, 160])
    np.testing.assert_allclose(late, 1 / areas, rtol=1e-9)
    tail = spectra.mesh_of("creature").vertices[:, 0].argmin()
    heat = heat_kernel_signature(spectra.basis_of("creature", 100), count=10)
    assert heat.values[tail, 0] > 1.7 * np.median(heat.values[:, 0])


@pytest.mark.parametrize("name", ["closed", "cur", "creature"])
def test_numbers_of_vertices_do_not_matter(name):
    mesh = spectra.mesh_of(name)
    other, order = spectra.permuted(mesh)
    one = heat_kernel_signature(spectra.basis_of(name, 30))
    two = heat_kernel_signature(fourier_basis(laplacian(other), 30))
    np.testing.assert_allclose(two.at, one.at, rtol=1e-9)
    np.testing.assert_allclose(two.values, one.values[order], rtol=1e-7)


def test_isometries_do_not_matter():
    """Neither rolling up a sheet, nor a place in five dimensions."""
    one, two = (heat_kernel_signature(basis) for basis in spectra.sheet_and_scroll())
    np.testing.assert_allclose(two.values, one.values, rtol=1e-7)
    flat = spectra.mesh_of("open")
    rotation = np.linalg.qr(np.random.default_rng(3).normal(size=(5, 5)))[0]
    other = flat.with_vertices(flat.vertices @ rotation[:2] + 4)
    one = heat_kernel_signature(spectra.basis_of("open", 30))
    two = heat_kernel_signature(fourier_basis(laplacian(other), 30))
    np.testing.assert_allclose(two.values, one.values, rtol=1e-7)


def test_the_choice_within_eigenspaces_does_not_matter():
    for basis in (spectra.flat_torus(), spectra.basis_of("tor")):
        one, two = (heat_kernel_signature(b) for b in (basis, spectra.turned(basis)))
        np.testing.assert_allclose(two.values, one.values, rtol=1e-6)
        assert not np.allclose(spectra.turned(basis).eigenvectors, basis.eigenvectors, atol=0.01)


@pytest.mark.parametrize("unit", [1e-9, 2.0, 1e9])
def test_units(unit):
    mesh = spectra.mesh_of("cur")
    basis = spectra.basis_of("cur", 30)
    large = fourier_basis(laplacian(mesh.with_vertices(unit * mesh.vertices)), 30)
    one, two = heat_kernel_signature(basis), heat_kernel_signature(large)
    np.testing.assert_allclose(two.at, unit**2 * one.at, rtol=1e-9)
    np.testing.assert_allclose(two.values, one.values / unit**2, rtol=1e-7)
    one, two = (
        heat_kernel_signature(b, times, scale_invariant=True)
        for b, times in ((basis, None), (large, None))
    )
    np.testing.assert_allclose(two.at, one.at, rtol=1e-9)
    np.testing.assert_allclose(two.values, one.values, rtol=1e-7)
    given = heat_kernel_signature(large, one.at[:3], scale_invariant=True)
    assert np.array_equal(given.at, one.at[:3])
    np.testing.assert_allclose(given.values, one.values[:, :3], rtol=1e-7)


def test_scale_invariant_is_that_of_the_unit_area():
    mesh = spectra.mesh_of("cur")
    unit = mesh.with_vertices(mesh.vertices / np.sqrt(mesh.area))
    small = heat_kernel_signature(fourier_basis(laplacian(unit), 30))
    free = heat_kernel_signature(spectra.basis_of("cur", 30), scale_invariant=True)
    np.testing.assert_allclose(free.values, small.values, rtol=1e-7)


def test_times_are_those_of_the_paper():
    basis = spectra.basis_of("two", 40)
    heat = heat_kernel_signature(basis, count=7)
    assert heat.values.shape == (322, 7)
    ends = 4 * np.log(10) / basis.eigenvalues[[39, 2]]  # two components, two zeros
    np.testing.assert_allclose(heat.at[[0, -1]], ends, rtol=1e-9)
    np.testing.assert_allclose(np.diff(np.log(heat.at), 2), 0, atol=1e-9)


@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
@pytest.mark.parametrize("name", ["closed", "obt", "open"])
def test_the_truncation_bounds_what_is_left_out(name, mass):
    whole = spectra.basis_of(name, None, mass)
    for k in (3, 20, whole.n - 1):
        short = spectra.basis_of(name, k, mass)
        part = heat_kernel_signature(short, count=6)
        exact = heat_kernel_signature(whole, part.at)
        lost = (exact.values / part.values - 1).max(axis=0)
        assert (lost >= -1e-8).all()
        assert (lost <= part.truncation + 1e-8).all()
        assert part.truncation[0] > part.truncation[1] >= part.truncation[-1]
        if mass == "voronoi":  # at the time 0 the bound is an equality
            now, all_of_it = (heat_kernel_signature(b, 0.0) for b in (short, whole))
            lost = (all_of_it.values / now.values - 1).max()
            assert now.truncation[0] == pytest.approx(lost, rel=1e-6)


@pytest.mark.parametrize("unit", [1e-9, 1.0])
def test_noise_of_zeros_does_not_grow_with_time(unit):
    mesh = spectra.mesh_of("obt")
    pair = laplacian(mesh.with_vertices(unit * mesh.vertices))
    heat = heat_kernel_signature(fourier_basis(pair, 10), [1e30, 1e305])
    np.testing.assert_allclose(heat.values, 1 / pair.mass.sum(), rtol=1e-9)


def test_it_is_an_array_for_numpy():
    heat = heat_kernel_signature(spectra.basis_of("pl", 10), [1.0, 2.0])
    assert np.array_equal(np.hstack([heat, heat])[:, 2:], heat.values)
    assert np.asarray(heat) is heat.values
    assert np.array(heat, dtype=np.float32).dtype == np.float32
    assert np.array(heat).flags.writeable
    assert repr(heat) == "<Signature: heat, 56 vertices, 2 times (1 to 2)>"
    with pytest.raises(ValueError, match="read-only"):
        heat.values[0] = 1


def test_wrong_input():
    basis = spectra.basis_of("pl", 10)
    for times in (-1.0, [1.0, -1e-9]):
        with pytest.raises(BeltramiError, match="times must be >= 0"):
            heat_kernel_signature(basis, times)
    with pytest.raises(NonFiniteError):
        heat_kernel_signature(basis, [1.0, np.nan])
    for times in ([], [[1.0]], "soon", 1j):
        with pytest.raises(BeltramiError):
            heat_kernel_signature(basis, times)
    for count in (0, 1.5, True, "many"):
        with pytest.raises(BeltramiError):
            heat_kernel_signature(basis, count=count)
    kernel = fourier_basis(laplacian(icosphere(1)), 1)
    with pytest.raises(MeshError, match="all zero"):
        heat_kernel_signature(kernel)
    assert heat_kernel_signature(kernel, 1.0).values.shape == (42, 1)


def test_vertices_held_at_zero_miss_nothing():
    """Rows of zeros are a Dirichlet condition: the heat there is 0, and known."""
    pair = spectra.pair_of("pl")
    free = np.ones(pair.n, bool)
    free[:8] = False
    values, vectors = eigh(
        pair.stiffness.toarray()[free][:, free], pair.mass.toarray()[free][:, free]
    )
    rows = np.zeros((pair.n, free.sum()))
    rows[free] = vectors
    whole, part = (
        FourierBasis(values[:k].copy(), rows[:, :k].copy(), pair.mass.copy(), np.zeros(k))
        for k in (free.sum(), 12)
    )
    exact, found = (heat_kernel_signature(b, [0.5, 2.0]) for b in (whole, part))
    assert not found.values[~free].any()
    assert not exact.truncation.any()
    lost = (exact.values[free] / found.values[free] - 1).max(axis=0)
    assert (lost <= found.truncation + 1e-12).all()
    assert np.isfinite(found.truncation).all()
