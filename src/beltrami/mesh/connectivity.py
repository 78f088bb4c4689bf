"""Connectivity: components, orientability and two-colourings, by union-find with parity."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Booleans, Integers
from beltrami._jit import kernel


def component_labels(pairs: NDArray[Any], n: int) -> Integers:
    """Label the components of a graph on n nodes, 0, 1, ... in the order of their first node.

    Chapter items: T7.

    Examples
    --------
    >>> component_labels(np.array([[0, 3], [1, 2]]), 4).tolist()
    [0, 1, 1, 0]
    """
    labels, _, _ = _components(pairs, np.zeros(len(pairs), np.bool_), n)
    return labels


def faces_joined_by_edges(face_edges: NDArray[np.int32], p: int) -> Integers:
    """Label the components of faces with common edges, among p, of however many faces."""
    m = len(face_edges)
    face, side = np.nonzero(face_edges >= 0)
    pairs = np.stack([face, m + face_edges[face, side]], axis=1)
    return component_labels(pairs, m + p)[:m]


def parity_colouring(pairs: NDArray[Any], differ: Booleans, n: int) -> Booleans | None:
    """Colour n nodes so that the ends of pair e differ exactly where ``differ[e]``.

    The first node of each component is False. With ``differ`` all true this is a colouring with
    two colours (definition 18); over pairs of neighbouring faces it is an orientation.

    Chapter items: D18.

    Returns
    -------
    (n,) bool, or None if there is no such colouring.

    Examples
    --------
    >>> square = np.array([[0, 1], [1, 2], [2, 3], [0, 3]])
    >>> parity_colouring(square, np.ones(4, bool), 4).tolist()
    [False, True, False, True]
    >>> parity_colouring(np.array([[0, 1], [1, 2], [0, 2]]), np.ones(3, bool), 3) is None
    True
    """
    _, colour, consistent = _components(pairs, differ, n)
    return colour if consistent else None


@kernel
def _find(parent: Any, flip: Any, x: int) -> Any:
    """Return the root of x and the parity between them, and shorten the path."""
    root = x
    parity = False
    while parent[root] != root:
        parity ^= flip[root]
        root = parent[root]
    total = parity
    while parent[x] != root and x != root:
        following, step = parent[x], flip[x]
        parent[x], flip[x] = root, parity
        parity ^= step
        x = following
    return root, total


@kernel
def _components(pairs: Any, differ: Any, n: int) -> Any:
    """Union-find; the smaller root wins, so that roots come first in their components."""
    parent = np.arange(n)
    flip = np.zeros(n, np.bool_)  # parity between a node and its parent
    consistent = True
    for e in range(pairs.shape[0]):
        a, parity_a = _find(parent, flip, pairs[e, 0])
        b, parity_b = _find(parent, flip, pairs[e, 1])
        parity = parity_a ^ parity_b ^ differ[e]
        if a == b:
            consistent = consistent and not parity
        else:
            low, high = min(a, b), max(a, b)
            parent[high], flip[high] = low, parity
    labels = np.empty(n, np.int64)
    colour = np.zeros(n, np.bool_)
    count = 0
    for x in range(n):
        root, parity = _find(parent, flip, x)
        if root == x:
            labels[x] = count
            count += 1
        else:
            labels[x] = labels[root]
            colour[x] = parity
    return labels, colour, consistent
