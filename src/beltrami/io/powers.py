"""Powers of five to 128 bits, of ten and of two: the tables behind correctly rounded numbers."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import read_only

SMALLEST = -342  # with 19 digits before it, 10**-343 rounds to zero
LARGEST = 308

TEN = read_only(10.0 ** np.arange(23))  # exact: 5**22 < 2**53
TWO = read_only(np.ldexp(1.0, np.arange(-1074, 1024)))  # 2**e stands at e + 1074


def _leading_bits(q: int) -> int:
    """Return the first 128 bits of 5**q: cut off, but rounded up for -27 <= q < 0.

    Rounded up, the product with an integer that 5**-q divides is recognised as a tie.

    Examples
    --------
    >>> _leading_bits(1) == 5 << 125
    True
    """
    if q >= 0:
        power = int(5**q)
        return power << (128 - power.bit_length()) if q < 56 else power >> _excess(power)
    power = int(5**-q)
    if q >= -27:
        return (1 << (power.bit_length() + 127)) // power + 1
    quotient = (1 << (2 * power.bit_length() + 128)) // power + 1
    return quotient >> _excess(quotient)


def _excess(number: int) -> int:
    return number.bit_length() - 128


_WORDS = [_leading_bits(q) for q in range(SMALLEST, LARGEST + 1)]
FIVE_HIGH = read_only(np.array([word >> 64 for word in _WORDS], np.uint64))
FIVE_LOW = read_only(np.array([word & (2**64 - 1) for word in _WORDS], np.uint64))
