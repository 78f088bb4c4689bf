"""Direct filtering is cheaper than through the spectrum (l. 603): products counted."""

import numpy as np
import pytest

from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.chebyshev import chebyshev_series
from beltrami.spectrum.filtering import filter as filter_function
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.interval import spectral_interval
from beltrami.spectrum.kernels import Heat
from beltrami.spectrum.recurrence import chebyshev_sums

pytestmark = pytest.mark.chapter("P59")
TIME = 0.02  # a seventh of the radius, as the root of it


def _operations(mesh):
    """Multiplications of the direct way, and of a transform and its inverse with all of a basis."""
    pair = laplacian(mesh)
    series = chebyshev_series(Heat(TIME), spectral_interval(pair))
    return series.order * (pair.stiffness.nnz + 3 * pair.n), 2 * pair.n**2


def test_the_direct_way_grows_more_slowly():
    """N nnz with N ~ √(λ t) ~ √n, so n^1.5, against n²; and no eigenvectors were counted."""
    counts = np.array([_operations(icosphere(level)) for level in (2, 3, 4, 5)], float)
    direct, spectral = counts.T
    assert (direct[2:] < spectral[2:] / 3).all()
    growth = np.log(counts[-1] / counts[-2]) / np.log(4)  # n grows by 4
    assert growth[0] == pytest.approx(1.5, abs=0.15)
    assert growth[1] == pytest.approx(2, abs=0.01)


def test_and_it_does_the_same():
    pair = laplacian(icosphere(3))
    f = np.random.default_rng(0).normal(size=pair.n)
    spectral = fourier_basis(pair, pair.n).filter(f, Heat(TIME))
    np.testing.assert_allclose(filter_function(pair, f, Heat(TIME)), spectral, atol=1e-7)


def test_the_products_counted_are_the_products_made(monkeypatch):
    pair = laplacian(icosphere(2), mass="consistent")  # there each product is a call
    made = []

    def counting(laplacian):
        inner = np.linalg.inv(laplacian.mass.toarray()) @ laplacian.stiffness.toarray()

        def apply(x):
            made.append(x.shape)
            return inner @ x

        return apply

    monkeypatch.setattr("beltrami.spectrum.recurrence.as_operator", counting)
    series = chebyshev_series(Heat(TIME), spectral_interval(pair))
    chebyshev_sums(pair, np.ones((pair.n, 1)), [series])
    assert len(made) == series.order
