import dataclasses

import numpy as np
import pytest
from scipy.sparse import csc_array, csr_array

from beltrami.errors import DimensionError, NonFiniteError
from beltrami.solvers.factor import Factor
from beltrami.solvers.factorize import factorize

A = np.array([[4.0, 1, 0], [1, 3, 1], [0, 2, 5]])


class _Zeros:
    def solve(self, b):
        return np.full_like(b, np.nan)


def test_one_or_several_right_hand_sides():
    factor = factorize(csr_array(A))
    b = np.random.default_rng(60221407).normal(size=(3, 4))
    x = factor.solve(b)
    assert np.allclose(x, np.linalg.solve(A, b))
    assert x.shape == (3, 4)
    for column in range(4):
        one = factor.solve(b[:, column])
        assert one.shape == (3,)
        assert np.allclose(one, x[:, column], rtol=1e-14)
    for layout in (np.asfortranarray(b), b[::1, ::-1][:, ::-1], b.tolist()):
        assert np.allclose(factor.solve(layout), x, rtol=1e-14)
    assert factor.solve([1, 2, 3]).dtype == np.float64
    assert factor.solve(np.zeros((3, 0))).shape == (3, 0)


def test_the_right_hand_side_is_not_changed():
    b = np.arange(3.0)
    factorize(csr_array(A)).solve(b)
    assert b.tolist() == [0, 1, 2]


def test_wrong_shapes():
    factor = factorize(csr_array(A))
    for wrong in (np.zeros(2), np.zeros((2, 3)), np.zeros((3, 1, 1)), 1.0):
        with pytest.raises(DimensionError, match=r"where \(3,\) or \(3, c\) is needed"):
            factor.solve(wrong)


def test_values_that_are_not_finite_are_blamed_on_whom_they_come_from():
    with pytest.raises(NonFiniteError, match="right-hand side"):
        factorize(csr_array(A)).solve([0, np.nan, 1])
    with pytest.raises(NonFiniteError, match="right-hand side"):
        factorize(csr_array(A)).solve([0, np.inf, 1])
    with pytest.raises(NonFiniteError, match="solution"):
        Factor(csc_array(A), "fake", False, _Zeros()).solve([1, 2, 3])


def test_frozen_and_described():
    factor = factorize(csr_array(A))
    assert repr(factor) == f"<Factor: 3 unknowns, superlu, {factor.fill} non-zeros>"
    assert factor.fill >= 7
    with pytest.raises(dataclasses.FrozenInstanceError):
        factor.n = 4
