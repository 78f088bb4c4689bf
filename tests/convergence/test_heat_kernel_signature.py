"""The heat kernel signature of the sphere and of a flat torus under refinement."""

import numpy as np
import pytest

from beltrami.grids.grid import Grid
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.distances import spectral_distance
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.heat_kernel import heat_kernel_signature


def _order(errors):
    """Slope of the logarithms, h halved each time."""
    return -np.polyfit(np.arange(len(errors)), np.log2(errors), 1)[0]


def _on_the_sphere(t):
    degree = np.arange(60)
    return ((2 * degree + 1) * np.exp(-degree * (degree + 1) * t)).sum() / (4 * np.pi)


@pytest.mark.parametrize("mass", ["voronoi", "barycentric", "consistent"])
def test_on_the_sphere_it_is_of_second_order(mass):
    for time in (0.3, 1.0):
        errors = []
        for subdivisions in (1, 2, 3):
            pair = laplacian(icosphere(subdivisions), mass=mass)
            basis = fourier_basis(pair, min(pair.n, 100))
            found = heat_kernel_signature(basis, time).values[:, 0]
            errors.append(np.abs(found / _on_the_sphere(time) - 1).max())
        assert np.log2(errors[1] / errors[2]) == pytest.approx(2, abs=0.15)
        assert errors[-1] < 0.012


def test_on_the_flat_torus_it_is_of_second_order():
    """h is a product of two circles' theta functions."""
    time = 0.01
    wave = np.arange(-30, 31)
    exact = np.exp(-4 * np.pi**2 * wave**2 * time).sum() ** 2
    errors = []
    for p in (6, 12, 24):
        pair = laplacian(Grid((p, p)), "dirichlet")
        found = heat_kernel_signature(fourier_basis(pair, pair.n), time).values[:, 0]
        errors.append(np.abs(found / exact - 1).max())
    assert _order(errors) == pytest.approx(2, abs=0.25)


def test_more_modes_converge_faster_than_any_power():
    pair = laplacian(icosphere(3))
    whole = fourier_basis(pair, pair.n)
    time = 0.1
    exact = heat_kernel_signature(whole, time).values
    errors = []
    for degree in (3, 5, 7, 9):
        found = heat_kernel_signature(fourier_basis(pair, degree**2), time).values
        errors.append(np.abs(found / exact - 1).max())
    slopes = np.diff(np.log(errors)) / np.diff(np.log([3, 5, 7, 9]))
    assert (np.diff(slopes) < -1).all()  # steeper each time
    assert errors[-1] < 1e-2


def test_biharmonic_converges_and_commute_time_grows():
    """Of antipodes: sums over odd degrees of (2l + 1) / π (l (l + 1))⁻², and of ⁻¹."""
    degree = np.arange(1, 2000, 2)
    exact = np.sqrt(((2 * degree + 1) / (degree * (degree + 1.0)) ** 2).sum() / np.pi)
    biharmonic, commute = [], []
    for subdivisions in (1, 2, 3):
        sphere = icosphere(subdivisions)
        basis = fourier_basis(laplacian(sphere), sphere.n_vertices)
        biharmonic.append(abs(spectral_distance(basis, 0).max() / exact - 1))
        commute.append(spectral_distance(basis, 0, "commute_time").max() ** 2)
    assert _order(biharmonic) > 1.4
    assert biharmonic[-1] < 0.01
    assert commute[2] - commute[1] == pytest.approx(np.log(2) / np.pi, rel=0.05)  # for each half h
