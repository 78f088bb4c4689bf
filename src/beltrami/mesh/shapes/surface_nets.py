"""Surface nets: a grid of signs becomes a mesh with one vertex in each cell that has both."""

from __future__ import annotations

import itertools

import numpy as np

from beltrami._arrays import Booleans, Floats, Integers


def crossed_cells(inside: Booleans) -> Booleans:
    """Tell the cells (one fewer along each axis) whose eight corners are not all alike."""
    count = inside.astype(np.int8)
    for axis in range(3):
        count = np.take(count, range(count.shape[axis] - 1), axis) + np.take(
            count, range(1, count.shape[axis]), axis
        )
    return (count > 0) & (count < 8)


def well_composed(inside: Booleans) -> Booleans:
    """Add points until no square or cube of the grid has only opposite corners inside.

    The net of what remains is then a manifold: two sheets never share a cell vertex. The first
    plane of points along axis 1 is the mirror image of the second, and remains so.
    """
    inside = inside.copy()
    while True:
        before = np.count_nonzero(inside)
        for axes in ((0, 1), (0, 2), (1, 2), (0, 1, 2)):
            _fill_opposite(inside, axes)
        inside[:, 0] |= inside[:, 1]
        inside[:, 1] |= inside[:, 0]
        if np.count_nonzero(inside) == before:
            return inside


def _fill_opposite(inside: Booleans, axes: tuple[int, ...]) -> None:
    """Fill the squares (or cubes) in which one pair of opposite corners differs from all others."""
    corners = {}
    for bits in itertools.product((0, 1), repeat=len(axes)):
        window = [slice(None)] * 3
        for axis, bit in zip(axes, bits, strict=True):
            window[axis] = slice(1, None) if bit else slice(None, -1)
        corners[bits] = inside[tuple(window)]
    total = np.sum([corner.astype(np.int8) for corner in corners.values()], axis=0)
    bad = np.zeros(total.shape, dtype=bool)
    for bits, corner in corners.items():
        opposite = corners[tuple(1 - bit for bit in bits)]
        bad |= (total == 2) & corner & opposite
        bad |= (total == len(corners) - 2) & ~corner & ~opposite
    for corner in corners.values():
        corner |= bad


def net_vertices(values: Floats, crossed: Booleans) -> Floats:
    """Place one vertex in each crossed cell, at the mean of the zeros along the cell's edges.

    Parameters
    ----------
    values
        Shape (a, b, c): the function, negative inside.
    crossed
        Shape (a-1, b-1, c-1).

    Returns
    -------
    (n, 3) float
        In units of the grid, in the order of ``np.argwhere(crossed)``.
    """
    cells = np.argwhere(crossed)
    total = np.zeros((len(cells), 3))
    count = np.zeros(len(cells))
    offsets = np.stack(np.meshgrid((0, 1), (0, 1), (0, 1), indexing="ij"), axis=-1).reshape(8, 3)
    for axis in range(3):
        for start in offsets[offsets[:, axis] == 0]:
            low = cells + start
            high = low.copy()
            high[:, axis] += 1
            f, g = values[tuple(low.T)], values[tuple(high.T)]
            changes = (f < 0) != (g < 0)
            fraction = np.divide(f, f - g, out=np.zeros_like(f), where=changes)
            point = low.astype(np.float64)
            point[:, axis] += fraction
            total += np.where(changes[:, None], point, 0.0)
            count += changes
    return total / count[:, None]


def net_quads(inside: Booleans, crossed: Booleans) -> Integers:
    """Join the four cells around each grid edge whose ends differ, outward (counter-clockwise).

    Edges in the first and the last plane of points have not four cells, and are left out.

    Returns
    -------
    (q, 4) int
        Indices into ``net_vertices``.
    """
    number = np.full(crossed.shape, -1, dtype=np.int64)
    number[crossed] = np.arange(np.count_nonzero(crossed))
    quads = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        low = np.take(inside, range(inside.shape[axis] - 1), axis)
        high = np.take(inside, range(1, inside.shape[axis]), axis)
        differs = low != high
        at = np.argwhere(differs)
        full = np.ones(len(at), dtype=bool)
        for w in (u, v):  # a cell on either side in both directions
            full &= (at[:, w] > 0) & (at[:, w] < inside.shape[w] - 1)
        at = at[full]
        outward = low[tuple(at.T)]
        around = []
        for du, dv in ((-1, -1), (0, -1), (0, 0), (-1, 0)):
            cell = at.copy()
            cell[:, u] += du
            cell[:, v] += dv
            around.append(number[tuple(cell.T)])
        quad = np.stack(around, axis=1)
        quads.append(np.where(outward[:, None], quad, quad[:, ::-1]))
    return np.concatenate(quads)
