"""The front: loops of vertices between the faces that are known and those that are not."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import plain_kernel
from beltrami.compression.tables import whole

BUCKETS = 24


class Front(NamedTuple):
    """Nodes in circular lists, and in buckets by the number of faces they still lack.

    A vertex has a node for each fan of unknown faces around it. The side from a node to the next
    one is run through in this direction by the unknown face behind it.

    Attributes
    ----------
    after, before : (k,) int32
        The neighbours of a node in its loop.
    vertex : (k,) int32
        Its vertex.
    missing : (k,) int32
        How many unknown faces its fan has; 0 for a node that is not in use.
    gate : (k,) int32
        The unknown half-edge to the next node; only the encoder knows it.
    behind : (k,) int32
        The third vertex of the known face at the side to the next node.
    up, down : (k,) int32
        The neighbours of a node in its bucket; -1 at the ends.
    top : (BUCKETS + 1,) int32
        The first node of each bucket, -1 if it is empty; last the number of nodes ever made.
    """

    after: NDArray[np.int32]
    before: NDArray[np.int32]
    vertex: NDArray[np.int32]
    missing: NDArray[np.int32]
    gate: NDArray[np.int32]
    behind: NDArray[np.int32]
    up: NDArray[np.int32]
    down: NDArray[np.int32]
    top: NDArray[np.int32]


def new_front(nodes: int) -> Front:
    """Make an empty front with room for so many nodes."""
    lists = np.zeros((8, nodes), np.int32)
    top = np.full(BUCKETS + 1, -1, np.int32)
    top[BUCKETS] = 0
    a, b, c, d, e, f, g, h = lists
    return Front(a, b, c, d, e, f, g, h, top)


@plain_kernel
def insert(front: Any, x: int) -> None:
    """Put a node at the top of the bucket of its number of missing faces."""
    bucket = min(front.missing[x], BUCKETS - 1)
    first = front.top[bucket]
    front.up[x], front.down[x] = -1, first
    if first >= 0:
        front.up[first] = x
    front.top[bucket] = x


@plain_kernel
def remove(front: Any, x: int) -> None:
    """Take a node out of its bucket."""
    above, below = front.up[x], front.down[x]
    if above >= 0:
        front.down[above] = below
    else:
        front.top[min(front.missing[x], BUCKETS - 1)] = below
    if below >= 0:
        front.up[below] = above


@plain_kernel
def lower(front: Any, x: int, count: int) -> None:
    """Change the number of missing faces of a node to ``count``; it stays in a bucket."""
    remove(front, x)
    front.missing[x] = count
    insert(front, x)


@plain_kernel
def drop(front: Any, x: int) -> None:
    """Take a node out of use."""
    remove(front, x)
    front.missing[x] = 0


@plain_kernel
def add(front: Any, vertex: int, missing: int, gate: int, behind: int) -> int:
    """Make a node, in no loop yet; return its number."""
    x = whole(front.top[BUCKETS])
    front.top[BUCKETS] = x + 1
    front.vertex[x], front.missing[x] = vertex, missing
    front.gate[x], front.behind[x] = gate, behind
    insert(front, x)
    return x


@plain_kernel
def link(front: Any, x: int, y: int) -> None:
    """Let y follow x in a loop."""
    front.after[x], front.before[y] = y, x


@plain_kernel
def pivot(front: Any) -> int:
    """Return the node that lacks the fewest faces, the latest of them; -1 if there is none."""
    for bucket in range(1, BUCKETS):
        if front.top[bucket] >= 0:
            return whole(front.top[bucket])
    return -1
