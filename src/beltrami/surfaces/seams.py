"""Sides of a rectangle that are one on the surface: seams, straight or flipped, and poles."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from beltrami._arrays import Floats, Integers
from beltrami.errors import SurfaceError
from beltrami.surfaces.domain import Rectangle

_CLOSES = 1e-7  # of the size of the surface: sides that differ by less are the same


def glue(points: Floats, parameters: Floats, domain: Rectangle, size: float) -> Integers:
    """Return the number, after gluing, of each vertex of a lattice over the rectangle.

    Periodic sides must meet, point by point, or point by point in the opposite order (Möbius's
    band, Klein's bottle). A side that is a single point is a pole.

    Parameters
    ----------
    points
        (rows, columns, k) points, v along the rows, u along the columns.
    parameters
        (rows, columns, 2) their u and v.
    size
        Of the surface: what differs by 1e-7 of it is the same.

    Returns
    -------
    (rows * columns,) int
        Numbers 0, 1, 2 ... in the order of the first of those that are glued.

    Raises
    ------
    SurfaceError
        If periodic sides do not meet; ``error.parameters`` lists where.
    """
    rows, columns = points.shape[:2]
    numbers = np.arange(rows * columns).reshape(rows, columns)
    pairs = [np.zeros((2, 0), dtype=np.int64)]
    for axis, around in ((1, domain.periodic[0]), (0, domain.periodic[1])):
        first, last = np.take(numbers, 0, axis), np.take(numbers, -1, axis)
        x = points.reshape(rows * columns, -1)
        if around:
            last = _partners(x, first, last, size, parameters.reshape(-1, 2))
            pairs.append(np.stack([first, last]))
        for side in (first, last):
            if np.abs(x[side] - x[side[0]]).max() <= _CLOSES * size:
                pairs.append(np.stack([np.full(len(side), side[0]), side]))
    i, j = np.concatenate(pairs, axis=1)
    graph = coo_array((np.ones(len(i)), (i, j)), shape=(numbers.size, numbers.size))
    labels = connected_components(graph, directed=False)[1]
    _, first_seen = np.unique(labels, return_index=True)
    rank = np.empty(len(first_seen), dtype=np.int64)
    rank[labels[np.sort(first_seen)]] = np.arange(len(first_seen))
    return np.asarray(rank[labels])


def _partners(
    x: Floats, first: Integers, last: Integers, size: float, parameters: Floats
) -> Integers:
    """Return the vertices of the last side in the order in which they meet the first."""
    gaps = [np.abs(x[first] - x[side]).max(axis=1) for side in (last, last[::-1])]
    for gap, side in zip(gaps, (last, last[::-1]), strict=True):
        if gap.max() <= _CLOSES * size:
            return side
    nearer = min(gaps, key=lambda gap: float(gap.max()))
    raise SurfaceError(
        f"the sides of a periodic parameter do not meet: they are up to {nearer.max():.3g} apart",
        parameters=parameters[first[nearer > _CLOSES * size]],
        remedy="Take exactly one period, or periodic=False there.",
    )
