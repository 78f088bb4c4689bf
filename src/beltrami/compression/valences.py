"""Valences of new vertices, guessed from what is around the gate."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import plain_kernel
from beltrami.compression.mixing import Mixer, code_mixed, new_mixer
from beltrami.compression.range_coder import code_number, new_number_model
from beltrami.compression.tables import whole

_STEPS = 16  # decisions about a valence before its rest is written as a number
_BITS = 17
_SPEED = 500
_LARGEST = 1 << 30  # no mesh has as many faces


class Valences(NamedTuple):
    """What the model of the valences knows.

    Attributes
    ----------
    known : (n,) int64
        The valences of the vertices so far.
    around : (12,) int64
        What is around the gate, each at most 15.
    recent : (4,) int64
        The last valences, and whether the last tips were new, as bits.
    mixer
        For the decisions; ``rest`` is the model of what is left of large ones.
    """

    known: NDArray[np.int64]
    around: NDArray[np.int64]
    recent: NDArray[np.int64]
    mixer: Mixer
    rest: NDArray[np.int64]


def new_valences(vertices: int) -> Valences:
    """Make a model that knows no valence."""
    mixer = new_mixer(0, 10, 1 << _BITS, (32 * 16, 32 * 16), trust=(0, 220), limit=400)
    return Valences(
        np.zeros(vertices, np.int64),
        np.zeros(12, np.int64),
        np.full(4, 6, np.int64),
        mixer,
        new_number_model(),
    )


@plain_kernel
def _look(p: int, front: Any, valences: Any) -> None:
    """Note valences and missing faces around the side after the node p."""
    a, known = valences.around, valences.known
    if p < 0:
        a[:] = 0
        return
    b, q = front.after[p], front.before[p]
    c = front.after[b]
    a[0], a[1], a[2], a[3] = front.missing[p], front.missing[b], front.missing[q], front.missing[c]
    a[4], a[5] = known[front.vertex[p]], known[front.vertex[b]]
    a[6], a[7] = known[front.behind[p]], known[front.vertex[q]]
    a[8], a[9] = known[front.vertex[c]], known[front.behind[q]]
    a[10] = known[front.behind[b]]
    for i in range(11):
        a[i] = min(a[i], 15)


@plain_kernel
def _hash(a: int, b: int, c: int, d: int, e: int, f: int) -> int:
    """Mix six numbers below 32 to one of ``_BITS`` bits."""
    x = ((((a * 32 + b) * 32 + c) * 32 + d) * 32 + e) * 32 + f
    x = (x * 0x2545F491) & 0xFFFFFFFF
    x ^= x >> 15
    x = (x * 0x1B873593) & 0xFFFFFFFF
    return (x >> 7) & ((1 << _BITS) - 1)


@plain_kernel
def _choose(step: int, valences: Any) -> None:
    """Write the contexts of the decision number ``step``."""
    a, r, x = valences.around, valences.recent, valences.mixer.contexts
    x[0] = _hash(step, a[4], a[5], 0, 0, 0)
    x[1] = _hash(step, a[6], a[5], a[4], 1, 0)
    x[2] = _hash(step, r[0], r[1], 2, 0, 0)
    x[3] = _hash(step, a[0], a[1], a[4], a[2], 3)
    x[4] = _hash(step, (a[4] + a[5] + a[6] + a[7] + a[8]) // 2 & 31, min(a[0], 4), 4, 0, 0)
    x[5] = _hash(step, a[0], a[7], a[5], a[9], 5)
    x[6] = _hash(step, r[0], r[1], r[2], 6, a[0])
    x[7] = _hash(step, a[2], a[3], a[0], a[1], 7)
    x[8] = _hash(step, a[4] + 16, a[5], a[6], a[7], a[8])
    x[9] = _hash(step, a[10], a[8], a[5], a[6], 9)


@plain_kernel
def code_is_new(bit: int, p: int, front: Any, valences: Any, state: Any, buffer: Any) -> int:
    """Write or read whether the tip at the side after node p is a new vertex."""
    _look(p, front, valences)
    _choose(31, valences)
    a = valences.around
    return code_mixed(bit, 31 * 16 + a[0], 31 * 16 + a[1], _SPEED, valences.mixer, state, buffer)


@plain_kernel
def code_valence(value: int, p: int, front: Any, valences: Any, state: Any, buffer: Any) -> int:
    """Write or read a valence >= 2: is it 6, is it less, and then one by one."""
    _look(p, front, valences)
    six = _decide(1 if value == 6 else 0, 0, valences, state, buffer)
    found = whole(6)
    if not six:
        less = _decide(1 if value < 6 else 0, 1, valences, state, buffer)
        if less:
            found = 5
            while found > 2 and _decide(
                1 if value < found else 0, 7 - found, valences, state, buffer
            ):
                found -= 1
        else:
            found = 7
            while found < _STEPS and _decide(
                1 if value > found else 0, found - 1, valences, state, buffer
            ):
                found += 1
            if found == _STEPS:
                found += code_number(value - _STEPS, valences.rest, state, buffer)
    found = min(found, _LARGEST)
    r = valences.recent
    r[2], r[1], r[0] = r[1], r[0], min(found, 15)
    return found


@plain_kernel
def _decide(bit: int, step: int, valences: Any, state: Any, buffer: Any) -> int:
    _choose(step, valences)
    a = valences.around
    return code_mixed(
        bit, step * 16 + a[0], step * 16 + a[5], _SPEED, valences.mixer, state, buffer
    )
