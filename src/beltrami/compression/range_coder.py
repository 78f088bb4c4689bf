"""A binary range coder: integers alone, the same code in both directions."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import plain_kernel
from beltrami.compression.tables import Table, whole

# The state of a coder is an array; its entries:
LOW, HIGH, CODE, POSITION, DECODING, SPENT = range(6)

_ALL = 0xFFFFFFFF
_HALF = 1 << 15


def new_encoder() -> Table:
    """Return the state of a coder that writes."""
    return np.array([0, _ALL, 0, 0, 0, 0], np.int64)


def new_decoder(data: NDArray[np.uint8]) -> Table:
    """Return the state of a coder that reads ``data``; behind its end there are zeros."""
    first = bytes(data[:4]).ljust(4, b"\0")
    return np.array([0, _ALL, int.from_bytes(first, "big"), 4, 1, 0], np.int64)


@plain_kernel
def code(bit: int, p: int, state: Any, buffer: Any) -> int:
    """Write a bit that is 1 with probability p / 65536, or read one; return it.

    ``buffer`` is what is written to, or read from. Bytes beyond its end are counted in
    ``state[POSITION]`` and lost when writing, and are zeros when reading.
    """
    low, high = state[LOW], state[HIGH]
    width = high - low
    middle = low + (width >> 16) * p + (((width & 0xFFFF) * p) >> 16)
    if state[DECODING]:
        bit = 1 if state[CODE] <= middle else 0
    if bit:
        high = middle
    else:
        low = middle + 1
    position = state[POSITION]
    while (low ^ high) & 0xFF000000 == 0:
        if state[DECODING]:
            byte = whole(buffer[position]) if position < buffer.size else 0
            state[CODE] = ((state[CODE] << 8) & _ALL) | byte
        elif position < buffer.size:
            buffer[position] = high >> 24
        position += 1
        low = (low << 8) & _ALL
        high = ((high << 8) & _ALL) | 255
    state[LOW], state[HIGH], state[POSITION] = low, high, position
    return bit


@plain_kernel
def code_uniform(value: int, count: int, state: Any, buffer: Any) -> int:
    """Write or read a number of 0..count-1, all equally likely, by halves; return it."""
    low, size = whole(0), whole(count)
    while size > 1:
        half = size // 2
        p = min(max(((size - half) << 16) // size, 1), 65535)
        if code(1 if value >= low + half else 0, p, state, buffer):
            low += half
            size -= half
        else:
            size = half
    return low


@plain_kernel
def code_number(value: int, model: Any, state: Any, buffer: Any) -> int:
    """Write or read a number >= 0 by its length and its bits (Elias gamma, adaptive).

    ``model`` (128,) holds probabilities that a bit is 1: of the length first, then of the
    highest bit after the leading one for each length; they start at 32768.
    """
    value += 1
    length = 0
    while length < 40:
        bit = code(1 if value >> (length + 1) > 0 else 0, model[length], state, buffer)
        adapt(model, length, bit)
        if bit == 0:
            break
        length += 1
    found = 1
    for i in range(length - 1, -1, -1):
        bit = (value >> i) & 1
        if i == length - 1:
            bit = code(bit, model[64 + length], state, buffer)
            adapt(model, 64 + length, bit)
        else:
            bit = code(bit, _HALF, state, buffer)
        found = (found << 1) | bit
    return found - 1


@plain_kernel
def adapt(model: Any, i: int, bit: int) -> None:
    """Move a probability of 16 bits by 1/16 towards what was seen; it stays within 16 bits."""
    if bit:
        model[i] += (65535 - model[i]) >> 4
    else:
        model[i] -= model[i] >> 4
    model[i] = min(max(model[i], 64), 65472)


def new_number_model() -> Table:
    """Make a model for ``code_number`` that has seen nothing."""
    return np.full(128, _HALF, np.int64)


def readable(data: bytes) -> NDArray[np.uint8]:
    """Return bytes as an array that kernels take: one that could be written to."""
    return np.frombuffer(data, np.uint8).copy()


def finished(state: Table, buffer: NDArray[np.uint8]) -> bytes | None:
    """End what was written; None where the buffer was too short for it."""
    position = int(state[POSITION])
    if position >= len(buffer):
        return None
    if state[LOW] > 0:
        buffer[position] = (int(state[LOW]) >> 24) + 1
        position += 1
    return buffer[:position].tobytes()


@plain_kernel
def ran_dry(state: Any, buffer: Any) -> bool:
    """Whether more was read than was ever written: these are not the right bytes."""
    return state[DECODING] == 1 and state[POSITION] > buffer.size + 4
