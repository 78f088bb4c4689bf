"""Triangles on the screen: projected, cut where they leave the space that can be drawn."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Booleans, Floats, Integers
from beltrami._jit import kernel
from beltrami.display.camera import Camera

GRID = 256  # positions are rounded to 1/256 of a sample: the rule of coverage is then exact
_REACH = 2.0**19  # farthest coordinate, in samples, for which integer arithmetic cannot overflow
_NEAR = 1e-5  # nearest depth drawn, in parts of the greatest depth


class Triangles(NamedTuple):
    """What is left of the faces on the screen.

    Attributes
    ----------
    xy : (t, 3, 2) int
        Screen coordinates of the corners, in 1/256 of a sample, y downwards.
    nearness : (t, 3) float
        d / depth of the corners, d the greatest depth: this is linear on the screen.
    face : (t,) int
        The face that each triangle is a part of.
    borders : (t, 3) bool
        Whether the side opposite to each corner is a side of the face, not a cut.
    cut : (s, 3, 3) float
        For the last s triangles, those that were cut: barycentric coordinates, in their face,
        of each corner.
    """

    xy: Integers
    nearness: Floats
    face: Integers
    borders: Booleans
    cut: Floats

    def carry(self, corners: NDArray[Any]) -> Floats:
        """Values (t, 3, ...) at the corners, from those (m, 3, ...) at the corners of the faces."""
        values = np.asarray(corners, dtype=np.float64)[self.face]
        if len(self.cut):
            whole = len(self.face) - len(self.cut)
            values[whole:] = np.einsum("tcb,tb...->tc...", self.cut, values[whole:])
        return values


def project_faces(
    positions: Floats, faces: Integers, camera: Camera, size: tuple[int, int]
) -> Triangles:
    """Project the faces onto a screen of (width, height) samples.

    Faces behind the eye are dropped; those that cross the plane just before the eye, or reach
    so far off the screen that integers would overflow, are cut (Sutherland-Hodgman).
    """
    view = camera.view_coordinates(positions)
    focal = camera.focal_length(size)
    farthest = float(view[faces, 2].max(initial=0.0))
    near = _NEAR * farthest if farthest > 0 else 1.0  # nothing is in front of the eye
    reach = _REACH / focal  # |x| <= reach * depth is drawable
    planes = np.array([[0, 0, 1], [-1, 0, reach], [1, 0, reach], [0, -1, reach], [0, 1, reach]])
    offset = np.array([-near, 0.0, 0.0, 0.0, 0.0])
    outside = (view @ planes.T + offset < 0)[faces]  # (m, 3 corners, 5 planes)
    lost = outside.all(axis=1).any(axis=1)
    crossing = outside.any(axis=(1, 2)) & ~lost
    whole = np.flatnonzero(~lost & ~crossing)
    crossed = np.flatnonzero(crossing)
    source, cut, borders = _cut(view[faces[crossed]], planes, offset)
    corners = view[faces[np.concatenate([whole, crossed[source]])]]
    corners[len(whole) :] = np.einsum("tcb,tbx->tcx", cut, corners[len(whole) :])
    middle = np.array(size) / 2
    screen = middle + focal * corners[..., :2] * [1, -1] / corners[..., 2:]
    return Triangles(
        xy=np.rint(screen * GRID).astype(np.int64),
        nearness=farthest / corners[..., 2],
        face=np.concatenate([whole, crossed[source]]),
        borders=np.concatenate([np.ones((len(whole), 3), np.bool_), borders]),
        cut=cut,
    )


@kernel
def _cut(corners: Any, planes: Any, offset: Any) -> Any:
    """Cut each triangle by all planes; return its pieces in barycentric coordinates."""
    count = corners.shape[0]
    source = np.empty(6 * count, np.int64)  # a triangle cut by 5 planes has at most 8 corners
    pieces = np.empty((6 * count, 3, 3))
    borders = np.empty((6 * count, 3), np.bool_)
    old, new = np.empty((9, 3)), np.empty((9, 3))
    old_side, new_side = np.empty(9, np.bool_), np.empty(9, np.bool_)
    used = 0
    for t in range(count):
        k = 3
        old[:3] = np.eye(3)
        old_side[:3] = True  # side i runs from corner i to corner i + 1
        for p in range(planes.shape[0]):
            kept = 0
            for i in range(k):
                j = (i + 1) % k
                a = _height(old[i], corners[t], planes[p], offset[p])
                b = _height(old[j], corners[t], planes[p], offset[p])
                if a >= 0:
                    new[kept] = old[i]
                    new_side[kept] = old_side[i]
                    kept += 1
                if (a >= 0) != (b >= 0):
                    new[kept] = old[i] + (a / (a - b)) * (old[j] - old[i])
                    new_side[kept] = old_side[i] and b >= 0
                    kept += 1
            old, new = new, old
            old_side, new_side = new_side, old_side
            k = kept
        for i in range(1, k - 1):
            source[used] = t
            pieces[used, 0], pieces[used, 1], pieces[used, 2] = old[0], old[i], old[i + 1]
            borders[used, 0] = old_side[i]
            borders[used, 1] = old_side[k - 1] and i == k - 2
            borders[used, 2] = old_side[0] and i == 1
            used += 1
    return source[:used], pieces[:used], borders[:used]


@kernel
def _height(weights: Any, corners: Any, plane: Any, offset: float) -> Any:
    """Height above a plane of the point with these barycentric coordinates."""
    height = offset
    for c in range(3):
        for x in range(3):
            height += weights[c] * corners[c, x] * plane[x]
    return height
