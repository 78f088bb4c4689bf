"""Directions corrected by secants: what the updates by rank two of a dense matrix give."""

import numpy as np
import pytest

from beltrami.parameterization.secants import descent, secant


def updated(B, step, change):
    """Return the matrix of Broyden, Fletcher, Goldfarb and Shanno, as it is printed everywhere."""
    Bs = B @ step
    return B - np.outer(Bs, Bs) / (step @ Bs) + np.outer(change, change) / (step @ change)


@pytest.fixture
def setting():
    rng = np.random.default_rng(0)
    A, first = (m @ m.T + np.eye(6) for m in rng.normal(size=(2, 6, 6)))
    steps = rng.normal(size=(3, 6))
    return A, first, [(step, A @ step) for step in steps], rng.normal(size=6)


@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_it_is_the_direction_of_the_updated_matrix(setting, count):
    _, B, secants, gradient = setting
    found = descent(gradient, secants[:count], lambda r, B=B: np.linalg.solve(B, r))
    for step, change in secants[:count]:
        B = updated(B, step, change)
    np.testing.assert_allclose(found, -np.linalg.solve(B, gradient), rtol=1e-9)
    assert found @ gradient < 0


def test_the_last_secant_is_known_exactly(setting):
    _, B, secants, _ = setting
    step, change = secants[-1]
    found = descent(change, secants, lambda r: np.linalg.solve(B, r))
    np.testing.assert_allclose(found, -step, rtol=1e-9)


def test_what_bends_down_or_is_no_number_is_no_secant():
    step = np.array([1.0, 0.0])
    assert secant(step, np.array([0.5, 3.0])) is not None
    for change in ([-0.5, 3.0], [0.0, 3.0], [np.nan, 0.0]):
        assert secant(step, np.array(change)) is None
