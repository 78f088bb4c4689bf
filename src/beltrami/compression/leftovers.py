"""What the conquest leaves out: boundaries, merged vertices, turned faces, improper faces."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import plain_kernel
from beltrami.compression.range_coder import adapt, code, code_number, code_uniform, ran_dry
from beltrami.compression.tables import whole


class Leftovers(NamedTuple):
    """Rare things, coded after the conquest, in this order.

    Attributes
    ----------
    middles : (b,) int64
        The numbers of the vertices in the middle of closed boundaries, as gaps: each less the
        one before it, less one; the first as it is.
    merged : (q,) int64
        Among the other vertices, those that are the same vertex as an earlier one, as gaps.
    target : (q,) int64
        Which one: its final number.
    turned : (k,) uint8
        Whether each face was turned over; empty if none was.
    improper : (i, 3) int64
        Faces that name a vertex twice, in final numbers.
    """

    middles: NDArray[np.int64]
    merged: NDArray[np.int64]
    target: NDArray[np.int64]
    turned: NDArray[np.uint8]
    improper: NDArray[np.int64]


def leftovers_to_fill(middles: int, merged: int, turned: int, improper: int) -> Leftovers:
    """Make what the decoder fills."""
    return Leftovers(
        np.zeros(middles, np.int64),
        np.zeros(merged, np.int64),
        np.zeros(merged, np.int64),
        np.zeros(turned, np.uint8),
        np.zeros((improper, 3), np.int64),
    )


def as_gaps(numbers: NDArray[np.int64]) -> NDArray[np.int64]:
    """Turn ascending numbers into gaps.

    Examples
    --------
    >>> as_gaps(np.array([2, 3, 7])).tolist(), from_gaps(np.array([2, 0, 3])).tolist()
    ([2, 0, 3], [2, 3, 7])
    """
    return np.diff(numbers, prepend=-1) - 1


def from_gaps(gaps: NDArray[np.int64]) -> NDArray[np.int64]:
    """Turn gaps into ascending numbers."""
    return np.cumsum(gaps + 1) - 1


@plain_kernel
def code_leftovers(left: Any, n: int, models: Any, state: Any, buffer: Any) -> None:
    """Write them or read them, as far as there are bytes; n is the number of final vertices.

    ``models`` (3, 128): for the two kinds of gaps, and for turned faces after turned ones or not.
    """
    for i in range(left.middles.size):
        left.middles[i] = code_number(left.middles[i], models[0], state, buffer)
        if ran_dry(state, buffer):
            return
    place = whole(-1)
    for i in range(left.merged.size):
        left.merged[i] = code_number(left.merged[i], models[1], state, buffer)
        place = min(place + left.merged[i] + 1, whole(1) << 40)
        left.target[i] = code_uniform(left.target[i], max(place - i, 1), state, buffer)
        if ran_dry(state, buffer):
            return
    last = 0
    for i in range(left.turned.size):
        last = code(whole(left.turned[i]), models[2, last], state, buffer)
        adapt(models[2], 0 if i == 0 else whole(left.turned[i - 1]), last)
        left.turned[i] = last
        if ran_dry(state, buffer):
            return
    for i in range(left.improper.shape[0]):
        for c in range(3):
            left.improper[i, c] = code_uniform(left.improper[i, c], n, state, buffer)
        if ran_dry(state, buffer):
            return
