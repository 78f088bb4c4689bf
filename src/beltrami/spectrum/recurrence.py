"""Sums of Chebyshev polynomials of B⁻¹L times functions: one product with L for each order."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel
from beltrami._progress import Progress, stages
from beltrami.operators.pair import Laplacian
from beltrami.solvers.locality import LocalRows, local_rows
from beltrami.spectrum.chebyshev import ChebyshevSeries
from beltrami.spectrum.interval import Interval
from beltrami.spectrum.operator import as_operator

_ORDERS_A_CALL = 20  # between two looks at the progress, and at ctrl-C


def chebyshev_sums(
    laplacian: Laplacian,
    f: Floats,
    series: Sequence[ChebyshevSeries],
    progress: Progress | None = None,
) -> Floats:
    r"""Return :math:`p_j(B^{-1}L) f` for each series j: (j, n, c) for f of the shape (n, c).

    With :math:`X = (2 B^{-1}L - (a + b)) / (b - a)` on the interval [a, b], the same for all
    series, :math:`T_{k+1}(X) f = 2 X T_k(X) f - T_{k-1}(X) f`.

    Notes
    -----
    For diagonal masses the rows are renumbered once so that neighbours are near in memory, and
    each order is one pass that multiplies, subtracts and sums; columns go by fours. The consistent
    mass is solved for, in each order. Cost: O(N p c) for the order N and p edges.

    Examples
    --------
    >>> from beltrami.mesh.topology import Topology
    >>> from beltrami.operators.laplacian import laplacian
    >>> from beltrami.spectrum.chebyshev import chebyshev_series
    >>> from beltrami.spectrum.interval import spectral_interval
    >>> pair = laplacian(Topology([[0, 1, 2]]))
    >>> identity = chebyshev_series(lambda x: x, spectral_interval(pair))
    >>> chebyshev_sums(pair, np.array([[1.0], [0.0], [0.0]]), [identity]).round(9).ravel().tolist()
    [1.0, -0.5, -0.5]
    """
    table = _table(series)
    interval = series[0].interval
    if interval.low == interval.high or not f.size or len(table) == 1:
        return np.asarray(table[0][:, None, None] * f)
    if laplacian.mass_kind == "consistent":
        return _by_solves(laplacian, f, table, interval, progress)
    stiffness = laplacian.stiffness
    rows = local_rows(
        stiffness.indptr, stiffness.indices, stiffness.data, np.zeros(laplacian.n, np.bool_)
    )
    scale = 1 / laplacian.masses[rows.order]
    result = np.empty((table.shape[1], *f.shape))
    groups = _groups(f.shape[1])
    done = 0

    def tell(step: int, steps: int) -> None:
        if progress is not None:
            progress(done * steps + step, len(groups) * steps)

    for start, stop in groups:
        state = f[rows.order, start] if stop - start == 1 else np.zeros((laplacian.n, 4))
        if stop - start > 1:
            state[:, : stop - start] = f[rows.order, start:stop]
        sums = _sums(rows, scale, state, table, interval, tell)
        found = np.take(sums, rows.number, axis=1, mode="clip")
        result[:, :, start:stop] = found.reshape(*found.shape[:2], -1)[..., : stop - start]
        done += 1
    return result


def _table(series: Sequence[ChebyshevSeries]) -> Floats:
    """Put the coefficients of all series side by side: (orders, series), 0 beyond their ends."""
    table = np.zeros((max(each.order for each in series) + 1, len(series)))
    for j, each in enumerate(series):
        table[: each.order + 1, j] = each.coefficients
    return table


def _groups(columns: int) -> list[tuple[int, int]]:
    """Cut the columns in fours; three left go as four, one or two left one by one."""
    groups = [(start, min(start + 4, columns)) for start in range(0, columns, 4)]
    if columns % 4 == 2:
        groups[-1:] = [(columns - 2, columns - 1), (columns - 1, columns)]
    return groups


def _factors(interval: Interval) -> tuple[float, float]:
    """Return u and v with 2 X = u B⁻¹L - v."""
    low, high = interval
    return 4 / (high - low), 2 * (high + low) / (high - low)


def _sums(
    rows: LocalRows, scale: Floats, x: Floats, table: Floats, interval: Interval, progress: Progress
) -> Floats:
    """Run the recurrence for one column (n,) or four (n, 4): (j, n) or (j, n, 4)."""
    u, v = _factors(interval)
    advance = _advance_one if x.ndim == 1 else _advance_four
    matrix = (rows.indptr, rows.indices, rows.data, scale)
    sums = np.multiply.outer(table[0], x)
    before = np.zeros_like(x)
    advance(*matrix, x, before, sums, table[1:2], u / 2, v / 2)  # T_1 = X T_0
    older, newer = x, before
    at = 2
    for size in stages(len(table) - 2, progress, _ORDERS_A_CALL):
        advance(*matrix, newer, older, sums, table[at : at + size], u, v)
        if size % 2:
            older, newer = newer, older
        at += size
    return sums


def _by_solves(
    laplacian: Laplacian, f: Floats, table: Floats, interval: Interval, progress: Progress | None
) -> Floats:
    """Run the recurrence with a solve for the mass in each order."""
    u, v = _factors(interval)
    apply = as_operator(laplacian)
    sums = table[0][:, None, None] * f
    older, newer = f, u / 2 * apply(f) - v / 2 * f
    sums += table[1][:, None, None] * newer
    for k, _ in enumerate(stages(len(table) - 2, progress), start=2):
        following = u * apply(newer) - v * newer - older
        older, newer = newer, following
        sums += table[k][:, None, None] * newer
    return np.asarray(sums)


@kernel
def _advance_one(
    indptr: Any,
    indices: Any,
    data: Any,
    scale: Any,
    x: Any,
    z: Any,
    sums: Any,
    table: Any,
    u: float,
    v: float,
) -> None:
    """Replace z by u B⁻¹L x - v x - z, add it to the sums, swap x and z; a row of the table each.

    After an odd number of rows the newest is where z was given, else where x was.
    """
    n = np.uint64(x.size)
    one = np.uint64(1)
    for r in range(table.shape[0]):
        share, first = table[r, 0], sums[0]
        i = q = np.uint64(0)
        while i < n:
            end = np.uint64(indptr[i + one])
            total = 0.0
            while q < end:
                total += data[q] * x[np.uint64(indices[q])]
                q += one
            new = u * scale[i] * total - v * x[i] - z[i]
            z[i] = new
            first[i] += share * new
            i += one
        for j in range(1, table.shape[1]):  # apart, so that one series has nothing to loop over
            for k in range(x.size):
                sums[j, k] += table[r, j] * z[k]
        x, z = z, x


@kernel
def _advance_four(
    indptr: Any,
    indices: Any,
    data: Any,
    scale: Any,
    x: Any,
    z: Any,
    sums: Any,
    table: Any,
    u: float,
    v: float,
) -> None:
    """Do the same for four columns side by side."""
    n = np.uint64(x.shape[0])
    one = np.uint64(1)
    for r in range(table.shape[0]):
        share, first = table[r, 0], sums[0]
        i = q = np.uint64(0)
        while i < n:
            end = np.uint64(indptr[i + one])
            a = b = c = d = 0.0
            while q < end:
                weight, at = data[q], np.uint64(indices[q])
                a += weight * x[at, 0]
                b += weight * x[at, 1]
                c += weight * x[at, 2]
                d += weight * x[at, 3]
                q += one
            factor = u * scale[i]
            a = factor * a - v * x[i, 0] - z[i, 0]
            b = factor * b - v * x[i, 1] - z[i, 1]
            c = factor * c - v * x[i, 2] - z[i, 2]
            d = factor * d - v * x[i, 3] - z[i, 3]
            z[i, 0], z[i, 1], z[i, 2], z[i, 3] = a, b, c, d
            first[i, 0] += share * a
            first[i, 1] += share * b
            first[i, 2] += share * c
            first[i, 3] += share * d
            i += one
        for j in range(1, table.shape[1]):
            for k in range(x.shape[0]):
                for column in range(4):
                    sums[j, k, column] += table[r, j] * z[k, column]
        x, z = z, x
