"""The double nearest to a decimal number of any length, by exact integers."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from beltrami._jit import kernel
from beltrami.io.powers import TEN

_LIMBS = 400  # of 32 bits: 800 digits times 5**308, or 2**54 times 5**1150, with room to spare
_DIGITS = 800  # no half-way point between doubles has more than 767 digits
_32 = np.uint64(32)
_LOW = np.uint64(0xFFFFFFFF)


@kernel
def nearest(b: Any, start: int, stop: int, exponent: int) -> float:
    """Return the double nearest to the digits b[start:stop] times 10**exponent, ties to even.

    The exponent is the one written in the file; a point among the digits counts by itself.
    An estimate is moved, one double at a time, until its half-way points enclose the number.

    Examples
    --------
    >>> import numpy as np
    >>> digits = np.frombuffer(b"9007199254740993", np.uint8)  # 2**53 + 1: a tie
    >>> nearest(digits, 0, len(digits), 0)
    9007199254740992.0
    """
    number = np.zeros(_LIMBS, np.uint64)
    size, estimate, digits, q = _collect(b, start, stop, exponent, number)
    if size == 0 or digits + q < -330:
        return 0.0
    if digits + q > 310:
        return math.inf
    z = _rough(estimate, q + max(digits - 19, 0))
    while True:
        m, k = _decompose(z)
        above = _compare(number, size, q, 2 * m + 1, k - 1)
        if above > 0 or (above == 0 and m % 2 == 1):
            z = math.ldexp(np.float64(m + 1), k)
            if z == math.inf:
                return z
            continue
        if m == 0:
            return z
        if m == 1 << 52 and k > -1074:  # the double below is half a step away
            m, k = 1 << 53, k - 1
        below = _compare(number, size, q, 2 * m - 1, k - 1)
        if below > 0 or (below == 0 and m % 2 == 0):
            return z
        z = math.ldexp(np.float64(m - 1), k)


@kernel
def _collect(b: Any, start: int, stop: int, exponent: int, number: Any) -> Any:
    """Gather the digits as an integer: size, first 19 digits, how many digits, exponent."""
    size = 0
    digits = 0
    estimate = 0.0
    q = exponent
    fraction = False
    rest: Any = False
    for p in range(start, stop):
        if b[p] == 46:
            fraction = True
            continue
        digit: Any = np.int64(b[p]) - 48
        if digits < _DIGITS:
            if digits or digit:
                digits += 1
                size = _multiply_add(number, size, 10, digit)
                if digits <= 19:
                    estimate = 10.0 * estimate + digit
            if fraction:
                q -= 1
        else:
            rest = rest or digit > 0
            if not fraction:
                q += 1
    if rest:  # a one in the end stands for all that was cut off
        size = _multiply_add(number, size, 10, 1)
        digits += 1
        q -= 1
    return size, estimate, digits, q


@kernel
def _rough(estimate: float, q: int) -> float:
    """Return a finite double near estimate 10**q."""
    while q > 0:
        step = min(q, 22)
        estimate *= TEN[step]
        q -= step
    while q < 0:
        step = min(-q, 22)
        estimate /= TEN[step]
        q += step
    return min(estimate, 1.7976931348623157e308)


@kernel
def _decompose(z: float) -> Any:
    """Write z as m 2**k with m < 2**53 and k as small as a double allows."""
    fraction, power = math.frexp(z)
    m = np.int64(math.ldexp(fraction, 53))
    k: Any = np.int64(power) - 53
    if m == 0:
        k = -1074
    if k < -1074:
        m >>= -1074 - k
        k = -1074
    return m, k


@kernel
def _compare(number: Any, size: int, q: int, m: int, k: int) -> int:
    """Return the sign of number 10**q - m 2**k."""
    left = number.copy()
    right = np.zeros(_LIMBS, np.uint64)
    n = _multiply_add(right, 0, 1, m & 0xFFFFFFFF)
    if m >> 32:
        right[1] = np.uint64(m >> 32)
        n = 2
    size = _scale(left, size, 5, max(q, 0))
    n = _scale(right, n, 5, max(-q, 0))
    size = _scale(left, size, 2, max(q - k, 0))
    n = _scale(right, n, 2, max(k - q, 0))
    if size != n:
        return 1 if size > n else -1
    for i in range(n - 1, -1, -1):
        if left[i] != right[i]:
            return 1 if left[i] > right[i] else -1
    return 0


@kernel
def _scale(number: Any, size: int, base: int, power: int) -> int:
    """Multiply in place by base**power; return the new size."""
    most = 13 if base == 5 else 31  # the largest powers below 2**32
    while power > 0:
        step = min(power, most)
        size = _multiply_add(number, size, base**step, 0)
        power -= step
    return size


@kernel
def _multiply_add(number: Any, size: int, factor: int, carry: int) -> int:
    """Multiply in place by a factor below 2**32 and add a carry; return the new size."""
    rest = np.uint64(carry)
    for i in range(size):
        rest += number[i] * np.uint64(factor)
        number[i] = rest & _LOW
        rest >>= _32
    if rest:
        number[size] = rest
        size += 1
    return size
