"""Corrections: the few vertices that a coarse shape leaves farther off than the bound."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._jit import plain_kernel
from beltrami.compression.range_coder import (
    POSITION,
    code_number,
    finished,
    new_decoder,
    new_encoder,
    new_number_model,
    ran_dry,
    readable,
)
from beltrami.compression.tables import whole
from beltrami.compression.varint import Reader


def corrections_for(x: Floats, near: Floats, bound: float) -> tuple[Integers, Integers, float]:
    """Return (vertices, numbers (k, d), step): x is near + step * numbers, within the bound."""
    d = x.shape[1]
    step = 2 * bound / float(np.sqrt(d)) * (1 - 2.0**-20)
    far = np.flatnonzero(((near - x) ** 2).sum(axis=1) > (bound * (1 - 2.0**-30)) ** 2)
    numbers = np.floor((x[far] - near[far]) / step + 0.5)
    return far, numbers.astype(np.int64), step


def encode_corrections(vertices: Integers, numbers: Integers) -> bytes:
    """Write ascending vertices, and what is added to each.

    Examples
    --------
    >>> data = encode_corrections(np.array([2, 9]), np.array([[1, 0, 0], [0, -1, 2]]))
    >>> vertices, numbers = decode_corrections(Reader(data, "a.btm"), 2, 10, 3)
    >>> vertices.tolist(), numbers.tolist()
    ([2, 9], [[1, 0, 0], [0, -1, 2]])
    """
    gaps = np.diff(vertices, prepend=-1) - 1
    size = 8 * numbers.size + 8 * len(gaps) + 1024
    while True:
        state, buffer = new_encoder(), np.zeros(size, np.uint8)
        _code(gaps, numbers.copy(), _models(numbers.shape[1]), state, buffer)
        data = finished(state, buffer)
        if data is not None:
            return data
        size = int(state[POSITION]) + 1024


def decode_corrections(reader: Reader, count: int, n: int, d: int) -> tuple[Integers, Integers]:
    """Read as many vertices of n, and (count, d) numbers."""
    buffer = readable(reader.rest())
    state = new_decoder(buffer)
    gaps, numbers = np.zeros(count, np.int64), np.zeros((count, d), np.int64)
    _code(gaps, numbers, _models(d), state, buffer)
    vertices = np.cumsum(np.minimum(gaps, n) + 1) - 1
    if ran_dry(state, buffer) or (count and vertices[-1] >= n):
        raise reader.fault("corrections of vertices that are not there")
    return vertices, numbers


def _models(d: int) -> Any:
    return np.stack([new_number_model() for _ in range(d + 1)])


@plain_kernel
def _code(gaps: Any, numbers: Any, models: Any, state: Any, buffer: Any) -> None:
    """Write or read the gaps between vertices, and the numbers: 2 z, or -2 z - 1 for z < 0."""
    for i in range(gaps.size):
        gaps[i] = code_number(gaps[i], models[0], state, buffer)
        for q in range(numbers.shape[1]):
            z = whole(numbers[i, q])
            z = code_number(2 * z if z >= 0 else -2 * z - 1, models[q + 1], state, buffer)
            numbers[i, q] = z // 2 if z % 2 == 0 else -(z + 1) // 2
        if ran_dry(state, buffer):
            break
