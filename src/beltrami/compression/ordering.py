"""The order of the vertices, in about log2(n!) bits, less where it follows the surface."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Integers
from beltrami._jit import plain_kernel
from beltrami.compression.range_coder import (
    adapt,
    code,
    code_number,
    code_uniform,
    finished,
    new_decoder,
    new_encoder,
    readable,
)
from beltrami.compression.tables import whole
from beltrami.compression.varint import Reader

_NEAR = 32  # ranks to both sides of the expected one that are coded as steps, at most;
_SHARE = 6  # and at most 2^-6 of those that are left


def encode_order(order: Integers) -> bytes:
    """Write a permutation of 0..n-1; O(n log n).

    Examples
    --------
    >>> data = encode_order(np.arange(1000))
    >>> len(data) < 80, decode_order(Reader(data, "a.btm"), 1000).tolist() == list(range(1000))
    (True, True)
    """
    state = new_encoder()
    buffer = np.zeros(5 * len(order) + 64, np.uint8)
    _code_order(
        order.astype(np.int64), np.zeros(len(order) + 1, np.int64), _models(), state, buffer
    )
    data = finished(state, buffer)
    if data is None:  # 5 bytes a vertex are enough for n below 2³²
        raise RuntimeError("the order of the vertices did not fit")
    return data


def decode_order(reader: Reader, n: int) -> Integers:
    """Read a permutation of 0..n-1."""
    order = np.zeros(n, np.int64)
    buffer = readable(reader.rest())
    _code_order(order, np.zeros(n + 1, np.int64), _models(), new_decoder(buffer), buffer)
    return order


def _models() -> Any:
    return np.full((2, 128), 1 << 15, np.int64)


@plain_kernel
def _code_order(order: Any, tree: Any, models: Any, state: Any, buffer: Any) -> None:
    """Code ranks among the vertices that are left; ``tree`` (n + 1,) counts these (Fenwick)."""
    n = order.size
    for i in range(1, n + 1):
        tree[i] += 1
        if i + (i & -i) <= n:
            tree[i + (i & -i)] += tree[i]
    expected = whole(0)
    near = 0
    for i in range(n):
        left = n - i
        rank = _rank(tree, order[i])
        step = rank - expected
        window = min(_NEAR, left >> _SHARE)
        if window:
            last = near
            near = code(1 if -window < step < window else 0, models[1, last], state, buffer)
            adapt(models[1], last, near)
        if window and near:
            step = code_number(2 * step if step >= 0 else -2 * step - 1, models[0], state, buffer)
            rank = expected + (step // 2 if step % 2 == 0 else -(step + 1) // 2)
            rank = min(max(rank, 0), left - 1)
        else:
            rank = code_uniform(rank, left, state, buffer)
        order[i] = _take(tree, rank)
        expected = min(rank, left - 2)


@plain_kernel
def _rank(tree: Any, v: int) -> int:
    """Count the vertices below v that are left."""
    total = whole(0)
    while v > 0:
        total += tree[v]
        v -= v & -v
    return total


@plain_kernel
def _take(tree: Any, rank: int) -> int:
    """Return the vertex of this rank among those that are left, and take it away."""
    n = tree.size - 1
    v, step = whole(0), whole(1)
    while 2 * step <= n:
        step *= 2
    while step:
        if v + step <= n and tree[v + step] <= rank:
            v += step
            rank -= tree[v]
        step //= 2
    i = v + 1
    while i <= n:
        tree[i] -= 1
        i += i & -i
    return v
