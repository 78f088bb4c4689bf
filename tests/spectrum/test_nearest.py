"""Nearest neighbours and spread samples, against all distances."""

import numpy as np
import pytest
from scipy.spatial import KDTree

from beltrami.spectrum.nearest import nearest_rows, spread_rows


@pytest.mark.parametrize(("n", "q"), [(1, 1), (5, 300), (1023, 257), (1025, 256), (2100, 513)])
@pytest.mark.parametrize("d", [1, 16, 17, 40])
def test_nearest(n, q, d):
    rng = np.random.default_rng(n + d)
    among, queries = rng.normal(size=(n, d)) + 3, rng.normal(size=(q, d))
    found = nearest_rows(among, queries)
    distance, expected = KDTree(among).query(queries)
    assert np.array_equal(found, expected)
    np.testing.assert_allclose(np.linalg.norm(queries - among[found], axis=1), distance)
    assert np.array_equal(nearest_rows(among, among), np.arange(n))


def test_of_equal_ones_the_first():
    among = np.ones((3000, 20))
    assert not nearest_rows(among, np.zeros((4, 20))).any()


def test_spread_rows_are_each_the_farthest():
    points = np.random.default_rng(3).normal(size=(80, 3))
    chosen = spread_rows(points, 30)
    assert len(set(chosen)) == 30
    for i in range(1, 30):
        gaps = np.linalg.norm(points[:, None] - points[chosen[:i]], axis=2).min(axis=1)
        assert gaps[chosen[i]] == pytest.approx(gaps.max())
    assert sorted(spread_rows(points, 80)) == list(range(80))


def test_spread_rows_are_distinct_even_if_points_are_not():
    assert sorted(spread_rows(np.ones((5, 2)), 5)) == [0, 1, 2, 3, 4]
