"""Floating-point numbers, bit by bit: a whole number of steps, and how many floats beside that."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Integers
from beltrami._jit import plain_kernel
from beltrami.compression.range_coder import (
    POSITION,
    adapt,
    code,
    finished,
    new_decoder,
    new_encoder,
    ran_dry,
    readable,
)
from beltrami.compression.tables import whole
from beltrami.compression.varint import Reader

# Of each type: the bits of a whole number of steps, which the type must hold exactly.
BITS = {"<f2": 10, "<f4": 22, "<f8": 26}
LOWEST = -1074  # the exponent of the smallest double
_MOST = 30
_ROWS, _WIDE = 32, 256


def exponent_for(values: NDArray[Any]) -> int:
    """Return e of the step 2^e: all values are multiples of it, or if not, it is fine enough.

    Examples
    --------
    >>> exponent_for(np.array([0.75, 3.0])), exponent_for(np.array([0.1, 1.0]))
    (-2, -25)
    """
    x = values.astype(np.float64).ravel()
    x = x[x != 0]
    if not len(x):
        return 0
    mantissa, exponent = np.frexp(np.abs(x))
    low = (mantissa * 2.0**53).astype(np.int64)
    lowest = exponent - 53 + np.log2((low & -low).astype(np.float64)).astype(np.int64)
    top, finest = int(exponent.max()), int(lowest.min())
    bits = BITS[values.dtype.newbyteorder("<").str]
    if top - finest <= min(_MOST, bits + 4 if bits > BITS["<f2"] else bits):
        return finest
    return max(top - bits, LOWEST)


def steps_of(values: NDArray[Any], exponent: int) -> Integers:
    """Return the nearest whole numbers of steps 2^exponent."""
    return np.floor(np.ldexp(values.astype(np.float64), -exponent) + 0.5).astype(np.int64)


def places_of(values: NDArray[Any]) -> Integers:
    """Return the place of each float among all of its type, ascending; +0 is 0, -0 is -1.

    Examples
    --------
    >>> places_of(np.array([-0.0, 0.0, 5e-324])).tolist()
    [-1, 0, 1]
    """
    size = values.dtype.itemsize
    bits = values.view(f"i{size}").astype(np.int64)
    return np.where(bits < 0, bits ^ (2 ** (8 * size - 1) - 1), bits)


def floats_at(places: Integers, kind: str) -> NDArray[Any]:
    """Return the floats of these numbers; ``places_of`` inverted."""
    size = np.dtype(kind).itemsize
    bits = np.where(places < 0, places ^ (2 ** (8 * size - 1) - 1), places)
    return bits.astype(f"<i{size}").view(kind)


def moved(places: Integers, beside: Integers, kind: str) -> Integers | None:
    """Return places + beside; None where one of them is no finite float."""
    most = int(places_of(np.array([np.finfo(kind).max], kind))[0])
    total = places + beside
    wrapped = ((places ^ total) & (beside ^ total)) < 0
    return None if (wrapped | (total > most) | (total < -1 - most)).any() else total


def encode_beside(beside: Integers, steps: Integers) -> bytes:
    """Write how many floats each value is beside its step, (n, d)."""
    size = 9 * beside.size + 1024
    while True:
        state, buffer = new_encoder(), np.zeros(size, np.uint8)
        _code_all(beside.ravel().copy(), steps.ravel(), _models(), state, buffer)
        data = finished(state, buffer)
        if data is not None:
            return data
        size = int(state[POSITION]) + 1024


def decode_beside(reader: Reader, steps: Integers) -> Integers:
    """Read how many floats each value is beside its step."""
    buffer = readable(reader.rest())
    state, beside = new_decoder(buffer), np.zeros(steps.size, np.int64)
    _code_all(beside, steps.ravel(), _models(), state, buffer)
    if ran_dry(state, buffer):
        raise reader.fault("fewer values than vertices")
    return beside.reshape(steps.shape)


def _models() -> Any:
    return np.full((_ROWS, _WIDE), 1 << 15, np.int64)


@plain_kernel
def _code_all(beside: Any, steps: Any, models: Any, state: Any, buffer: Any) -> None:
    """Code each number with the chances for the size of its step."""
    for i in range(beside.size):
        row, k = 0, abs(steps[i])
        while k > 0 and row < 31:
            k >>= 1
            row += 1
        beside[i] = _code_signed(beside[i], models[row], state, buffer)
        if ran_dry(state, buffer):
            break


@plain_kernel
def _code_signed(value: int, model: Any, state: Any, buffer: Any) -> int:
    """Write or read a number: is it 0, its sign, its length, its bits after the leading one."""
    some = code(1 if value != 0 else 0, model[0], state, buffer)
    adapt(model, 0, some)
    if some == 0:
        return whole(0)
    negative = code(1 if value < 0 else 0, model[1], state, buffer)
    adapt(model, 1, negative)
    size = -(value + 1) if value < 0 else value - 1  # from 0 on, so that nothing overflows
    length = whole(0)  # of size + 1, after its leading one
    while length < 62:
        more = code(1 if ((size + 1) >> (length + 1)) > 0 else 0, model[2 + length], state, buffer)
        adapt(model, 2 + length, more)
        if more == 0:
            break
        length += 1
    found = whole(1)
    for i in range(length - 1, -1, -1):
        bit = ((size + 1) >> i) & 1
        if i == length - 1:
            place = 128 + length
            bit = code(bit, model[place], state, buffer)
            adapt(model, place, bit)
        else:
            bit = code(bit, 32768, state, buffer)
        found = (found << 1) | bit
    return -found if negative else found
