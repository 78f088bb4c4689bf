"""The windowed sinc filter: a polynomial of W̃ that is near 1, then near 0 (Taubin 1996)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel
from beltrami._progress import Progress, stages
from beltrami.errors import BeltramiError
from beltrami.solvers.locality import LocalRows

_ROUNDS_A_CALL = 20  # between two looks at the progress, and at ctrl-C


def sinc_coefficients(pass_band: float, degree: int) -> Floats:
    r"""Return c with :math:`\sum_i c_i T_i(1 - k)` near 1 for k < k_PB, and near 0 beyond.

    The Chebyshev coefficients of the ideal low-pass filter on the frequencies 0 <= k <= 2 of
    Id - W̃, times a Hamming window, which trades the ripples of a cut series for a wider edge of
    about :math:`8\pi/N` in the angle :math:`\arccos(1 - k)`. They are scaled to add to 1, so that
    constants stay (Taubin, Zhang and Golub 1996).

    Raises
    ------
    BeltramiError
        If the pass band is not between 0 and 2, or the degree below 1.

    Examples
    --------
    >>> c = sinc_coefficients(0.1, 20)
    >>> gain = np.polynomial.chebyshev.chebval(1 - np.array([0, 0.01, 0.1, 1]), c)
    >>> gain.round(2).tolist()
    [1.0, 1.0, 0.5, -0.0]
    """
    if not 0 < pass_band < 2:
        raise BeltramiError(f"the pass band must be between 0 and 2, not {pass_band}")
    if degree < 1 or degree != int(degree):
        raise BeltramiError(f"steps must be a whole number >= 1, not {degree}")
    edge = math.acos(1 - pass_band)
    i = np.arange(1, int(degree) + 1)
    window = 0.54 + 0.46 * np.cos(np.pi * i / (degree + 1))
    c = np.concatenate([[edge / np.pi], 2 * window * np.sin(i * edge) / (i * np.pi)])
    return np.asarray(c / c.sum())


def filter_rows(
    rows: LocalRows, x: Floats, coefficients: Floats, progress: Progress | None = None
) -> Floats:
    r"""Return :math:`\sum_i c_i T_i(\tilde W) x` by :math:`T_{i+1} = 2 \tilde W T_i - T_{i-1}`.

    ``rows`` hold W̃ with its shares; a row that is empty leaves its values alone. The columns of
    x (n, d) go three at a time.
    """
    n, d = x.shape
    ordered = np.zeros((n, d + -d % 3))
    ordered[:, :d] = np.take(x, rows.order, axis=0, mode="clip")
    parts = [
        _filtered(rows, np.ascontiguousarray(ordered[:, k : k + 3]), coefficients, progress)
        for k in range(0, d, 3)
    ]
    return np.take(np.concatenate(parts, axis=1)[:, :d], rows.number, axis=0, mode="clip")


def _filtered(
    rows: LocalRows, before: Floats, coefficients: Floats, progress: Progress | None
) -> Floats:
    """Run the recurrence on three columns, which it overwrites."""
    pattern = (rows.indptr, rows.indices, rows.data)
    total = coefficients[0] * before
    now = np.empty_like(before)
    _multiply_add(*pattern, before, np.zeros_like(before), 1.0, coefficients[1:2], now, total)
    # (T_0, T_1) -> (T_2, T_1) -> (T_2, T_3) ...: each takes the place of the last but one
    done = 2
    for rounds in stages(max(len(coefficients) - 2, 0), progress, _ROUNDS_A_CALL):
        some = coefficients[done : done + rounds]
        done += rounds
        if _recur(*pattern, before, now, some, total):
            before, now = now, before
    return np.asarray(total)


@kernel
def _recur(
    indptr: Any, indices: Any, shares: Any, before: Any, now: Any, coefficients: Any, total: Any
) -> bool:
    """Run the recurrence once for each coefficient; say whether the last T is in ``before``."""
    for k in range(coefficients.size):
        _multiply_add(
            indptr, indices, shares, now, before, 2.0, coefficients[k : k + 1], before, total
        )
        now, before = before, now
    return coefficients.size % 2 == 1


@kernel
def _multiply_add(
    indptr: Any,
    indices: Any,
    shares: Any,
    x: Any,
    before: Any,
    factor: float,
    coefficient: Any,
    y: Any,
    total: Any,
) -> None:
    """Write y = factor W̃ x - before, which y may be, and add c y to the total."""
    n = np.uint64(x.shape[0])
    one = np.uint64(1)
    i = q = np.uint64(0)
    while i < n:
        end = np.uint64(indptr[i + one])
        a, b, c = (x[i, 0], x[i, 1], x[i, 2]) if q == end else (0.0, 0.0, 0.0)
        while q < end:
            j = np.uint64(indices[q])
            a += shares[q] * x[j, 0]
            b += shares[q] * x[j, 1]
            c += shares[q] * x[j, 2]
            q += one
        y[i, 0] = factor * a - before[i, 0]
        y[i, 1] = factor * b - before[i, 1]
        y[i, 2] = factor * c - before[i, 2]
        total[i, 0] += coefficient[0] * y[i, 0]
        total[i, 1] += coefficient[0] * y[i, 1]
        total[i, 2] += coefficient[0] * y[i, 2]
        i += one
