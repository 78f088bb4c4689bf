"""Blocks of vertices, cut from the faces alone: bisection by distances counted in edges.

Integers only, so that coder and decoder cut alike on every machine.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import kernel
from beltrami._progress import Progress
from beltrami.compression.neighbourhood import Neighbourhood
from beltrami.compression.tables import whole


class Blocks(NamedTuple):
    """Parts of the vertices, each of neighbours as far as there are any.

    Attributes
    ----------
    vertices : (n,) int64
        The vertices, block after block.
    starts : (k + 1,) int64
        Where each block begins.
    """

    vertices: NDArray[np.int64]
    starts: NDArray[np.int64]

    def each(self, progress: Progress | None = None) -> Iterator[tuple[int, int]]:
        """Go from block to block, (first, last + 1), and tell how far that is."""
        for first, last in pairwise(self.starts.tolist()):
            yield first, last
            if progress is not None:
                progress(last, len(self.vertices))


def cut_into_blocks(near: Neighbourhood, n: int, most: int) -> Blocks:
    """Cut n vertices into the fewest blocks of at most ``most``; O(m log(n / most)).

    A part is cut across: its vertices are sorted by the difference of their distances to two
    vertices far from each other. Pieces that hang together nowhere count as far apart.

    Examples
    --------
    >>> from beltrami.compression.neighbourhood import look_around
    >>> strip = np.array([[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]])
    >>> blocks = cut_into_blocks(look_around(strip, 6), 6, 3)
    >>> [sorted(part.tolist()) for part in np.split(blocks.vertices, blocks.starts[1:-1])]
    [[3, 4, 5], [0, 1, 2]]
    """
    vertices = np.arange(n, dtype=np.int64)
    mark, distance = np.full(n, -1, np.int64), np.zeros((2, n), np.int64)
    parts = [(0, n, -(-n // most))]
    starts = [0]
    stamp = 0
    while parts:
        first, last, count = parts.pop()
        if count <= 1:
            starts.append(last)
            continue
        stamp += 1
        _sort_across(vertices[first:last], near, stamp, mark, distance)
        middle = first + (last - first) * (count // 2) // count
        parts.append((middle, last, count - count // 2))
        parts.append((first, middle, count // 2))
    return Blocks(vertices, np.array(starts if n else [0], np.int64))


@kernel
def _sort_across(part: Any, near: Any, stamp: int, mark: Any, distance: Any) -> None:
    """Sort the vertices of a part from one end to the other."""
    order = np.empty(part.size, np.int64)
    for i in range(part.size):
        mark[part[i]] = 2 * stamp
    _walk(part, part[0], near, 2 * stamp, mark, distance[0], order)
    end = order[part.size - 1]
    _walk(part, end, near, 2 * stamp + 1, mark, distance[0], order)
    other = order[part.size - 1]
    _walk(part, other, near, 2 * stamp, mark, distance[1], order)
    low = high = distance[0, end] - distance[1, end]
    for i in range(part.size):
        v = part[i]
        distance[0, v] -= distance[1, v]
        low, high = min(low, distance[0, v]), max(high, distance[0, v])
    places = np.zeros(high - low + 2, np.int64)
    for i in range(part.size):
        places[distance[0, part[i]] - low + 1] += 1
    for i in range(places.size - 1):
        places[i + 1] += places[i]
    for i in range(part.size):
        v = order[i]
        key = distance[0, v] - low
        part[places[key]] = v
        places[key] += 1


@kernel
def _walk(
    part: Any, start: int, near: Any, wanted: int, mark: Any, distance: Any, order: Any
) -> None:
    """Count the edges from ``start``, within the vertices marked so; ``order``: as they are met.

    What cannot be reached begins anew, one farther than all before. The marks change to the other
    one of their pair.
    """
    met = wanted ^ 1
    mark[start], distance[start] = met, 0
    order[0] = start
    size, done, waiting = whole(1), whole(0), whole(0)
    while done < part.size:
        if done == size:
            while mark[part[waiting]] != wanted:
                waiting += 1
            v = part[waiting]
            mark[v], distance[v] = met, distance[order[size - 1]] + 1
            order[size] = v
            size += 1
        v = order[done]
        done += 1
        for j in range(near.starts[v], near.starts[v + 1]):
            u = near.around[j]
            if mark[u] == wanted:
                mark[u], distance[u] = met, distance[v] + 1
                order[size] = u
                size += 1
