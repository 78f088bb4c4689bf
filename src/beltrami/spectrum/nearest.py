"""Nearest neighbours among points of few or many coordinates, exactly."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats, Integers

_FEW = 16  # coordinates, up to which a KD-tree is faster: beyond, it looks at almost every point
_QUERIES, _POINTS = 256, 1024  # a table of as many products stays in the cache


def nearest_rows(among: Floats, queries: Floats) -> Integers:
    r"""Return for each row of the queries (q, d) the index of the nearest row of ``among`` (n, d).

    By a KD-tree for few coordinates; otherwise by all products, since
    :math:`|x - y|^2 / 2 = |x|^2 / 2 - \langle x, y\rangle + \dots` is a product of matrices: q n d
    operations at the speed of BLAS. Of equal distances the products take the first.

    Examples
    --------
    >>> nearest_rows(np.array([[0.0], [2.0], [5.0]]), np.array([[1.9], [4.0]])).tolist()
    [1, 2]
    """
    if among.shape[1] > _FEW:
        return _by_products(among, queries)
    from scipy.spatial import KDTree  # slow to load

    return np.asarray(KDTree(among).query(queries)[1], dtype=np.int64)


def _by_products(among: Floats, queries: Floats) -> Integers:
    """Maximise <x, y> - |x|²/2, table by table."""
    columns = np.concatenate([among.T, -0.5 * (among**2).sum(axis=1)[None]])
    rows = np.concatenate([queries, np.ones((len(queries), 1))], axis=1)
    nearest = np.zeros(len(queries), np.int64)
    best = np.full(len(queries), -np.inf)
    for q in range(0, len(queries), _QUERIES):
        mine = slice(q, q + _QUERIES)
        for p in range(0, len(among), _POINTS):
            table = rows[mine] @ columns[:, p : p + _POINTS]
            at = table.argmax(axis=1)
            values = table[np.arange(len(at)), at]
            better = values > best[mine]
            nearest[mine] = np.where(better, at + p, nearest[mine])
            best[mine] = np.where(better, values, best[mine])
    return nearest


def spread_rows(points: Floats, count: int) -> Integers:
    """Choose ``count`` rows of points (n, d), each the farthest from those before.

    The first is the farthest from the origin. Cost: O(n d) for each.

    Examples
    --------
    >>> spread_rows(np.array([[0.0], [1.0], [2.0], [-3.0]]), 3).tolist()
    [3, 2, 0]
    """
    sizes = (points**2).sum(axis=1)
    chosen = np.empty(count, np.int64)
    chosen[0] = sizes.argmax()
    squares = np.full(len(points), np.inf)
    for i in range(1, count):
        last = chosen[i - 1]
        squares = np.minimum(squares, sizes - 2 * (points @ points[last]) + sizes[last])
        squares[last] = -np.inf  # whatever rounding says
        chosen[i] = squares.argmax()
    return chosen
