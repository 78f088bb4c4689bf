"""Equation 3.10: heat damps each coefficient, F̂_t = exp(-λt) f̂."""

import numpy as np
import pytest
import scipy.linalg

from beltrami.diffusion.heat import heat
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.filtering import FILTER_METHODS
from beltrami.spectrum.filtering import filter as filter_function
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.kernels import Heat
from meshes_of_the_errata import MESHES

pytestmark = pytest.mark.chapter("Q3.10")
CASES = [
    ("closed", "combinatorial", "degree"),
    ("bad", "cotangent", "degree"),
    ("bad", "cotangent", "voronoi"),
    ("leaves", "cotangent", "consistent"),
]


def _case(name, weights, mass):
    pair = laplacian(MESHES[name](), weights, mass)
    f = np.random.default_rng(10).normal(size=pair.n)
    A = np.linalg.solve(pair.mass.toarray(), pair.stiffness.toarray())
    return pair, f, A


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("method", FILTER_METHODS)
def test_against_the_exponential_of_the_matrix(case, method):
    pair, f, A = _case(*case)
    for t in (0.1, 1.0):
        truth = scipy.linalg.expm(-t * A) @ f
        found = filter_function(pair, f, Heat(t), method)
        np.testing.assert_allclose(found, truth, atol=1e-7)
        for wrong in (Heat(t / 2), lambda x, t=t: np.exp(-t * np.sqrt(x))):
            assert np.abs(filter_function(pair, f, wrong, "exact") - truth).max() > 1e-3


@pytest.mark.parametrize("case", CASES)
def test_each_coefficient_by_itself(case):
    pair, f, _ = _case(*case)
    basis = fourier_basis(pair, pair.n)
    t = 3 / basis.eigenvalues[min(5, pair.n - 1)]
    later = basis.forward(filter_function(pair, f, Heat(t)))
    before = basis.forward(f)
    np.testing.assert_allclose(later, np.exp(-t * basis.eigenvalues) * before, atol=1e-6)
    assert later[0] == pytest.approx(before[0], abs=1e-7)  # the mean stays


@pytest.mark.parametrize("method", FILTER_METHODS)
def test_no_time_changes_nothing_and_times_add(method):
    pair, f, _ = _case(*CASES[1])
    np.testing.assert_allclose(filter_function(pair, f, Heat(0.0), method), f, atol=1e-12)
    twice = filter_function(pair, filter_function(pair, f, Heat(0.3), method), Heat(0.4), method)
    np.testing.assert_allclose(twice, filter_function(pair, f, Heat(0.7), method), atol=1e-7)


def test_the_steps_of_the_schemes_tend_to_it():
    """Both of first order: half the step, half the error, on either side (E75)."""
    pair, f, _ = _case(*CASES[0])
    truth = filter_function(pair, f, Heat(2.0), "exact")
    errors = [
        [pair.norm(heat(pair, f, 2.0, method, steps) - truth) for steps in (40, 80)]
        for method in ("implicit", "explicit")
    ]
    for coarse, fine in errors:
        assert coarse / fine == pytest.approx(2, rel=0.05)
