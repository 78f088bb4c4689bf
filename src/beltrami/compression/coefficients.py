"""Coefficients of blocks, coded frequency after frequency: any beginning is a coarser shape."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import plain_kernel
from beltrami.compression.positions import level
from beltrami.compression.range_coder import DECODING, POSITION, adapt, code
from beltrami.compression.residuals import LAPLACE, LOGISTIC, Opinions, code_near, new_opinions
from beltrami.compression.tables import whole

END_EVERY = 8  # frequencies between two questions whether a block goes on
_MEMORIES = 3
_FIRST = 65536.0  # the spread of the first mean of all


class Memory(NamedTuple):
    """What the coding of coefficients knows and learns.

    Attributes
    ----------
    size : (k, d, 3) float64
        Of each block: the mean size of the last coefficients, over a short to a long time.
    before : (k, d) int64
        The size of the last ones.
    across : (2, d) float64
        The mean size at this frequency in the blocks just coded; and at the one before in all.
    going : (k,) bool
        Which blocks go on.
    ends : (64, 4) int64
        The chances that they do, by the frequency and by what was last.
    """

    size: NDArray[np.float64]
    before: NDArray[np.int64]
    across: NDArray[np.float64]
    going: NDArray[np.bool_]
    ends: NDArray[np.int64]
    opinions: Opinions


def new_memory(blocks: int, d: int) -> Memory:
    """Know nothing of so many blocks."""
    return Memory(
        np.zeros((blocks, d, _MEMORIES)),
        np.zeros((blocks, d), np.int64),
        np.full((2, d), _FIRST),
        np.ones(blocks, np.bool_),
        np.full((64, 4), 1 << 15, np.int64),
        new_opinions(),
    )


@plain_kernel
def code_coefficients(
    numbers: Any, starts: Any, lengths: Any, terms: int, slack: int, memory: Any,
    state: Any, buffer: Any, known: Any,
) -> bool:  # fmt: skip
    """Write or read ``numbers`` (n, d) at the first ``terms`` frequencies of all blocks.

    Coefficient i of block b is ``numbers[starts[b] + i]``. ``lengths`` (k,) are how many of each
    block to write; ``known`` (k,) becomes how many of each are known. False as soon as more is
    read than ``slack`` bytes beyond the end.
    """
    for i in range(terms):
        for b in range(starts.size - 1):
            if i >= starts[b + 1] - starts[b] or not memory.going[b]:
                continue
            if i and i % END_EVERY == 0:
                _ask_end(i, b, lengths[b], memory, state, buffer)
            if memory.going[b]:
                _code_row(i, b, numbers, starts, memory, state, buffer)
            if state[DECODING] and state[POSITION] > buffer.size + slack:
                return False
            known[b] = i + 1
        for c in range(numbers.shape[1]):
            memory.across[1, c] = memory.across[0, c]
    return True


@plain_kernel
def _ask_end(i: int, b: int, length: int, memory: Any, state: Any, buffer: Any) -> None:
    """Write or read whether block b has coefficients from i on."""
    some = whole(0)
    for c in range(memory.before.shape[1]):
        some += 1 if memory.size[b, c, 1] > 0.1 else 0
    context = min(i // END_EVERY, 63)
    model = memory.ends[context]
    goes = code(1 if i < length else 0, model[min(some, 3)], state, buffer)
    adapt(model, min(some, 3), goes)
    memory.going[b] = goes == 1


@plain_kernel
def _code_row(
    i: int, b: int, numbers: Any, starts: Any, memory: Any, state: Any, buffer: Any
) -> None:
    """Write or read the coefficients of one frequency of a block."""
    row = numbers[starts[b] + i]
    k = memory.opinions.context
    k[2] = 0 if i < 8 else 1 if i < 32 else 2 if i < 128 else 3
    k[3], k[4] = 0, 0
    done = 0.0
    for c in range(row.size):
        if i == 0:
            value = _code_mean(b, c, numbers, starts, memory, state, buffer)
        else:
            if i == 1:
                memory.size[b, c] = memory.across[0, c]
            scale = _form_opinions(b, c, done, memory)
            value = code_near(row[c], 0.0, 1.5 * scale, memory.opinions, state, buffer)
        row[c] = value
        if i:
            done = (done * c + abs(value)) / (c + 1)
            k[4] = k[3]
            k[3] = min(7, abs(value))
            _note(i, b, c, abs(value), memory)


@plain_kernel
def _code_mean(
    b: int, c: int, numbers: Any, starts: Any, memory: Any, state: Any, buffer: Any
) -> int:
    """Write or read the first coefficient: near what the block before has, in a mean."""
    middle = 0.0
    if b:
        ratio = (starts[b + 1] - starts[b]) / (starts[b] - starts[b - 1])
        middle = numbers[starts[b - 1], c] * np.sqrt(ratio)
    k, scale = memory.opinions.context, memory.across[0, c]
    for e in range(memory.opinions.middle.size):
        _write(e, middle, 0.25 + scale * (1 + e % 3), LAPLACE, memory.opinions)
    k[0], k[1], k[5], k[6], k[7] = level(scale), min(c, 2), 0, 0, 0
    value = code_near(numbers[starts[b], c], middle, scale, memory.opinions, state, buffer)
    memory.across[0, c] += (abs(value - middle) - scale) * 0.3
    return value


@plain_kernel
def _form_opinions(b: int, c: int, done: float, memory: Any) -> float:
    """Write distributions about 0 of the next coefficient; return the scale to begin with."""
    opinions = memory.opinions
    size, across = memory.size[b, c], memory.across[0, c]
    alike = 0.0
    for q in range(memory.size.shape[1]):
        alike += memory.size[b, q, 1]
    alike = alike / memory.size.shape[1]
    done = done if c else size[0]
    both = np.sqrt((0.5 * (size[1] + alike) + 0.01) * (across + 0.01))
    for e in range(3):
        _write(e, 0.0, 0.06 + size[e], LAPLACE, opinions)
    _write(3, 0.0, 0.06 + alike, LAPLACE, opinions)
    _write(4, 0.0, 0.06 + across, LAPLACE, opinions)
    _write(5, 0.0, 0.06 + both, LAPLACE, opinions)
    _write(6, 0.0, 0.06 + done, LAPLACE, opinions)
    _write(7, 0.0, 0.06 + memory.across[1, c], LAPLACE, opinions)
    _write(8, 0.0, 0.05 + 0.5 * size[1], LOGISTIC, opinions)
    _write(9, 0.0, 0.05 + 0.5 * both, LOGISTIC, opinions)
    _write(10, 0.0, 0.06 + 0.5 * (size[0] + across), LAPLACE, opinions)
    k = opinions.context
    k[0], k[1] = level(6.0 * both), min(c, 2)
    k[5] = level(8.0 * size[1]) * 8
    k[6] = level(8.0 * size[2]) * 8 + min(memory.before[b, c], 7)
    k[7] = level(16.0 * across) * 8 + level(8.0 * size[0]) // 2
    return both


@plain_kernel
def _write(e: int, middle: float, scale: float, shape: int, opinions: Any) -> None:
    opinions.middle[e], opinions.sharpness[e], opinions.shape[e] = middle, 1.0 / scale, shape


@plain_kernel
def _note(i: int, b: int, c: int, size: int, memory: Any) -> None:
    """Learn from the size of a coefficient."""
    memory.before[b, c] = size
    for e in range(3):
        rate = 0.3 if e == 0 else 0.1 if e == 1 else 0.03
        memory.size[b, c, e] += (size - memory.size[b, c, e]) * max(rate, 1.0 / i)
    rate = max(0.05, 1.0 / (b + 1.0)) if i == 1 else 0.05
    memory.across[0, c] += (size - memory.across[0, c]) * rate
