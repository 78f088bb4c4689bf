"""Level sets of a function on the screen: their segments, and strokes of a constant width."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats
from beltrami._jit import kernel
from beltrami.display.raster import Visible
from beltrami.display.triangles import GRID, Triangles

_SLOPE = 4.0  # a line is in front of a surface that rises by less than this under the stroke


def level_lines(triangles: Triangles, values: Floats, level: float) -> Floats:
    """(s, 2, 3): the segments {f = level} in each triangle, as (x, y, nearness) of both ends.

    f is linear in each face of the surface, so its level sets are straight there and remain so
    on the screen. The crossing of a side is at t = f_i / (f_i - f_j) in space, which is
    t d_i / (t d_i + (1 - t) d_j) in the picture, d the nearness (``Triangles``). A face on which
    f is constant gives no segment; O(t).

    Chapter items: P52.

    Parameters
    ----------
    values
        (t, 3) values of f at the corners.
    """
    return np.asarray(_segments(triangles.xy, triangles.nearness, values - level))


def stroke(
    visible: Visible, lines: Iterable[Floats], width: float, focal: float
) -> NDArray[np.float32]:
    """(h, w): how much of each sample the lines cover, in [0, 1], where they are not hidden.

    A sample at the distance r from a segment is covered by clip(width / 2 + 1/2 - r, 0, 1):
    ends are round, so that segments join without a gap.

    Parameters
    ----------
    width, focal
        Of the stroke and of the camera, in samples.
    """
    cover = np.zeros(visible.nearness.shape, np.float32)
    tolerance = _SLOPE * (width / 2 + 1) / focal
    for segments in lines:
        _stroke(segments, visible.nearness, cover, width / 2, tolerance)
    return cover


@kernel
def _segments(xy: Any, nearness: Any, f: Any) -> Any:
    """Walk round each triangle; two of its sides change the sign, or none."""
    lines = np.empty((xy.shape[0], 2, 3))
    used = 0
    for t in range(xy.shape[0]):
        found = 0
        for i in range(3):
            j = (i + 1) % 3
            if (f[t, i] >= 0) == (f[t, j] >= 0):
                continue
            low, high = (i, j) if f[t, i] < 0 else (j, i)  # the neighbour finds the same point
            s = f[t, low] / (f[t, low] - f[t, high])
            near = (1 - s) / nearness[t, low] + s / nearness[t, high]  # the depth, so far
            s = s / nearness[t, high] / near
            for x in range(2):
                a, b = xy[t, low, x], xy[t, high, x]
                lines[used, found, x] = (a + s * (b - a)) / GRID
            lines[used, found, 2] = 1 / near
            found += 1
        if found == 2:
            dx = lines[used, 1, 0] - lines[used, 0, 0]
            dy = lines[used, 1, 1] - lines[used, 0, 1]
            if dx * dx + dy * dy > 0:  # f touches the level in one corner: no line
                used += 1
    return lines[:used]


@kernel
def _stroke(segments: Any, nearness: Any, cover: Any, radius: float, tolerance: float) -> None:
    """Stamp each segment onto the samples around it that see a surface no nearer than it."""
    height, width = nearness.shape
    for s in range(segments.shape[0]):
        ax, ay, a = segments[s, 0, 0], segments[s, 0, 1], segments[s, 0, 2]
        bx, by, b = segments[s, 1, 0], segments[s, 1, 1], segments[s, 1, 2]
        reach = radius + 1.0
        top = int(max(np.floor(min(ay, by) - reach), 0.0))
        bottom = int(min(np.ceil(max(ay, by) + reach), height - 1.0))
        dx, dy = bx - ax, by - ay
        square = dx * dx + dy * dy
        for y in range(top, bottom + 1):
            begin, end = 0.0, 1.0  # the part of the segment that comes near this row
            if dy != 0:
                above, below = (y + 0.5 - ay - reach) / dy, (y + 0.5 - ay + reach) / dy
                begin = min(max(min(above, below), 0.0), 1.0)
                end = min(max(max(above, below), 0.0), 1.0)
            left, right = ax + begin * dx, ax + end * dx
            first = int(max(np.floor(min(left, right) - reach), 0.0))
            last = int(min(np.ceil(max(left, right) + reach), width - 1.0))
            for x in range(first, last + 1):
                if nearness[y, x] == 0:
                    continue
                px, py = x + 0.5 - ax, y + 0.5 - ay
                t = min(max((px * dx + py * dy) / square, 0.0), 1.0)
                distance = np.sqrt((px - t * dx) ** 2 + (py - t * dy) ** 2)
                part = min(radius + 0.5 - distance, 1.0)
                if part > cover[y, x] and nearness[y, x] <= (a + t * (b - a)) * (1 + tolerance):
                    cover[y, x] = part
