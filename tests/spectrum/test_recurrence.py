"""The recurrence against a few lines of numpy, and against the eigenvectors."""

import numpy as np
import pytest

from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.chebyshev import chebyshev_series
from beltrami.spectrum.interval import spectral_interval
from beltrami.spectrum.kernels import Heat, LowPass
from beltrami.spectrum.recurrence import chebyshev_sums
from meshes_of_the_errata import MESHES


def _by_numpy(pair, f, series):
    """Σ c_k T_k(X) f with a dense X."""
    low, high = series.interval
    A = np.linalg.solve(pair.mass.toarray(), pair.stiffness.toarray())
    X = (2 * A - (high + low) * np.eye(pair.n)) / (high - low)
    older, newer = f, X @ f
    total = series.coefficients[0] * older
    for c in series.coefficients[1:]:
        total = total + c * newer
        older, newer = newer, 2 * X @ newer - older
    return total


@pytest.mark.parametrize("mass", ["voronoi", "consistent", "degree"])
@pytest.mark.parametrize("columns", range(10))
def test_against_numpy(columns, mass):
    """Columns go by fours and ones: each number of them is another path."""
    pair = laplacian(MESHES["cur"](), mass=mass)
    f = np.random.default_rng(5).normal(size=(pair.n, columns))
    series = chebyshev_series(Heat(40 / pair.spectral_bound()), spectral_interval(pair))
    assert series.order > 10
    found = chebyshev_sums(pair, f, [series])
    assert found.shape == (1, pair.n, columns)
    np.testing.assert_allclose(found[0], _by_numpy(pair, f, series), atol=1e-11)


@pytest.mark.parametrize("columns", [1, 4])
@pytest.mark.parametrize("order", [0, 1, 2, 3, 19, 20, 21, 22, 23, 41, 42])
def test_every_order_swaps_its_vectors_right(order, columns):
    pair = laplacian(MESHES["closed"]())
    f = np.random.default_rng(5).normal(size=(pair.n, columns))
    series = chebyshev_series(lambda x: x**2 - x, spectral_interval(pair), order=order)
    scale = np.abs(series.coefficients).max()
    found = chebyshev_sums(pair, f, [series])[0]
    np.testing.assert_allclose(found, _by_numpy(pair, f, series), atol=1e-12 * scale)


@pytest.mark.parametrize("columns", [1, 2, 3, 5])
@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
def test_several_series_share_the_products(mass, columns):
    pair = laplacian(MESHES["bad"](), mass=mass)
    interval = spectral_interval(pair)
    f = np.random.default_rng(5).normal(size=(pair.n, columns))
    middle = interval.high / 2
    kernels = [Heat(30 / interval.high), LowPass(middle, middle), lambda x: 1 + 0 * x]
    series = [chebyshev_series(h, interval) for h in kernels]
    found = chebyshev_sums(pair, f, series)
    for one, together in zip(series, found, strict=True):
        np.testing.assert_allclose(together, chebyshev_sums(pair, f, [one])[0], atol=1e-12)
    np.testing.assert_allclose(found[2], f, atol=1e-12)


def test_progress_ends_at_its_total():
    pair = laplacian(MESHES["closed"]())
    series = chebyshev_series(Heat(1.0), spectral_interval(pair))
    told = []
    chebyshev_sums(pair, np.ones((pair.n, 6)), [series], lambda *step: told.append(step))
    assert told[-1][0] == told[-1][1]
    assert [done for done, _ in told] == sorted({done for done, _ in told})
    assert len(told) > 3


def test_the_input_stays_as_it_was():
    pair = laplacian(MESHES["closed"]())
    f = np.random.default_rng(0).normal(size=(pair.n, 5))
    f.flags.writeable = False
    series = chebyshev_series(Heat(0.1), spectral_interval(pair))
    first = chebyshev_sums(pair, f, [series])
    assert (chebyshev_sums(pair, f, [series]) == first).all()  # the same bits
