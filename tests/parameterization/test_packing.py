"""Packing: charts apart, inside, alike in scale, and closer than boxes could be."""

import numpy as np
import pytest

from beltrami.errors import MeshError
from beltrami.parameterization.packing import _lowest, _outlines, outline, pack


def polygon(points):
    points = np.asarray(points, dtype=np.float64)
    k = np.arange(len(points))
    return outline(points, np.stack([k, np.roll(k, -1)], axis=1))


def star(rng, corners=9):
    """A star-shaped polygon with a ragged boundary."""
    turn = 2 * np.pi * np.arange(corners) / corners
    r = rng.uniform(0.3, 1, corners) * rng.uniform(0.2, 1)
    return polygon(r[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1))


def samples(points, per_side=20):
    t = np.linspace(0, 1, per_side, endpoint=False)[:, None, None]
    after = np.roll(points, -1, axis=0)
    return (points + t * (after - points)).reshape(-1, 2)


@pytest.mark.parametrize("size", [64, 3000])
@pytest.mark.parametrize("padding", [0, 3])
def test_charts_keep_their_distance(size, padding):
    rng = np.random.default_rng(5)
    charts = [star(rng) for _ in range(12)]
    packed = pack(charts, size, padding)
    texels = [samples(points) * size for points in packed]
    for a in range(12):
        assert texels[a].min() >= padding
        assert texels[a].max() <= size - padding
        for b in range(a):
            gap = np.abs(texels[a][:, None] - texels[b][None]).max(axis=2).min()
            assert gap >= 2 * padding


def test_charts_are_turned_and_moved_but_not_deformed():
    rng = np.random.default_rng(6)
    charts = [star(rng) for _ in range(5)]
    packed = pack(charts, 256, 1)
    scales = []
    for chart, points in zip(charts, packed, strict=True):
        before = chart.points - chart.points.mean(axis=0)
        after = points - points.mean(axis=0)
        ratio = (after[:, 0] + 1j * after[:, 1]) / (before[:, 0] + 1j * before[:, 1])
        np.testing.assert_allclose(ratio, ratio[0], rtol=1e-9)  # a turn and a scale, no mirror
        scales.append(abs(ratio[0]))
    np.testing.assert_allclose(scales, scales[0], rtol=1e-9)


def test_one_chart_fills_the_square():
    (points,) = pack([polygon([[0, 0], [2, 0], [2, 2], [0, 2]])], 512, 2)
    np.testing.assert_allclose(np.ptp(points, axis=0), 1 - 4 / 512, atol=0.01)


def test_triangles_lie_in_each_others_hollows():
    """In boxes triangles fill a half of the square at the most."""
    rng = np.random.default_rng(9)
    charts = [polygon([[0, 0], [a, 0], [c * a, b]]) for a, b, c in rng.uniform(0.3, 1, (40, 3))]
    packed = pack(charts, 1024, 0)
    fill = sum(abs(np.linalg.det(points[1:] - points[0])) / 2 for points in packed)
    assert 0.6 < fill < 1


def test_too_many_charts_for_their_padding():
    charts = [polygon([[0, 0], [1, 0], [0, 1]])] * 30
    with pytest.raises(MeshError, match="30 charts with a padding of 4 do not fit into 32 texels"):
        pack(charts, 32, 4)


def test_the_unit_of_the_charts_does_not_matter():
    rng = np.random.default_rng(8)
    charts = [star(rng) for _ in range(6)]
    scaled = [outline(c.points * 2.0**-40, np.zeros((0, 2), int)) for c in charts]
    scaled = [type(c)(c.segments * 2.0**-40, s.points) for c, s in zip(charts, scaled, strict=True)]
    for one, two in zip(pack(charts, 128, 1), pack(scaled, 128, 1), strict=True):
        np.testing.assert_allclose(one, two, atol=1e-12)


@pytest.mark.parametrize("margin", [0, 2])
def test_outlines_against_numpy(margin):
    rng = np.random.default_rng(11)
    segments = rng.uniform(0, 20, (7, 2, 2))
    low, high = _outlines(segments, 21, margin)
    t = np.linspace(0, 1, 20001)[:, None]
    rows = {}
    for a, b in segments:
        for column, row in np.floor(a + t * (b - a)).astype(int).tolist():
            for q in range(column, column + 2 * margin + 1):
                rows.setdefault(q, set()).add(row)
    for q, found in rows.items():  # a column may be wider than what a segment covers of it
        assert low[q] <= min(found)
        assert high[q] >= max(found) + 1 + 2 * margin
        assert low[q] >= min(found) - 1
        assert high[q] <= max(found) + 2 + 2 * margin


def test_the_lowest_place_against_numpy():
    rng = np.random.default_rng(12)
    for _ in range(20):
        horizon = rng.integers(0, 9, 15)
        low = rng.integers(0, 4, 5)
        high = low + rng.integers(1, 5, 5)
        places = []
        for column in range(11):
            under = horizon[column : column + 5]
            row = max(int((under - low).max()), 0)
            lost = int((row + low - under).sum())
            places.append((int((row + high).max()), lost, column, row))
        top, lost, column, row = min(places)
        assert _lowest(horizon, low, high) == (top, lost, row, column)
