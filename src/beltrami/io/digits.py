"""Decimal digits, eight at a time: the bytes of a 64-bit word are handled together."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import read_only
from beltrami._jit import part_of_kernels

_1 = np.uint64(1)
_8 = np.uint64(8)
_ONES = np.uint64(0x0101010101010101)
_TOPS = np.uint64(0x8080808080808080)
_ZEROS = np.uint64(0x3030303030303030)  # "00000000"
_PAST_NINE = np.uint64(0x4646464646464646)  # takes what is above "9" to 0x80 and more
_PAIRS = np.uint64(0x000000FF000000FF)
_FIRST = np.uint64(0x000F424000000064)  # 10**6 and 10**2
_SECOND = np.uint64(0x0000271000000001)  # 10**4 and 1
TEN_TO = read_only(10 ** np.arange(9, dtype=np.uint64))


@part_of_kernels
def eight(b: Any, position: int) -> Any:
    """Read up to eight digits: (value, how many), both unsigned; ``position + 8 <= b.size``.

    A byte that is no digit shows in its top bit, after one addition or one subtraction; what
    is above the first of them does not count. Pairs, then fours, are joined by multiplication.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami._jit import kernel
    >>> value, count = kernel(eight)(np.frombuffer(b"1234567,89", np.uint8), 0)
    >>> int(value), int(count)
    (1234567, 7)
    """
    p = np.uint64(position)  # unsigned: no place counted from the end
    word = np.uint64(b[p])
    word |= np.uint64(b[p + np.uint64(1)]) << np.uint64(8)
    word |= np.uint64(b[p + np.uint64(2)]) << np.uint64(16)
    word |= np.uint64(b[p + np.uint64(3)]) << np.uint64(24)
    word |= np.uint64(b[p + np.uint64(4)]) << np.uint64(32)
    word |= np.uint64(b[p + np.uint64(5)]) << np.uint64(40)
    word |= np.uint64(b[p + np.uint64(6)]) << np.uint64(48)
    word |= np.uint64(b[p + np.uint64(7)]) << np.uint64(56)
    other = ((word + _PAST_NINE) | (word - _ZEROS)) & _TOPS
    below = (other - _1) & ~other  # all bits below the first of them
    count = (((below >> np.uint64(7)) & _ONES) * _ONES) >> np.uint64(56)
    if count == np.uint64(0):
        return count, count
    word = (word - _ZEROS) << ((_8 - count) << np.uint64(3))  # zeros in front
    word = word * np.uint64(10) + (word >> _8)
    low = (word & _PAIRS) * _FIRST
    high = ((word >> np.uint64(16)) & _PAIRS) * _SECOND
    return (low + high) >> np.uint64(32), count
