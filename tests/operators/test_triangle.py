import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beltrami.mesh.triangle import (
    BARYCENTRIC,
    CIRCUMCENTRIC,
    VORONOI,
    is_flat,
    measure,
    shares,
)

SEEDS = st.integers(0, 2**40)


def _random_triangle(seed):
    return np.random.default_rng(seed).normal(size=(3, 3))


def _circumcentric(x):
    """Signed areas of the pieces between a corner, two middles of sides and the circumcentre."""
    u, v = x[1] - x[0], x[2] - x[0]
    s, t = np.linalg.solve(2 * np.array([[u @ u, u @ v], [u @ v, v @ v]]), np.array([u @ u, v @ v]))
    centre = x[0] + s * u + t * v
    normal = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
    area = lambda a, b, c: normal @ np.cross(b - a, c - a) / 2  # noqa: E731
    out = []
    for c in range(3):
        one, two = x[(c + 1) % 3], x[(c + 2) % 3]
        out.append(area(x[c], (x[c] + one) / 2, centre) + area(x[c], centre, (x[c] + two) / 2))
    return np.array(out)


@settings(deadline=None, max_examples=50)
@given(SEEDS)
def test_measure_gives_dot_products_and_the_area(seed):
    x = _random_triangle(seed)
    got = measure(x, 0, 1, 2)
    for c in range(3):
        u, v = x[(c + 1) % 3] - x[c], x[(c + 2) % 3] - x[c]
        assert got[c] == pytest.approx(u @ v, rel=1e-10, abs=1e-12)
    assert got[3] == pytest.approx(np.linalg.norm(np.cross(x[1] - x[0], x[2] - x[0])), rel=1e-10)


@settings(deadline=None, max_examples=50)
@given(SEEDS)
def test_shares_add_to_the_area(seed):
    x = _random_triangle(seed)
    numbers = measure(x, 0, 1, 2)
    double = numbers[3]
    assert np.allclose(shares(*numbers, BARYCENTRIC), double / 6)
    signed = np.array(shares(*numbers, CIRCUMCENTRIC))
    assert np.allclose(signed, _circumcentric(x), rtol=1e-8, atol=1e-10 * np.abs(signed).max())
    mixed = np.array(shares(*numbers, VORONOI))
    assert mixed.sum() == pytest.approx(double / 2)
    at = np.array(numbers[:3])
    if at.min() < 0:
        assert np.allclose(mixed, np.where(at < 0, double / 4, double / 8))
    else:
        assert np.allclose(mixed, signed)
    assert (mixed > 0).all()


def test_each_corner_may_be_the_obtuse_one():
    x = np.array([[0.0, 0, 0], [4, 0, 0], [2, 1, 0]])  # area 2, obtuse at the last
    for turn in range(3):
        turned = np.roll(x, turn, axis=0)
        expected = np.roll([0.5, 0.5, 1.0], turn)
        assert np.allclose(shares(*measure(turned, 0, 1, 2), VORONOI), expected)


@pytest.mark.parametrize("unit", [1e-9, 1.0, 1e9])
def test_flatness_has_no_unit(unit):
    for height, flat in ((3e-12, False), (1e-12, True), (0.0, True)):
        x = unit * np.array([[0.0, 0, 0], [1, 0, 0], [0.5, height, 0]])  # area = height / 2
        assert is_flat(*measure(x, 0, 1, 2)) is flat
    assert is_flat(np.nan, 1.0, 1.0, np.nan)
