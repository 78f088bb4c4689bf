"""The double nearest to w times a power of ten, with 128 bits of the power of five."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from beltrami._jit import part_of_kernels
from beltrami.io.powers import FIVE_HIGH, FIVE_LOW, LARGEST, SMALLEST, TWO

_1 = np.uint64(1)
_3 = np.uint64(3)
_32 = np.uint64(32)
_LOW = np.uint64(0xFFFFFFFF)
_TAIL = np.uint64(0x1FF)  # the 9 bits below the 55 that decide
_ALL = np.uint64(0xFFFFFFFFFFFFFFFF)
_CARRY = np.uint64(1 << 53)


@part_of_kernels
def scaled(w: Any, q: int) -> float:
    """Return the double nearest to w 10**q, ties to even; NaN where 128 bits do not decide.

    The product of w with the leading bits of 5**q leaves the rounding open only in a few cases:
    they, and results below the normal range, are left to :func:`beltrami.io.decimal.nearest`.

    References
    ----------
    D. Lemire, Number parsing at a gigabyte per second, Software: Practice and Experience 51, 2021.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami._jit import kernel
    >>> kernel(scaled)(np.uint64(12345678901234567), -16) == 1.2345678901234567
    True
    """
    if w == np.uint64(0) or q < SMALLEST:
        return 0.0
    if q > LARGEST:
        return math.inf
    shift = 0
    step = 32
    while step > 0:  # bring the leading bit of w to the top
        if w >> np.uint64(64 - step) == np.uint64(0):
            w <<= np.uint64(step)
            shift += step
        step >>= 1
    high, low = product(w, FIVE_HIGH[q - SMALLEST])
    if high & _TAIL == _TAIL:
        carried, _ = product(w, FIVE_LOW[q - SMALLEST])
        low += carried
        if low < carried:
            high += _1
        if low == _ALL and (q < -27 or q > 55):
            return math.nan
    top = np.int64(high >> np.uint64(63))
    dropped = np.uint64(top + 9)
    mantissa = high >> dropped  # 54 bits: the last one decides the rounding
    exponent = ((217706 * q) >> 16) + 64 + top - shift  # of the leading bit of the product
    if exponent <= -1022:
        return math.nan
    if low <= _1 and -4 <= q <= 23 and mantissa & _3 == _1 and mantissa << dropped == high:
        mantissa -= _1  # exactly half-way: to even
    mantissa = (mantissa + (mantissa & _1)) >> _1
    power = exponent - 53
    if mantissa == _CARRY:
        mantissa >>= _1
        power += 1
    if power > 971:
        return math.inf
    return np.float64(np.int64(mantissa)) * TWO[power + 1074]


@part_of_kernels
def product(a: Any, b: Any) -> Any:
    """Return the high and the low word of the product of two 64-bit integers.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami._jit import kernel
    >>> high, low = kernel(product)(np.uint64(2**63), np.uint64(6))
    >>> int(high), int(low)
    (3, 0)
    """
    a1, a0 = a >> _32, a & _LOW
    b1, b0 = b >> _32, b & _LOW
    cross = a1 * b0 + (a0 * b0 >> _32)
    other = a0 * b1 + (cross & _LOW)
    return a1 * b1 + (cross >> _32) + (other >> _32), a * b
