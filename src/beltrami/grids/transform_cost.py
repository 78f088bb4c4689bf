"""What a fast Fourier transform costs, by the prime factors of its lengths."""

from __future__ import annotations

from collections.abc import Sequence

import scipy.fft

_LONG, _FARTHER = 5000, 2.5  # longer axes leave the fastest memory: each pass costs so much more
_DETOUR = 3.0  # three transforms of twice the length, where a length has a large prime factor


def transform_cost(shape: Sequence[int]) -> float:
    """Return the cost of an FFT for each value, in passes: the sum of the prime factors.

    A length whose factors are too large goes by way of a convolution of at least twice the
    length (L. Bluestein, 1970). Measured, not proven: see the rows ``convolve-*`` of the
    benchmarks.

    Examples
    --------
    >>> transform_cost((64, 64)), transform_cost((61, 61)) > 100
    (24.0, True)
    """
    return sum(_axis_cost(p) * (_FARTHER if p > _LONG else 1.0) for p in shape)


def _axis_cost(p: int) -> float:
    longer = int(scipy.fft.next_fast_len(2 * p - 1))
    return min(_passes(p), _DETOUR * _passes(longer) * longer / p)


def _passes(p: int) -> float:
    """Sum of the prime factors; those that have no code of their own cost a tenth more."""
    total, factor = 0.0, 2
    while factor * factor <= p:
        while p % factor == 0:
            total += factor if factor <= 5 else 1.1 * factor
            p //= factor
        factor += 1
    return total + (0 if p == 1 else p if p <= 5 else 1.1 * p)
