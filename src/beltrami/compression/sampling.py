"""A part of a mesh that stands for all of it: regions about vertices far from each other."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Integers
from beltrami._jit import kernel
from beltrami.compression.neighbourhood import Neighbourhood, sweep
from beltrami.compression.tables import whole

_REGION = 2000  # vertices of a region, about


def sample_of(near: Neighbourhood, size: int) -> Integers:
    """Return about ``size`` vertices, ascending: as many regions, evenly spread; O(size).

    A region is what is met first on a walk from its middle; middles are evenly spread over the
    numbers, which follow a walk over the surface.

    Examples
    --------
    >>> from beltrami.compression.neighbourhood import look_around
    >>> strip = np.array([[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]])
    >>> sample_of(look_around(strip, 6), 4)
    array([1, 2, 3, 4])
    """
    taken = np.zeros(len(near.starts) - 1, np.bool_)
    middles, each = _middles(near, size)
    for middle in middles.tolist():
        _walk(middle, each, near, taken)
    return np.flatnonzero(taken)


def order_of_sample(near: Neighbourhood, size: int) -> Integers:
    """Return about ``size`` vertices as they would be coded, region by region.

    Each region is swept over without an end in sight: what costs more at the end of a surface
    than within it does not count.
    """
    return sweep(near, *_middles(near, size))


def _middles(near: Neighbourhood, size: int) -> tuple[Integers, int]:
    """Return the middles of the regions, and how many vertices each of them is to have."""
    n, count = len(near.starts) - 1, max(1, size // _REGION)
    return (2 * np.arange(count) + 1) * n // (2 * count), size // count


def part_of(faces: Integers, n: int, sample: Integers) -> Integers:
    """Return the faces (m', 3) within a sample of n vertices, in the numbers of the sample."""
    place = np.full(n, -1)
    place[sample] = np.arange(len(sample))
    found = place[faces]
    return found[(found >= 0).all(axis=1)]


@kernel
def _walk(start: int, size: int, near: Any, taken: Any) -> None:
    """Take up to ``size`` vertices that are not taken, ring by ring."""
    while taken[start]:
        start = (start + 1) % taken.size
    queue = np.empty(size, np.int64)
    queue[0] = start
    taken[start] = True
    end, done = whole(1), whole(0)
    while done < end:
        v = queue[done]
        done += 1
        for j in range(near.starts[v], near.starts[v + 1]):
            u = near.around[j]
            if end < size and not taken[u]:
                taken[u] = True
                queue[end] = u
                end += 1
