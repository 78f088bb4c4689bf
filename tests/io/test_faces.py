"""Fans and strips against short versions of the same."""

from __future__ import annotations

import numpy as np

from beltrami.io.faces import fan, first_outside, unroll


def test_fan():
    rng = np.random.default_rng(24_886_310)
    sizes = rng.integers(3, 9, 50)
    corners = rng.integers(0, 99, sizes.sum())
    expected = []
    for polygon in np.split(corners, np.cumsum(sizes)[:-1]):
        expected += [[polygon[0], polygon[c], polygon[c + 1]] for c in range(1, len(polygon) - 1)]
    assert fan(corners, sizes).tolist() == np.array(expected).tolist()


def test_unroll():
    rng = np.random.default_rng(90_412_775)
    strip = rng.integers(-1, 5, 400)
    expected = []
    current: list[int] = []
    for k in strip.tolist():
        current = [] if k < 0 else [*current, k]
        if len(current) > 2:
            i, j, k = current[-3:]
            if len({i, j, k}) == 3:
                expected.append([i, j, k] if len(current) % 2 else [j, i, k])
    assert unroll(strip).tolist() == expected
    assert unroll(np.array([0, 1])).shape == (0, 3)


def test_first_outside():
    assert first_outside(np.array([0, 4, 5, -1]), 5) == 2
    assert first_outside(np.array([0, -1, 5]), 5) == 1
    assert first_outside(np.array([0, 4]), 5) == -1
