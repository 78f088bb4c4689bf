"""Whole numbers near a guess: opinions about their distribution, mixed bit by bit."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import kernel
from beltrami.compression.mixing import Mixer, code_mixed, new_mixer
from beltrami.compression.tables import CELLS, LN, LN_CELLS, TAIL_REACH, TAILS, WHOLE, whole

OPINIONS = 11
LOGISTIC, LAPLACE = 0, 1
FAR = 1 << 40  # beyond all numbers
_NOISE = 1100  # of ``WHOLE``: every distribution leaves that much anywhere
_SURE = 2350  # the largest logit of an opinion
_SPEED = 655
_STEPS = 40
_GRAIN = 20  # bits after the point of a number of scales


class Opinions(NamedTuple):
    """Distributions about the next number, and the contexts of the decisions about it.

    Attributes
    ----------
    middle, sharpness : (OPINIONS,) float64
        The middles, and the inverses of the scales.
    shape : (OPINIONS,) int64
        ``LOGISTIC`` or ``LAPLACE``.
    context : (8,) int64
        [0] scale of the number, 0..15; [1] coordinate, 0..2; [2] class of the vertex, 0..3;
        [3], [4] errors of the coordinates before, 0..7; [5] to [7] what other predictions say,
        0..127, 0..127 and 0..127.
    mixer
        Of the decisions.
    """

    middle: NDArray[np.float64]
    sharpness: NDArray[np.float64]
    shape: NDArray[np.int64]
    context: NDArray[np.int64]
    mixer: Mixer


def new_opinions() -> Opinions:
    """Make opinions that have seen nothing."""
    mixer = new_mixer(OPINIONS, 6, 1 << 14, (_STEPS * 16, _STEPS * 16), trust=(150, 50), limit=124)
    return Opinions(
        np.zeros(OPINIONS),
        np.ones(OPINIONS),
        np.zeros(OPINIONS, np.int64),
        np.zeros(8, np.int64),
        mixer,
    )


@kernel
def _scales(edge: float, opinions: Any, e: int) -> int:
    """Return how many scales an edge is above the middle, with ``_GRAIN`` bits after the point."""
    z = (edge - opinions.middle[e]) * opinions.sharpness[e]
    z = min(max(z, -float(TAIL_REACH)), float(TAIL_REACH))
    return whole(z * (1 << _GRAIN))


@kernel
def _tail(shape: int, z: int) -> int:
    """Return the mass beyond z >= 0: a table, linear in between."""
    step = (1 << _GRAIN) // CELLS
    i, rest = z // step, z % step
    above = TAILS[shape, i]
    return above - ((above - TAILS[shape, i + 1]) * rest) // step


@kernel
def mass(shape: int, low: int, high: int) -> int:
    """Return the mass between two edges, out of ``WHOLE``."""
    if low >= 0:
        return _tail(shape, low) - _tail(shape, high)
    if high <= 0:
        return _tail(shape, -high) - _tail(shape, -low)
    return WHOLE - _tail(shape, high) - _tail(shape, -low)


@kernel
def ln(x: int) -> int:
    """Return ln(x) for an integer x >= 1, in 16 bits after the point."""
    k = 0
    for s in (32, 16, 8, 4, 2, 1):
        if x >> (k + s) > 0:
            k += s
    mantissa = (x << 10) >> k if k < 50 else x >> (k - 10)
    return k * LN[LN_CELLS] + LN[mantissa & (LN_CELLS - 1)]


@kernel
def _ask(a: int, b: int, c: int, d: int, inside: bool, opinions: Any) -> None:
    """Write the logit of each opinion that the number is in a..b, not in c..d.

    With ``inside``, the alternative is all that is not in a..b.
    """
    logits = opinions.mixer.logits
    for e in range(OPINIONS):
        shape = opinions.shape[e]
        first = mass(shape, _scales(a - 0.5, opinions, e), _scales(b + 0.5, opinions, e))
        if inside:
            second = WHOLE - first
        else:
            second = mass(shape, _scales(c - 0.5, opinions, e), _scales(d + 0.5, opinions, e))
        logit = (ln(first + _NOISE) - ln(second + _NOISE)) >> 8
        logits[e] = min(max(logit, -_SURE), _SURE)


@kernel
def _decide(
    bit: int, step: int, part: int, sign: int, opinions: Any, state: Any, buffer: Any
) -> int:
    """Write or read a decision, after ``_ask``; ``part`` is where the middle lies in its cell."""
    k, x = opinions.context, opinions.mixer.contexts
    x[0] = step * 16 + k[0]
    x[1] = step * 64 + part * 8 + k[1] * 2 + (1 if sign > 0 else 0)
    x[2] = step * 128 + k[3] * 16 + min(k[4], 3) * 4 + k[2]
    x[3] = step * 128 + k[5] // 8 * 8 + part
    x[4] = step * 128 + k[6]
    x[5] = step * 128 + k[7]
    return code_mixed(
        bit, step * 16 + k[2] * 4 + k[1], step * 16 + k[0], _SPEED, opinions.mixer, state, buffer
    )


@kernel
def code_near(
    value: int, middle: float, scale: float, opinions: Any, state: Any, buffer: Any
) -> int:  # fmt: skip
    """Write or read a whole number about ``middle``, give or take ``scale``; return it.

    Is it the nearest one, or on which side, then in which of growing intervals, then in which
    half of it, and so on.
    """
    nearest = whole(np.floor(middle + 0.5))
    spread = 0
    while spread < 30 and (2 << spread) < scale:
        spread += 1
    part = whole((middle - np.floor(middle)) * 8) if spread <= 1 else 0
    part = min(max(part, 0), 7)
    if spread == 0:
        _ask(nearest, nearest, 0, 0, True, opinions)
        if _decide(1 if value == nearest else 0, 0, part, 0, opinions, state, buffer):
            return nearest
        _ask(nearest + 1, FAR, -FAR, nearest - 1, False, opinions)
        up = _decide(1 if value > nearest else 0, 1, part, 0, opinions, state, buffer)
        base, size, step = nearest + (1 if up else -1), whole(1), 2
    else:
        _ask(nearest, FAR, -FAR, nearest - 1, False, opinions)
        up = _decide(1 if value >= nearest else 0, 4, part, 0, opinions, state, buffer)
        base, size, step = nearest - (0 if up else 1), whole(1) << (spread - 1), 1
    return _code_away(value, base, size, step, spread, 1 if up else -1, opinions, state, buffer)


@kernel
def _code_away(
    value: int, base: int, size: int, step: int, spread: int, sign: int,
    opinions: Any, state: Any, buffer: Any,
) -> int:  # fmt: skip
    """Write or read a number from ``base`` on in the direction ``sign``."""
    shift = 0 if spread == 0 else 4
    while True:
        end = base + sign * (size - 1)
        low, high = min(base, end), max(base, end)
        if sign > 0:
            _ask(low, high, high + 1, FAR, False, opinions)
        else:
            _ask(low, high, -FAR, low - 1, False, opinions)
        bit = 1 if low <= value <= high else 0
        number = min(step, 11) + shift
        if _decide(bit, number, 0, sign, opinions, state, buffer) or size > FAR >> 4:
            break
        base = end + sign
        if step > 2:
            size *= 2
        step += 1
    step = 0
    while low < high:
        middle = (low + high) >> 1
        _ask(low, middle, middle + 1, high, False, opinions)
        bit = 1 if value <= middle else 0
        number = 16 + min(2 * min(step, 11), 23)
        if _decide(bit, number, 0, sign, opinions, state, buffer):
            high = middle
        else:
            low = middle + 1
        step += 1
    return low
