"""Numbers out of a buffer of bytes: the double that Python's float() gives, at once."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from beltrami._jit import part_of_kernels
from beltrami.io.decimal import nearest
from beltrami.io.digits import TEN_TO, eight
from beltrami.io.powers import TEN
from beltrami.io.rounding import scaled

_0 = np.uint64(0)
_1 = np.uint64(1)
_8 = np.uint64(8)
_9 = np.uint64(9)
_10 = np.uint64(10)
_48 = np.uint64(48)
_EXACT = np.uint64(1 << 53)
_DOT, _MINUS, _PLUS, _BACKSLASH = 46, 45, 43, 92
_FAR = 100_000  # an exponent that no number of digits in a file brings back into range


@part_of_kernels
def read_number(b: Any, p: Any, end: int) -> Any:
    """Read a decimal number at p: (value, position after it).

    The value equals Python's ``float()`` bit for bit. ``nan``, ``inf`` and ``infinity`` are
    numbers too. The number ends at a blank, a control character, a backslash or at ``end``;
    anything else is no number, and then the position comes back as it was.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami._jit import kernel
    >>> line = np.frombuffer(b"-0.5e3 1,5", np.uint8)
    >>> kernel(read_number)(line, 0, len(line)), kernel(read_number)(line, 7, len(line))
    ((-500.0, 6), (0.0, 7))
    """
    start = p
    negative = False
    if p < end and (b[p] == _MINUS or b[p] == _PLUS):
        negative = b[p] == _MINUS
        p += 1
    first = p
    w = _0
    while p < end:
        digit = np.uint64(b[p]) - _48  # wraps around to a large number below "0"
        if digit > _9:
            break
        w = w * _10 + digit
        p += 1
    digits = p - first
    q = 0
    if p < end and b[p] == _DOT:
        p += 1
        dot = p
        count = _8
        if p + 8 <= end:
            value, count = eight(b, p)
            w = w * TEN_TO[count] + value
            p += np.int64(count)
        if count == _8:
            w, p = _append(b, p, end, w)
        q = dot - p
        digits -= q
    if digits == 0:
        return _special(b, first, end, start, negative)
    stop = p
    exponent = 0
    if p < end and (b[p] | 32) == 101:
        exponent, p = _exponent(b, p + 1, end)
        q += exponent
    if p < 0 or (p < end and b[p] > 32 and b[p] != _BACKSLASH):
        return 0.0, start
    if digits <= 19 and w <= _EXACT and -22 <= q <= 22:
        x: Any = np.float64(np.int64(w))  # one exact operand, one rounding
        x = x / TEN[-q] if q < 0 else x * TEN[q]
    else:
        x = scaled(w, q) if digits <= 19 else math.nan
        if math.isnan(x):
            x = _rounded(b, first, stop, exponent, p)
    return (-x if negative else x), p


@part_of_kernels
def _append(b: Any, p: Any, end: int, w: Any) -> Any:
    """Append the digits at p to the integer w: (integer modulo 2**64, position after them)."""
    while p + 8 <= end:
        value, count = eight(b, p)
        w = w * TEN_TO[count] + value
        p += np.int64(count)
        if count < _8:
            return w, p
    while p < end:
        digit = np.uint64(b[p]) - _48  # wraps around to a large number below "0"
        if digit > _9:
            break
        w = w * _10 + digit
        p += 1
    return w, p


@part_of_kernels
def _exponent(b: Any, p: int, end: int) -> Any:
    """Read the digits after an "e": (exponent, position), the position -1 if there are none."""
    negative = False
    if p < end and (b[p] == _MINUS or b[p] == _PLUS):
        negative = b[p] == _MINUS
        p += 1
    first = p
    exponent: Any = 0
    while p < end and 48 <= b[p] <= 57:
        if exponent < _FAR:
            exponent = 10 * exponent + np.int64(b[p]) - 48
        p += 1
    return (-exponent if negative else exponent), (p if p > first else -1)


@part_of_kernels
def _special(b: Any, p: int, end: int, start: int, negative: bool) -> Any:
    """Read "nan", "inf" or "infinity", in any case."""
    stop = p
    while stop < end and b[stop] > 32 and stop - p < 9:
        stop += 1
    if stop - p == 3 or stop - p == 8:
        word = 0
        for i in range(p, p + 3):
            word = 256 * word + (b[i] | 32)
        if word == 0x6E616E and stop - p == 3:
            return math.nan, stop
        if word == 0x696E66:
            rest = 0
            for i in range(p + 3, stop):
                rest = 256 * rest + (b[i] | 32)
            if stop - p == 3 or rest == 0x696E697479:
                return (-math.inf if negative else math.inf), stop
    return 0.0, start


@part_of_kernels
def _rounded(b: Any, first: int, stop: int, exponent: int, end: int) -> float:
    """Round a number that one multiplication does not: by 19 digits if they decide, else by all."""
    w = _0
    kept = 0
    q = exponent
    cut = False
    fraction = False
    for p in range(first, stop):
        if b[p] == _DOT:
            fraction = True
            continue
        digit = np.uint64(b[p]) - _48
        if kept < 19:
            if kept or digit:
                kept += 1
            w = w * _10 + digit
            if fraction:
                q -= 1
        else:
            cut = cut or digit != _0
            if not fraction:
                q += 1
    value = scaled(w, q)
    if math.isnan(value) or (cut and scaled(w + _1, q) != value):
        return nearest(b, first, end)
    return value


@part_of_kernels
def read_integer(b: Any, p: Any, end: int) -> Any:
    """Read an integer of at most 18 digits at p: (value, position after the last digit).

    What follows the digits is the caller's to check; without digits the position comes back.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami._jit import kernel
    >>> kernel(read_integer)(np.frombuffer(b"-12/5", np.uint8), 0, 5)
    (-12, 3)
    """
    start = p
    negative = False
    if p < end and (b[p] == _MINUS or b[p] == _PLUS):
        negative = b[p] == _MINUS
        p += 1
    first = p
    w, count = _0, _8
    if p + 8 <= end:
        w, count = eight(b, p)
        p += np.int64(count)
    if count == _8:
        w, p = _append(b, p, end, w)
    value = np.int64(w)
    if p == first or p - first > 18:
        return 0, start
    return (-value if negative else value), p


@part_of_kernels
def skip_blanks(b: Any, p: int, end: int) -> int:
    r"""Return the position of the next byte at or after p that is no blank; a newline is none.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami._jit import kernel
    >>> kernel(skip_blanks)(np.frombuffer(b"1 \t\r 2", np.uint8), 1, 6)
    5
    """
    while p < end and b[p] <= 32 and b[p] != 10:
        p += 1
    return p


@part_of_kernels
def next_line(b: Any, p: int, end: int) -> int:
    r"""Return the position after the next newline at or after p, or ``end``.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami._jit import kernel
    >>> kernel(next_line)(np.frombuffer(b"# no\n1", np.uint8), 0, 6)
    5
    """
    while p < end and b[p] != 10:
        p += 1
    return p + 1 if p < end else end
