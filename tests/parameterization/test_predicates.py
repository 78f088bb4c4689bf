"""Signs must be exact: against fractions, on points that rounding cannot tell from a line."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltrami.parameterization.predicates import orientation

# Few different numbers, near to each other and far apart in size: lines and near-lines abound.
NUMBERS = st.one_of(
    st.sampled_from([0.0, 0.1, 0.2, 0.3, 0.5, 0.7, 0.8, 1.0, 1e-300, 5e-324, 1e200, -1e-17]),
    st.integers(0, 40).map(lambda k: 0.5 + k * 2.0**-53),
    st.floats(-1e160, 1e160),
)
POINT = st.tuples(NUMBERS, NUMBERS)


def exact(a, b, c):
    ax, ay, bx, by, cx, cy = (Fraction(x) for x in (*a, *b, *c))
    d = (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)
    return (d > 0) - (d < 0)


@given(POINT, POINT, POINT)
def test_signs_are_those_of_fractions(a, b, c):
    x = np.array([a, b, c])
    signs = orientation(x[:1], x[1:2], x[2:])
    assert signs.tolist() == [exact(a, b, c)]
    assert orientation(x[1:2], x[:1], x[2:]).tolist() == [-exact(a, b, c)]


def test_doubles_get_them_wrong():
    """The plain determinant fails on what the filter hands over, so the fallback is needed."""
    i, j = np.divmod(np.arange(64 * 64), 64)
    a = np.stack([0.5 + i * 2.0**-53, 0.5 + j * 2.0**-53], axis=1)
    b, c = np.full_like(a, 12.0), np.full_like(a, 24.0)
    left, right = (a[:, 0] - c[:, 0]) * (b[:, 1] - c[:, 1]), (a[:, 1] - c[:, 1]) * (b - c)[:, 0]
    truth = np.array([exact(*p) for p in zip(a.tolist(), b.tolist(), c.tolist(), strict=True)])
    assert np.count_nonzero(np.sign(left - right) != truth) > 1000
    np.testing.assert_array_equal(orientation(a, b, c), truth)


@pytest.mark.parametrize("unit", [1e-300, 1e-160, 1.0, 1e150])
def test_tiny_and_huge_triangles(unit):
    x = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]) * unit
    assert orientation(x[:1], x[1:2], x[2:]).tolist() == [1]
    assert orientation(x[:1], x[2:], x[1:2]).tolist() == [-1]


def test_no_rows():
    none = np.zeros((0, 2))
    assert orientation(none, none, none).shape == (0,)
