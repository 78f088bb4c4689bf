"""Where to cut a set along a key: every place is tried at once, and the thinnest is taken."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel

_SMALLEST = 0.25  # part of a set that each side of a cut has at least
_UNEQUAL = 0.5  # a cut of sides a and b may be thicker by this times ((a - b) / (a + b))²
PLACES = 4096  # that are tried, at most
_FEWEST = 32


@kernel
def cut(
    indptr: Any,
    indices: Any,
    order: Any,
    low: int,
    high: int,
    owner: Any,
    mine: int,
    key: Any,
    reach: Any,
    bins: Any,
) -> Any:
    """Cut order[low:high], whose owner is ``mine``, where few vertices separate it.

    Makes the owner of the other side mine + 1, and that of the separator, which is the vertices of
    one side with neighbours in the other, mine + 2. Workspace: ``reach`` (n, 2), ``bins``
    (PLACES, 3).

    Where the keys are too unequal, or equal, for a good place, their ranks take their stead; where
    those do not help, for the graph is dense, the middle is the place.
    """  # fmt: skip
    place, left, least, scale = _place(
        indptr, indices, order, low, high, owner, mine, key, reach, bins, False
    )
    if place < 0:
        _rank(order, low, high, key)
        place, left, least, scale = _place(
            indptr, indices, order, low, high, owner, mine, key, reach, bins, True
        )
    for t in range(np.uint64(low), np.uint64(high)):
        v = order[t]
        if np.int64((key[v] - least) * scale) > place:
            beyond = np.int64((reach[v, 0] - least) * scale) <= place
            owner[v] = mine + 2 if beyond and not left else mine + 1
        elif left and np.int64((reach[v, 1] - least) * scale) > place:
            owner[v] = mine + 2


@kernel
def _rank(order: Any, low: int, high: int, key: Any) -> None:
    keys = np.empty(high - low)
    for t in range(low, high):
        keys[t - low] = key[order[t]]
    way = np.argsort(keys, kind="mergesort")
    for t in range(high - low):
        key[order[low + way[t]]] = t


@kernel
def _place(
    indptr: Any,
    indices: Any,
    order: Any,
    low: int,
    high: int,
    owner: Any,
    mine: int,
    key: Any,
    reach: Any,
    bins: Any,
    always: bool,
) -> Any:
    """Return (place, left, least, scale): sides are floor((key - least) * scale) <= place and not.

    ``left`` tells whose vertices separate; place -1 that none is good, unless ``always``.
    reach[v] becomes the smallest and the largest key of v and its neighbours in the set.
    """  # fmt: skip
    one, size = np.uint64(1), high - low
    least = most = key[order[low]]
    for t in range(np.uint64(low), np.uint64(high)):
        k = key[order[t]]
        least, most = min(least, k), max(most, k)
    number = min(max(int(np.sqrt(size)), _FEWEST), PLACES)
    spread = most - least
    scale = (number - 0.5) / spread if spread > 0 else 0.0
    if not 0 < scale < 1e300:
        return -1, True, 0.0, 0.0
    bins[:number] = 0
    for t in range(np.uint64(low), np.uint64(high)):
        v = order[t]
        smallest = largest = key[v]
        for q in range(indptr[v], indptr[v + one]):
            w = np.uint64(indices[q])
            if owner[w] == mine:
                k = key[w]
                smallest, largest = min(smallest, k), max(largest, k)
        reach[v, 0], reach[v, 1] = smallest, largest
        own = np.uint64(np.int64((key[v] - least) * scale))
        bins[own, 0] += 1
        bins[own, 1] += 1
        bins[np.uint64(np.int64((largest - least) * scale)), 1] -= 1
        bins[np.uint64(np.int64((smallest - least) * scale)), 2] += 1
        bins[own, 2] -= 1
    return _thinnest(bins, number, size, least, scale, always)


@kernel
def _thinnest(bins: Any, number: int, size: int, least: float, scale: float, always: bool) -> Any:
    """Go through the places: how many vertices lie before each, and would separate there."""
    before = before_cut = after_cut = 0
    cheapest, place, left = np.inf, -1, True
    middle, at, half = np.inf, 0, True
    for p in range(number - 1):
        before += bins[p, 0]
        before_cut += bins[p, 1]
        after_cut += bins[p, 2]
        for side in range(2):
            cut = before_cut if side == 0 else after_cut
            a = before - cut if side == 0 else before
            b = size - cut - a
            if min(a, b) > 0 and min(a, b) >= _SMALLEST * (a + b):
                cost = cut * (1 + _UNEQUAL * ((a - b) / (a + b)) ** 2)
                if cost < cheapest:
                    cheapest, place, left = cost, p, side == 0
        if place < 0 and always and abs(2 * before - size) < middle:
            middle, at, half = abs(2 * before - size), p, before_cut <= after_cut
    if place < 0 and always:
        return at, half, least, scale
    return place, left, least, scale
