"""Series of Chebyshev polynomials of W̃; several series of the same values share the products."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel
from beltrami._progress import Progress, stages
from beltrami.solvers.locality import LocalRows

_ROUNDS_A_CALL = 20  # between two looks at the progress, and at ctrl-C; even
_BLOCK = 1536  # values, of which those of T_i and T_{i+1} stay near while they are added


def filter_rows(
    rows: LocalRows, x: Floats, coefficients: Floats, progress: Progress | None = None
) -> Floats:
    r"""Return :math:`\sum_i c_i T_i(\tilde W) x` by :math:`T_{i+1} = 2 \tilde W T_i - T_{i-1}`.

    ``rows`` hold W̃ with its shares; a row that is empty leaves its values alone. The columns of
    x (n, d) go three at a time.
    """
    return filter_rows_by(rows, x, [coefficients], progress)[0]


def filter_rows_by(
    rows: LocalRows, x: Floats, series: Sequence[Floats], progress: Progress | None = None
) -> list[Floats]:
    """Return what ``filter_rows`` does for each of some series, with the same bits.

    Cost: one product with W̃ for each term of the longest one, and to add up those of all.
    """
    lengths = np.array([len(one) for one in series])
    table = np.zeros((len(series), max(lengths)))
    for row, one in zip(table, series, strict=True):
        row[: len(one)] = one
    n, d = x.shape
    ordered = np.zeros((n, d + -d % 3))
    ordered[:, :d] = np.take(x, rows.order, axis=0, mode="clip")
    parts = [
        _filtered(rows, np.ascontiguousarray(ordered[:, k : k + 3]), table, lengths, progress)
        for k in range(0, d, 3)
    ]
    return [
        np.take(np.concatenate(one, axis=1)[:, :d], rows.number, axis=0, mode="clip")
        for one in zip(*parts, strict=True)
    ]


def _filtered(
    rows: LocalRows, before: Floats, table: Floats, lengths: Any, progress: Progress | None
) -> Floats:
    """Run the recurrence on three columns, which it overwrites; (series, n, 3)."""
    pattern = (rows.indptr, rows.indices, rows.data)
    now = np.empty_like(before)
    _multiply(*pattern, before, np.zeros_like(before), 1.0, now)
    totals = np.zeros((len(table), before.size))
    _add(table, lengths, 0, before.ravel(), now.ravel(), totals)
    done = 2
    for rounds in stages(max(table.shape[1] - 2, 0), progress, _ROUNDS_A_CALL):
        _recur(*pattern, before, now, table, lengths, done, done + rounds, totals)
        done += rounds
    return totals.reshape(len(table), *before.shape)


@kernel
def _recur(
    indptr: Any,
    indices: Any,
    shares: Any,
    before: Any,
    now: Any,
    table: Any,
    lengths: Any,
    begin: int,
    end: int,
    totals: Any,
) -> None:
    """Add the terms from ``begin`` to ``end``, two at a time: (T_0, T_1) -> (T_2, T_3) ..."""
    flat = before.reshape(before.size), now.reshape(now.size)
    for k in range(begin, end, 2):
        _multiply(indptr, indices, shares, now, before, 2.0, before)
        if k + 1 < end:
            _multiply(indptr, indices, shares, before, now, 2.0, now)
        _add(table, lengths, k, flat[0], flat[1], totals)


@kernel
def _multiply(
    indptr: Any, indices: Any, shares: Any, x: Any, before: Any, factor: float, y: Any
) -> None:
    """Write y = factor W̃ x - before, which y may be."""
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
        i += one


@kernel
def _add(table: Any, lengths: Any, k: int, u: Any, v: Any, totals: Any) -> None:
    """Add c_k u, and then c_{k+1} v, to the total of each series that has such terms."""
    n, block = np.uint64(u.size), np.uint64(_BLOCK)
    begin = np.uint64(0)
    while begin < n:
        end = min(begin + block, n)
        for s in range(lengths.size):
            if lengths[s] > k + 1:
                c, d = table[s, k], table[s, k + 1]
                for i in range(begin, end):
                    totals[s, i] = totals[s, i] + c * u[i] + d * v[i]
            elif lengths[s] > k:
                c = table[s, k]
                for i in range(begin, end):
                    totals[s, i] += c * u[i]
        begin = end
