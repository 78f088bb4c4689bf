"""Point location: which face of a planar mesh a point lies in, and where in it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel


@dataclass(frozen=True, eq=False, repr=False)
class Locator:
    """Triangles of the plane in a balanced tree of boxes; ``locator`` makes it.

    Attributes
    ----------
    tree : (2 l - 1, 2, 2)
        The lowest and the highest corner of each box; the children of k are 2 k + 1 and 2 k + 2.
    order : (l,) int
        The face of each leaf.
    corners : (m, 3, 2)
        The corners of the faces.
    """

    tree: Floats
    order: Integers
    corners: Floats

    def locate(self, points: Floats) -> tuple[Integers, Floats]:
        """Return the (q,) face that each point lies in, -1 outside, and (q, 3) coordinates in it.

        Of several faces, as for a point on a side, the one in which it lies deepest is taken;
        outside all it must be nearer than 1e-9 of a height. Coordinates are NaN outside. Cost:
        O(log m) for each point.
        """
        faces = np.empty(len(points), np.int64)
        inside = np.empty((len(points), 3))
        x = np.ascontiguousarray(points)
        _search(self.tree, self.order, self.corners, x, faces, inside)
        return faces, inside


def locator(corners: Floats) -> Locator:
    """Put faces into a tree of boxes, halved by the longer way of their middles.

    Tiny faces cost no more than large ones, as they would in a grid. Cost: O(m log² m).

    Parameters
    ----------
    corners
        (m, 3, 2) corners of the faces, counter-clockwise.

    Examples
    --------
    >>> square = np.array([[[0.0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]])
    >>> found = locator(square).locate(np.array([[0.75, 0.25], [2, 0]]))
    >>> found[0].tolist(), found[1][0].tolist()
    ([0, -1], [0.25, 0.5, 0.25])
    """
    order = _halved(corners.mean(axis=1))
    low, high = corners.min(axis=1)[order], corners.max(axis=1)[order]
    levels = [np.stack([low, high], axis=1)]
    while len(levels[-1]) > 1:
        boxes = levels[-1].reshape(-1, 2, 2, 2)
        levels.append(np.stack([boxes[:, :, 0].min(axis=1), boxes[:, :, 1].max(axis=1)], axis=1))
    return Locator(np.concatenate(levels[::-1]), order, np.ascontiguousarray(corners))


def _halved(middles: Floats) -> Integers:
    """Return the faces in the order of a tree, the last one repeated to a power of two."""
    count = len(middles)
    size = 1 << (count - 1).bit_length()
    order = np.minimum(np.arange(size), count - 1)
    block = size
    while block > 1:
        x = middles[order].reshape(-1, block, 2)
        wide = np.ptp(x, axis=1)
        along = np.where((wide[:, 0] >= wide[:, 1])[:, None], x[:, :, 0], x[:, :, 1])
        ranks = np.argsort(along, axis=1, kind="stable")
        order = np.take_along_axis(order.reshape(-1, block), ranks, axis=1).ravel()
        block //= 2
    return order


@kernel
def _search(tree: Any, order: Any, corners: Any, points: Any, faces: Any, inside: Any) -> None:
    """Walk down the tree for each point; keep the face in which it lies deepest."""
    leaves = order.shape[0]
    stack = np.empty(128, np.int64)
    for q in range(points.shape[0]):
        x, y = points[q, 0], points[q, 1]
        faces[q] = -1
        inside[q, :] = np.nan
        deepest = -1e-9
        depth, stack[0] = 1, 0
        while depth:
            depth -= 1
            node = stack[depth]
            wide, tall = tree[node, 1, 0] - tree[node, 0, 0], tree[node, 1, 1] - tree[node, 0, 1]
            slack = 1e-9 * (wide + tall)
            if (
                x < tree[node, 0, 0] - slack
                or x > tree[node, 1, 0] + slack
                or y < tree[node, 0, 1] - slack
                or y > tree[node, 1, 1] + slack
            ):
                continue
            if node < leaves - 1:
                stack[depth], stack[depth + 1] = 2 * node + 1, 2 * node + 2
                depth += 2
                continue
            f = order[node - leaves + 1]
            ux, uy = corners[f, 1, 0] - corners[f, 0, 0], corners[f, 1, 1] - corners[f, 0, 1]
            vx, vy = corners[f, 2, 0] - corners[f, 0, 0], corners[f, 2, 1] - corners[f, 0, 1]
            wx, wy = x - corners[f, 0, 0], y - corners[f, 0, 1]
            double = ux * vy - uy * vx
            if double == 0.0:
                continue
            second, third = (wx * vy - wy * vx) / double, (ux * wy - uy * wx) / double
            first = 1 - second - third
            least = min(first, second, third)
            if least > deepest:
                deepest = least
                faces[q] = f
                inside[q, 0], inside[q, 1], inside[q, 2] = first, second, third
