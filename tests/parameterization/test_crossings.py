"""Crossings, against every pair tested in fractions."""

from fractions import Fraction

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from beltrami.parameterization.crossings import crossings


def turn(a, b, c):
    d = (a[0] - c[0]) * (b[1] - c[1]) - (a[1] - c[1]) * (b[0] - c[0])
    return (d > 0) - (d < 0)


def between(a, b, p):
    """Whether p, on the line of a and b, lies on the segment."""
    return all(min(a[k], b[k]) <= p[k] <= max(a[k], b[k]) for k in (0, 1))


def have_more_in_common(x, s, t):
    """Whether two segments share a point beside one common end (of different vertices)."""
    p = [[Fraction(float(v)) for v in row] for row in x]
    common = set(s) & set(t)
    if len(common) == 2:
        return True
    if common:
        at = common.pop()
        (i,), (j,) = set(s) - {at}, set(t) - {at}
        in_line = turn(p[i], p[at], p[j]) == 0
        return in_line and (between(p[at], p[i], p[j]) or between(p[at], p[j], p[i]))
    a, b, c, d = (p[v] for v in (*s, *t))
    if turn(a, b, c) != turn(a, b, d) and turn(c, d, a) != turn(c, d, b):
        return True
    touch = ((a, b, c), (a, b, d), (c, d, a), (c, d, b))
    return any(turn(*q) == 0 and between(*q) for q in touch)


@given(st.integers(0, 10**6), st.integers(2, 7), st.sampled_from([3, 5, 1000]))
def test_against_every_pair(seed, n, grid):
    """Points of a coarse grid: shared places are avoided, lines and touching ends are not."""
    rng = np.random.default_rng(seed)
    places = rng.permutation(grid * grid)[:n] if grid < 100 else rng.integers(0, grid**2, n)
    x = np.stack(np.divmod(places, grid), axis=1) * 0.1
    if len(np.unique(x, axis=0)) < n:
        return
    segments = np.array([rng.permutation(n)[:2] for _ in range(6)])
    truth = [
        [i, j]
        for i in range(6)
        for j in range(i + 1, 6)
        if have_more_in_common(x, segments[i].tolist(), segments[j].tolist())
    ]
    assert crossings(x, segments).tolist() == truth


def test_a_long_polygon_has_none_until_a_vertex_crosses_over():
    t = 2 * np.pi * np.arange(1000) / 1000
    x = np.stack([np.cos(t), np.sin(t)], axis=1) * (1 + 0.3 * np.cos(40 * t))[:, None]
    around = np.stack([np.arange(1000), np.roll(np.arange(1000), -1)], axis=1)
    assert len(crossings(x, around)) == 0
    x[500] = x[0] * 1.01
    found = crossings(x, around)
    assert len(found)
    assert np.isin(found, [499, 500]).any(axis=1).all()


def test_many_segments_in_one_place():
    """More pairs of boxes than the first buffer has room for."""
    t = np.linspace(0, np.pi, 40, endpoint=False)
    star = np.stack([np.cos(t), np.sin(t)], axis=1)
    x = np.concatenate([star, -star])
    segments = np.stack([np.arange(40), 40 + np.arange(40)], axis=1)
    assert len(crossings(x, segments)) == 40 * 39 // 2
