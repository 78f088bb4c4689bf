"""Whole numbers near a guess: opinions about their distribution, mixed bit by bit."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import plain_kernel
from beltrami.compression.mixing import Mixer, code_mixed, new_mixer
from beltrami.compression.tables import LN, LN_CELLS, TAIL_REACH, TAILS, WHOLE, whole

OPINIONS = 11
LOGISTIC, LAPLACE = 0, 1
FAR = 1 << 40  # beyond all numbers
_FARTHEST = FAR << 4  # the interval that ends the search: beyond any guess, which may be wild
_NOISE = 1100  # of ``WHOLE``: every distribution leaves that much anywhere
_SURE = 2350  # the largest logit of an opinion
_SPEED = 655
_STEPS = 40
_GRAIN = 20  # bits after the point of a number of scales
_CELL = 14  # of them within a cell of the table of tails
LEAST, MOST = 0, 1  # edges beyond all numbers; three others follow
_EDGES = 5


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
    places, tails : (5, OPINIONS) int64
        Of the edges between numbers that were looked at, so that each is looked up once.
    """

    middle: NDArray[np.float64]
    sharpness: NDArray[np.float64]
    shape: NDArray[np.int64]
    context: NDArray[np.int64]
    mixer: Mixer
    places: NDArray[np.int64]
    tails: NDArray[np.int64]


def new_opinions() -> Opinions:
    """Make opinions that have seen nothing."""
    mixer = new_mixer(OPINIONS, 6, 1 << 14, (_STEPS * 16, _STEPS * 16), trust=(150, 50), limit=124)
    return Opinions(
        np.zeros(OPINIONS),
        np.ones(OPINIONS),
        np.zeros(OPINIONS, np.int64),
        np.zeros(8, np.int64),
        mixer,
        np.zeros((_EDGES, OPINIONS), np.int64),
        np.zeros((_EDGES, OPINIONS), np.int64),
    )


@plain_kernel
def set_edge(slot: int, edge: float, opinions: Any) -> None:
    """Note where an edge lies for each opinion, and the mass beyond it.

    In scales from the middle, with ``_GRAIN`` bits after the point; the mass beyond an edge below
    the middle is that below it. A table, linear in between.
    """
    places, tails = opinions.places[slot], opinions.tails[slot]
    for e in range(OPINIONS):
        z = (edge - opinions.middle[e]) * opinions.sharpness[e]
        z = min(max(z, -float(TAIL_REACH)), float(TAIL_REACH))
        place = whole(z * (1 << _GRAIN))
        places[e] = place
        away = abs(place)
        i, rest = away >> _CELL, away & ((1 << _CELL) - 1)
        above = TAILS[opinions.shape[e], i]
        tails[e] = above - (((above - TAILS[opinions.shape[e], i + 1]) * rest) >> _CELL)


@plain_kernel
def between(low: int, high: int, e: int, opinions: Any) -> int:
    """Return the mass between the edges of two slots, out of ``WHOLE``."""
    below, above = opinions.tails[low, e], opinions.tails[high, e]
    if opinions.places[low, e] >= 0:
        return below - above
    if opinions.places[high, e] <= 0:
        return above - below
    return WHOLE - above - below


@plain_kernel
def ln(x: int) -> int:
    """Return ln(x) for an integer x >= 1, in 16 bits after the point."""
    k = 0
    for s in (32, 16, 8, 4, 2, 1):
        if x >> (k + s) > 0:
            k += s
    mantissa = (x << 10) >> k if k < 50 else x >> (k - 10)
    return k * LN[LN_CELLS] + LN[mantissa & (LN_CELLS - 1)]


@plain_kernel
def _ask(a: int, b: int, c: int, d: int, opinions: Any) -> None:
    """Write the logit of each opinion that the number is between the edges a and b, not c and d.

    With c = d the alternative is all that is not between a and b.
    """
    logits = opinions.mixer.logits
    for e in range(OPINIONS):
        first = between(a, b, e, opinions)
        second = WHOLE - first if c == d else between(c, d, e, opinions)
        logit = (ln(first + _NOISE) - ln(second + _NOISE)) >> 8
        logits[e] = min(max(logit, -_SURE), _SURE)


@plain_kernel
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


@plain_kernel
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
    set_edge(2, nearest - 0.5, opinions)
    if spread == 0:
        set_edge(3, nearest + 0.5, opinions)
        _ask(2, 3, 0, 0, opinions)
        if _decide(1 if value == nearest else 0, 0, part, 0, opinions, state, buffer):
            return nearest
    set_edge(LEAST, -FAR - 0.5, opinions)
    set_edge(MOST, FAR + 0.5, opinions)
    if spread == 0:
        _ask(3, MOST, LEAST, 2, opinions)
        up = _decide(1 if value > nearest else 0, 1, part, 0, opinions, state, buffer)
        base, size, step, inner = nearest + (1 if up else -1), whole(1), 2, 3 if up else 2
    else:
        _ask(2, MOST, LEAST, 2, opinions)
        up = _decide(1 if value >= nearest else 0, 4, part, 0, opinions, state, buffer)
        base, size, step, inner = nearest - (0 if up else 1), whole(1) << (spread - 1), 1, 2
    sign, shift = 1 if up else -1, 0 if spread == 0 else 4
    return _code_away(value, base, size, step, shift, sign, inner, opinions, state, buffer)


@plain_kernel
def _code_away(
    value: int, base: int, size: int, step: int, shift: int, sign: int, inner: int,
    opinions: Any, state: Any, buffer: Any,
) -> int:  # fmt: skip
    """Write or read a number from ``base`` on in the direction ``sign``; its edge is ``inner``."""
    outer = 5 - inner
    while True:
        end = base + sign * (size - 1)
        set_edge(outer, end + 0.5 * sign, opinions)
        if sign > 0:
            _ask(inner, outer, outer, MOST, opinions)
        else:
            _ask(outer, inner, LEAST, outer, opinions)
        low, high = min(base, end), max(base, end)
        bit = 1 if low <= value <= high else 0
        number = min(step, 11) + shift
        if _decide(bit, number, 0, sign, opinions, state, buffer) or size > _FARTHEST:
            break
        base = end + sign
        if step > 2:
            size *= 2
        step += 1
        inner, outer = outer, inner
    below, above = (inner, outer) if sign > 0 else (outer, inner)
    return _halve(value, low, high, below, above, sign, opinions, state, buffer)


@plain_kernel
def _halve(
    value: int, low: int, high: int, below: int, above: int, sign: int,
    opinions: Any, state: Any, buffer: Any,
) -> int:  # fmt: skip
    """Write or read a number of low..high, between the edges ``below`` and ``above``."""
    step, between = 0, 4
    while low < high:
        middle = (low + high) >> 1
        set_edge(between, middle + 0.5, opinions)
        _ask(below, between, between, above, opinions)
        bit = 1 if value <= middle else 0
        number = 16 + min(2 * min(step, 11), 23)
        if _decide(bit, number, 0, sign, opinions, state, buffer):
            high, above, between = middle, between, above
        else:
            low, below, between = middle + 1, between, below
        step += 1
    return low
