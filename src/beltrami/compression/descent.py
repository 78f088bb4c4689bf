"""The lowest place of a valley, without a look at all places."""

from __future__ import annotations

from collections.abc import Callable


def downhill(height: Callable[[int], float], count: int, start: int) -> int:
    """Go from place to place of 0..count-1 as long as it goes down; no place is looked at twice.

    Examples
    --------
    >>> heights, looked = [9, 4, 2, 3, 1], []
    >>> downhill(lambda i: looked.append(i) or heights[i], 5, 1), looked
    (2, [1, 2, 3])
    """
    best, lowest = start, height(start)
    for way in (1, -1):
        place = start + way
        while 0 <= place < count and (here := height(place)) < lowest:
            best, lowest, place = place, here, place + way
        if best != start:
            break
    return best
