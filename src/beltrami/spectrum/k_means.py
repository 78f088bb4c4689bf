"""k-means of weighted points, seeded: k-means++ (Arthur, Vassilvitskii 2007), then Lloyd."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami.errors import ConvergenceError

_ROUNDS = 1000
_ROUNDING = 1e-12  # a smaller decrease may go on forever among equal points
_STARTS = 8  # the best of as many is taken


def k_means(points: Floats, weights: Floats, count: int, seed: int) -> tuple[Integers, float]:
    r"""Part points (n, d) into clusters of small :math:`\sum_x w_x |x - c(x)|^2`.

    The best of eight runs, each from centres drawn with the probability of their weighted squared
    distance to those before. Every cluster has a point if there are ``count`` distinct ones; then
    the same seed gives the same bits.

    Returns
    -------
    labels (n,) in the order of the first point of each cluster, and the sum.

    Raises
    ------
    ConvergenceError
        If the centres still move after 1000 rounds.
    """
    rng = np.random.default_rng(seed)
    runs = [_lloyd(points, weights, _start(points, weights, count, rng)) for _ in range(_STARTS)]
    labels, total = min(runs, key=lambda run: run[1])
    return in_order_of_appearance(labels), total


def in_order_of_appearance(labels: Integers) -> Integers:
    """Call the label of the first vertex 0, the next new one 1, and so on.

    Examples
    --------
    >>> in_order_of_appearance(np.array([7, 2, 7, 5])).tolist()
    [0, 1, 0, 2]
    """
    _, first, inverse = np.unique(labels, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.int64)
    rank[np.argsort(first)] = np.arange(len(first))
    return rank[inverse.ravel()]


def _start(points: Floats, weights: Floats, count: int, rng: np.random.Generator) -> Floats:
    """Draw centres among the points by k-means++."""
    chosen = [int(rng.choice(len(points), p=weights / weights.sum()))]
    squares = np.full(len(points), np.inf)
    for _ in range(count - 1):
        squares = np.minimum(squares, ((points - points[chosen[-1]]) ** 2).sum(axis=1))
        chance = weights * squares
        total = chance.sum()
        if not total > 0:  # all points are centres
            break
        chosen.append(int(rng.choice(len(points), p=chance / total)))
    return points[chosen]


def _lloyd(points: Floats, weights: Floats, centres: Floats) -> tuple[Integers, float]:
    """Move each centre to the mean of its cluster while the sum decreases."""
    from scipy.spatial.distance import cdist  # slow to load

    labels, total = np.full(len(points), -1, np.int64), np.inf
    for _ in range(_ROUNDS):
        squares = cdist(points, centres, "sqeuclidean")
        nearest = squares.argmin(axis=1)
        before, total = total, float(weights @ squares[np.arange(len(points)), nearest])
        if np.array_equal(nearest, labels) or total >= before * (1 - _ROUNDING):
            return nearest, total
        labels = nearest
        for label in np.unique(labels):
            mine = labels == label
            centres[label] = weights[mine] @ points[mine] / weights[mine].sum()
    raise ConvergenceError(f"k-means did not come to rest in {_ROUNDS} rounds")
