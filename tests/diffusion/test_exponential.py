"""The proven error of the exact flow, and that another sharpness or degree would not do."""

import numpy as np
import pytest
from scipy.linalg import eigh

from beltrami.diffusion.exponential import ERROR, SHARPNESS, coefficients, diffuse_exactly
from beltrami.diffusion.held import free_part
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES


def test_the_series_is_the_exponential_on_the_whole_interval():
    mu = np.concatenate([np.geomspace(1e-12, 1, 5000), np.linspace(0.001, 1, 5000)])
    exact = np.exp(-SHARPNESS * (1 / mu - 1))

    def check(series):
        assert np.abs(np.polynomial.chebyshev.chebval(2 * mu - 1, series) - exact).max() <= ERROR

    check(coefficients())
    with pytest.raises(AssertionError):  # no term is there for nothing
        check(coefficients()[:-1])
    assert len(coefficients()) == 31


@pytest.mark.parametrize("mass", ["degree", "voronoi", "consistent"])
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_error_is_below_the_bound_for_all_times(name, mass):
    pair = laplacian(MESHES[name](), mass=mass)
    values, vectors = eigh(pair.stiffness.toarray(), pair.mass.toarray())
    part = free_part(pair.stiffness, pair.mass, np.zeros(pair.n, bool))
    rng = np.random.default_rng(66260)
    f = part.centred(rng.normal(size=(pair.n, 2)))
    for lengths in (1e-6, 1e-2, 1, 30, 1e3, 1e5):
        time = lengths / values[-1]
        decay = np.exp(-time * values)
        exact = vectors @ (decay[:, None] * (vectors.T @ (pair.mass @ f)))
        assert pair.norm(diffuse_exactly(part, f, time) - exact) < 2 * ERROR * pair.norm(f)


def test_progress_is_told():
    pair = laplacian(MESHES["open"]())
    part = free_part(pair.stiffness, pair.mass, np.zeros(pair.n, bool))
    seen = []
    diffuse_exactly(part, np.ones(pair.n), 1.0, lambda done, total: seen.append((done, total)))
    assert seen[-1] == (29, 29)
