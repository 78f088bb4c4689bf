"""Corners that are exactly equal, joined into vertices."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel

_MIX = np.uint64(0x9E3779B97F4A7C15)
_HALF = np.uint64(32)


def weld(corners: Floats) -> tuple[Floats, Integers]:
    """Join equal rows of (k, 3) in the order in which they first appear: (vertices, labels).

    Equal is equal bits, but -0.0 and 0.0 are the same and become 0.0. Expected time O(k).

    Examples
    --------
    >>> import numpy as np
    >>> vertices, labels = weld(np.array([[1.0, 0, 0], [2, 0, 0], [1, -0.0, 0]]))
    >>> vertices.tolist(), labels.tolist()
    ([[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]], [0, 1, 0])
    """
    rows = np.ascontiguousarray(corners) + 0.0  # turns -0.0 into 0.0
    slots = 1 << max(2 * len(rows), 1).bit_length()
    labels, first = _labels(rows.view(np.uint64), np.full(slots, -1, np.int64))
    return rows[first], labels


def alike(rows: Floats) -> tuple[Integers, Integers]:
    """Find the equal rows of (k, c): (first row of each kind, the kind of each row).

    Equal as for ``weld``, of which it makes one for every two columns.

    Examples
    --------
    >>> first, kinds = alike(np.array([[1.0, 0, 0, 7], [1, 0, 0, 8], [1, 0, 0, 7]]))
    >>> first.tolist(), kinds.tolist()
    ([0, 1], [0, 1, 0])
    """
    k, columns = rows.shape
    even = np.hstack([rows, np.zeros((k, columns % 2))])
    kinds = np.zeros(k, np.int64)
    for c in range(0, even.shape[1], 2):
        _, kinds = weld(np.column_stack([kinds, even[:, c : c + 2]]))
    return np.unique(kinds, return_index=True)[1], kinds


@kernel
def _labels(bits: Any, table: Any) -> Any:
    """Label equal rows through a hash table with open addressing, at most half full."""
    k = bits.shape[0]
    labels = np.empty(k, np.int64)
    first = np.empty(k, np.int64)
    last_slot = table.size - 1
    n = 0
    for row in range(k):
        code = np.uint64(0)
        for c in range(3):
            code = (code ^ bits[row, c]) * _MIX
            code ^= code >> _HALF
        slot = np.int64(code >> np.uint64(1)) & last_slot
        while True:
            label = table[slot]
            if label < 0:
                table[slot] = n
                first[n] = row
                labels[row] = n
                n += 1
                break
            other = first[label]
            if (
                bits[other, 0] == bits[row, 0]
                and bits[other, 1] == bits[row, 1]
                and bits[other, 2] == bits[row, 2]
            ):
                labels[row] = label
                break
            slot = (slot + 1) & last_slot
    return labels, first[:n].copy()
