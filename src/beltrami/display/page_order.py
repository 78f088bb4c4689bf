"""The order in which a page lists faces and vertices: neighbours follow each other."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, depth_first_order

from beltrami._arrays import Integers


class Order(NamedTuple):
    """Faces and vertices listed anew.

    Attributes
    ----------
    faces : (m, 3) int
        New numbers of the vertices; the corner with the largest number comes first, and the
        direction around the face is kept.
    corners : (m, 3) int
        Where in the old array of faces, flattened, each corner was.
    vertices : (n,) int
        The old number of each vertex.
    """

    faces: Integers
    corners: Integers
    vertices: Integers


class Pairs(NamedTuple):
    """Two faces at one edge each: vertices a < b of the edge, c and d opposite to it."""

    a: Integers
    b: Integers
    c: Integers
    d: Integers
    first: Integers
    second: Integers


def pair_faces(faces: Integers, n: int) -> Pairs:
    """Pair the faces at each edge; where there are more than two, each with the next one.

    Examples
    --------
    >>> pairs = pair_faces(np.array([[0, 1, 2], [0, 2, 3]]), 4)
    >>> [int(one[0]) for one in pairs]
    [0, 2, 1, 3, 0, 1]
    """
    m = len(faces)
    ends = np.concatenate([faces[:, [1, 2]], faces[:, [2, 0]], faces[:, [0, 1]]])
    low, high = ends.min(axis=1), ends.max(axis=1)
    key = low * n + high
    by_edge = np.argsort(key, kind="stable")
    same = np.flatnonzero(key[by_edge][1:] == key[by_edge][:-1])
    one, other = by_edge[same], by_edge[same + 1]
    opposite = faces.T.ravel()
    face = np.tile(np.arange(m), 3)
    return Pairs(low[one], high[one], opposite[one], opposite[other], face[one], face[other])


def order_of(faces: Integers, n: int) -> Order:
    """List faces depth first across their sides, and vertices as they are first named.

    Then a face mostly names the newest vertex and two that are hardly older, and the values at
    a vertex can be guessed from those before it. Vertices of no face come last. Cost: O(m log m).

    Examples
    --------
    >>> order = order_of(np.array([[4, 5, 6], [0, 2, 1], [1, 2, 3]]), 7)
    >>> order.vertices.tolist(), order.faces.tolist()
    ([4, 5, 6, 0, 2, 1, 3], [[2, 0, 1], [5, 3, 4], [6, 5, 4]])
    """
    m = len(faces)
    walk = _walk(faces, n)
    chosen = faces[walk]
    named, place = np.unique(chosen, return_index=True)
    unnamed = np.setdiff1d(np.arange(n), named)
    vertices = np.concatenate([named[np.argsort(place)], unnamed])
    number = np.empty(n, np.int64)
    number[vertices] = np.arange(n)
    turned = (number[chosen].argmax(axis=1)[:, None] + np.arange(3)) % 3
    corners = walk[:, None] * 3 + turned
    return Order(number[faces.ravel()[corners]].reshape(m, 3), corners, vertices)


def _walk(faces: Integers, n: int) -> Integers:
    """Return all faces, depth first; components are chained by their first faces."""
    m = len(faces)
    pairs = pair_faces(faces, n)
    labels = connected_components(_graph(pairs.first, pairs.second, m), directed=False)[1]
    starts = np.sort(np.unique(labels, return_index=True)[1])
    first = np.concatenate([pairs.first, starts[:-1]])
    second = np.concatenate([pairs.second, starts[1:]])
    walk = depth_first_order(_graph(first, second, m), 0, return_predecessors=False)
    return np.asarray(walk, np.int64)


def _graph(first: Integers, second: Integers, m: int) -> csr_array:
    ones = np.ones(2 * len(first), np.int8)
    ends = np.concatenate([first, second]), np.concatenate([second, first])
    graph = coo_array((ones, ends), shape=(m, m)).tocsr()
    graph.data[:] = 1  # two faces may share two sides
    return csr_array(graph)
