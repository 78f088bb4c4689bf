"""Tables of exp and log made of integers alone: the same on every machine.

A probability p is kept as an integer of 16 bits, its logit ln(p / (1 - p)) in units of 1/256.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Table: TypeAlias = NDArray[np.int64]
whole: Any = np.int64  # what kernels count with; Any, because it is an int and an index to them

UNIT = 256  # steps of a logit per unit
REACH = 12 * UNIT  # logits run from -REACH to REACH
CELLS = 64  # steps of the tails per scale
TAIL_REACH = 24  # scales, beyond which nothing is left
WHOLE = 1 << 40  # the mass of a distribution
LN_CELLS = 1024  # steps of the logarithm per octave

_ONE = 1 << 96  # of the numbers that the tables are computed with


def _exp_of(p: int, q: int) -> int:
    """e^(p/q) times ``_ONE`` for 0 <= p/q <= 1, by its series."""
    term = total = _ONE
    k = 1
    while term:
        term = term * p // (q * k)
        total += term
        k += 1
    return total


def _ln_of(p: int, q: int) -> int:
    """ln(p/q) times ``_ONE`` for 1 <= p/q <= 2: 2 artanh((p - q) / (p + q)), by its series."""
    x = _ONE * (p - q) // (p + q)
    square = x * x // _ONE
    term, total, k = x, 0, 1
    while term:
        total += term // k
        term = term * square // _ONE
        k += 2
    return 2 * total


def _powers(step: int, count: int) -> list[int]:
    """1, e, e², ... times ``_ONE`` where ``step`` is e times ``_ONE``."""
    powers = [_ONE]
    for _ in range(count):
        powers.append(powers[-1] * step // _ONE)
    return powers


def _squash_table() -> Table:
    """Round 65536 / (1 + e^(-i/256)), kept within 1..65535, for i = -REACH..REACH."""
    rising = [65536 * e // (_ONE + e) for e in _powers(_exp_of(1, UNIT), REACH)]
    half = [65536 - p for p in reversed(rising[1:])]
    return np.clip(np.array(half + rising, np.int64), 1, 65535)


def _stretch_table(squash: Table) -> Table:
    """Invert the above at the middles of 4096 cells of probability."""
    return np.searchsorted(squash, 16 * np.arange(4096) + 8).astype(np.int64) - REACH


def _tail_table() -> Table:
    """(2, cells) mass beyond i/64 scales: logistic 1 / (1 + e^z), Laplace e^(-z) / 2."""
    powers = _powers(_exp_of(1, CELLS), CELLS * TAIL_REACH + 1)
    logistic = [WHOLE * _ONE // (_ONE + e) for e in powers]
    laplace = [WHOLE * _ONE // (2 * e) for e in powers]
    return np.array([logistic, laplace], np.int64)


def _ln_table() -> Table:
    """65536 ln(1 + i/1024), and last ln 2."""
    shift = _ONE >> 16
    values = [_ln_of(LN_CELLS + i, LN_CELLS) // shift for i in range(LN_CELLS + 1)]
    return np.array(values, np.int64)


SQUASH = _squash_table()
STRETCH = _stretch_table(SQUASH)
TAILS = _tail_table()
LN = _ln_table()
