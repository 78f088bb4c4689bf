"""The z-buffer: which triangle is seen in each sample of the picture."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import kernel
from beltrami.display.triangles import Triangles

NOTHING = -1  # the background


class Visible(NamedTuple):
    """What each sample sees.

    Attributes
    ----------
    triangle : (h, w) int32
        The nearest triangle over the middle of the sample, or ``NOTHING``.
    nearness : (h, w) float32
        The nearness of ``Triangles`` there, 0 for the background.
    """

    triangle: NDArray[np.int32]
    nearness: NDArray[np.float32]


def visible_triangles(
    triangles: Triangles, size: tuple[int, int], hide_backs: bool = False
) -> Visible:
    """Find the nearest triangle in each sample; of two at the same depth, the first.

    A sample belongs to a triangle that covers its middle. A middle on a side shared by two
    triangles belongs to one of them, by the top-left rule in exact integers: no crack, and no
    sample twice. O(covered samples).

    Chapter items: P8.
    """
    width, height = size
    seen, nearness, _ = _cover(triangles.xy, triangles.nearness, width, height, hide_backs)
    return Visible(seen, nearness)


@kernel
def _cover(xy: Any, nearness: Any, width: int, height: int, hide_backs: bool) -> Any:
    """Draw all triangles; also count how often each sample was covered, hidden or not."""
    seen = np.full((height, width), -1, np.int32)
    nearest = np.zeros((height, width), np.float32)
    covered = 0
    for t in range(xy.shape[0]):
        ax, ay = xy[t, 0, 0], xy[t, 0, 1]
        bx, by = xy[t, 1, 0], xy[t, 1, 1]
        cx, cy = xy[t, 2, 0], xy[t, 2, 1]
        a, b, c = nearness[t, 0], nearness[t, 1], nearness[t, 2]
        area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        if area == 0 or (hide_backs and area > 0):
            continue
        if area < 0:  # y points downwards: this is the front of a face
            bx, by, b, cx, cy, c, area = cx, cy, c, bx, by, b, -area
        # the samples whose middles, at 128 mod 256, lie in the box around the triangle
        first = max((min(ax, min(bx, cx)) + 127) >> 8, 0)
        last = min((max(ax, max(bx, cx)) - 128) >> 8, width - 1)
        top = max((min(ay, min(by, cy)) + 127) >> 8, 0)
        bottom = min((max(ay, max(by, cy)) - 128) >> 8, height - 1)
        if first > last or top > bottom:
            continue
        px, py = (first << 8) + 128, (top << 8) + 128
        # the edge functions: > 0 inside; = 0 counts on left and top sides only
        row_a = (cx - bx) * (py - by) - (cy - by) * (px - bx)
        row_b = (ax - cx) * (py - cy) - (ay - cy) * (px - cx)
        row_c = (bx - ax) * (py - ay) - (by - ay) * (px - ax)
        over_a = 0 if cy < by or (cy == by and cx > bx) else 1
        over_b = 0 if ay < cy or (ay == cy and ax > cx) else 1
        over_c = 0 if by < ay or (by == ay and bx > ax) else 1
        right_a, right_b, right_c = (by - cy) << 8, (cy - ay) << 8, (ay - by) << 8
        down_a, down_b, down_c = (cx - bx) << 8, (ax - cx) << 8, (bx - ax) << 8
        for y in range(top, bottom + 1):
            ea, eb, ec = row_a, row_b, row_c
            for x in range(first, last + 1):
                if ea >= over_a and eb >= over_b and ec >= over_c:
                    covered += 1
                    near = np.float32((ea * a + eb * b + ec * c) / area)
                    if near > nearest[y, x]:
                        nearest[y, x] = near
                        seen[y, x] = t
                ea, eb, ec = ea + right_a, eb + right_b, ec + right_c
            row_a, row_b, row_c = row_a + down_a, row_b + down_b, row_c + down_c
    return seen, nearest, covered
