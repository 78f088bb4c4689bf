"""Context mixing: many opinions about the next bit become one, by integers alone.

Each context keeps the probability of a 1 after it. Their logits, and those of other opinions, are
added with weights that go down the gradient of the code length (Mahoney's logistic mixing).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import plain_kernel
from beltrami.compression.range_coder import code
from beltrami.compression.tables import REACH, SQUASH, STRETCH, Table, whole

_ROUND = 1 << 19
_BIAS = 80
_LIMITS = 1024


class Mixer(NamedTuple):
    """What a mixer learns; all arrays change while it codes.

    Attributes
    ----------
    logits : (k,) int64
        The opinions: first those that the caller writes, then the contexts', last a constant.
    contexts : (c,) int64
        The context that each counter is asked in; the caller writes it.
    chance, seen : (c, size)
        The probability of a 1, in 22 bits, and how often each context was seen.
    first, second : (rows, k) int64
        Two sets of weights, in 20 bits after the point; their logits are averaged.
    rates : (1024,) int64
        How far to go towards what was seen, in 16 bits, by the number of times.
    """

    logits: Table
    contexts: Table
    chance: NDArray[np.int32]
    seen: NDArray[np.int16]
    first: Table
    second: Table
    rates: Table


def new_mixer(
    opinions: int, counters: int, size: int, rows: tuple[int, int], *,
    trust: tuple[int, int], limit: int,
) -> Mixer:  # fmt: skip
    """Make a mixer; ``trust`` (opinions, counters) are the first weights, in 1/1000.

    ``limit`` is how often a context is seen before the rate of its counter stays.
    """
    k = opinions + counters + 1
    weights = np.zeros(k, np.int64)
    weights[:opinions] = trust[0] * 2**20 // 1000
    weights[opinions:-1] = trust[1] * 2**20 // 1000
    times = np.minimum(np.arange(_LIMITS), limit)
    return Mixer(
        np.zeros(k, np.int64),
        np.zeros(counters, np.int64),
        np.full((counters, size), 1 << 21, np.int32),
        np.zeros((counters, size), np.int16),
        np.tile(weights, (rows[0], 1)),
        np.tile(weights, (rows[1], 1)),
        65536 * 5 // (5 * times + 8),
    )


@plain_kernel
def squash(logit: int) -> int:
    """65536 / (1 + e^(-logit / 256)), within 1..65535."""
    return SQUASH[min(max(logit, -REACH), REACH) + REACH]


@plain_kernel
def code_mixed(
    bit: int, row: int, other: int, speed: int, mixer: Any, state: Any, buffer: Any
) -> int:
    """Write or read a bit with the mixed opinions, and learn from it; return it.

    ``row`` and ``other`` choose the weights; ``speed`` is the rate of learning, in 16 bits.
    """
    x, contexts, chance = mixer.logits, mixer.contexts, mixer.chance
    k, c = x.size, contexts.size
    for e in range(c):
        x[k - 1 - c + e] = STRETCH[chance[e, contexts[e]] >> 10]
    x[k - 1] = _BIAS
    a = b = whole(0)
    for e in range(k):
        a += mixer.first[row, e] * x[e]
        b += mixer.second[other, e] * x[e]
    p = squash((a + b + 2 * _ROUND) >> 21)
    bit = code(bit, p, state, buffer)
    target = 65536 * bit
    learn(mixer.first, row, x, (target - squash((a + _ROUND) >> 20)) * speed)
    learn(mixer.second, other, x, (target - squash((b + _ROUND) >> 20)) * speed)
    for e in range(c):
        count(bit, chance, mixer.seen, mixer.rates, e, contexts[e])
    return bit


@plain_kernel
def learn(weights: Any, row: int, x: Any, step: int) -> None:
    """Move the weights along the gradient, and keep them within 2^26."""
    for e in range(x.size):
        w = weights[row, e] + ((x[e] * step + _ROUND) >> 20)
        weights[row, e] = min(max(w, -(1 << 26)), 1 << 26)


@plain_kernel
def count(bit: int, chance: Any, seen: Any, rates: Any, e: int, context: int) -> None:
    """Move the probability of a context towards the bit."""
    times = seen[e, context]
    goal = ((1 << 22) - 1) * bit
    chance[e, context] += ((goal - chance[e, context]) * rates[times]) >> 16
    if times < rates.size - 1:
        seen[e, context] = times + 1
