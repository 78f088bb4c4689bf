"""Packing: charts side by side in a square, each in the hollows that those before it leave."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel
from beltrami.errors import MeshError

_CELLS = 1024  # of the grid along a side, at most: finer ones take longer and gain nothing
_ANGLES = 90  # that are tried to find the smallest box of a chart
_CLOSE = 1.005  # between a scale that fits and one that does not
_SMALLEST = 1e-3  # of the first scale tried: no chart is wider than a cell by then


class Outline(NamedTuple):
    """A chart to be packed: the ends (b, 2, 2) of its boundary edges, and all its points (k, 2)."""

    segments: Floats
    points: Floats


def pack(charts: Sequence[Outline], size: int, padding: int) -> list[Floats]:
    """Return the points of each chart in the unit square, turned, moved and scaled alike.

    Charts are turned into their smallest boxes and placed one after the other, the tallest first,
    as low as they come to lie on a horizon that each of them raises by its own upper outline; of
    the four ways around, the lowest is taken (Lévy, Petitjean, Ray, Maillot 2002). So a chart lies
    in the hollows of others, which boxes cannot. The scale is the largest that fits, to half a
    percent.

    Parameters
    ----------
    charts
        At least one.
    size
        Texels along a side of the square.
    padding
        Texels that are kept free around each chart: two of them are twice as far apart.

    Raises
    ------
    MeshError
        If so many charts do not fit even without extent.
    """
    unit = max(1, math.ceil(size / _CELLS))
    cells, margin = size // unit, math.ceil(padding / unit)
    boxed = [_in_smallest_box(chart) for chart in charts]
    order = sorted(range(len(boxed)), key=lambda k: -float(boxed[k].points[:, 1].max()))
    extents = np.array([chart.points.max(axis=0) for chart in boxed])
    above = cells / max(float(extents.max()), math.sqrt(float(_area(boxed))))
    least, scale = above * _SMALLEST, above
    best: tuple[float, list[tuple[int, int, int]]] | None = None
    while best is None or above / best[0] > _CLOSE:
        placed = _placed([boxed[k] for k in order], scale, cells, margin)
        if placed is None:
            above = scale
        else:
            best = scale, placed
        if best is None and scale < least:
            raise MeshError(
                f"{len(charts)} charts with a padding of {padding} do not fit into {size} texels",
                remedy="Give a larger size, less padding, or allow more distortion.",
            )
        scale = scale * 0.8 if best is None else math.sqrt(best[0] * above)
    at = dict(zip(order, best[1], strict=True))
    return [
        (_ways(chart.points)[at[k][2]] * best[0] + at[k][:2] + margin) / cells
        for k, chart in enumerate(boxed)
    ]


def _area(charts: Sequence[Outline]) -> float:
    """Return the area that the boundaries run around."""
    a, b = np.concatenate([chart.segments for chart in charts]).transpose(1, 0, 2)
    return max(abs(float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum())) / 2, 1e-300)


def _in_smallest_box(chart: Outline) -> Outline:
    """Turn a chart so that its box is small, and higher than wide; its lowest corner is 0."""
    ends = chart.segments.reshape(-1, 2)
    turns = np.pi / 2 * np.arange(_ANGLES) / _ANGLES
    frames = np.stack([np.cos(turns), np.sin(turns), -np.sin(turns), np.cos(turns)], axis=1)
    frames = frames.reshape(-1, 2, 2)
    boxes = np.stack([np.ptp(ends @ frame.T, axis=0) for frame in frames])
    best = int(boxes.prod(axis=1).argmin())
    frame = frames[best] if boxes[best, 0] <= boxes[best, 1] else [[0, -1], [1, 0]] @ frames[best]
    low = (ends @ frame.T).min(axis=0)
    return Outline(chart.segments @ frame.T - low, np.maximum(chart.points @ frame.T - low, 0))


def _ways(points: Floats) -> list[Floats]:
    """Return points, whose box begins at 0, in the four ways around."""
    x, y = points[..., 0], points[..., 1]
    right, top = x.max(), y.max()
    around = ((x, y), (y, right - x), (right - x, top - y), (top - y, x))
    return [np.stack(pair, axis=-1) for pair in around]


def _placed(
    charts: Sequence[Outline], scale: float, cells: int, margin: int
) -> list[tuple[int, int, int]] | None:
    """Return the column, the row and the way around of each chart, or None if one stands out."""
    horizon = np.zeros(cells, np.int64)
    found = []
    for chart in charts:
        tries = []
        for way, segments in enumerate(_ways(chart.segments)):
            wide = math.floor(segments[..., 0].max() * scale) + 1
            low, high = _outlines(segments * scale, wide, margin)
            if len(low) <= cells:
                tries.append((*_lowest(horizon, low, high), way, low, high))
        if not tries:
            return None
        top, _, row, column, way, low, high = min(tries, key=lambda one: one[:5])
        if top > cells:
            return None
        horizon[column : column + len(low)] = row + high
        found.append((column, row, way))
    return found


@kernel
def _outlines(segments: Any, wide: int, margin: int) -> Any:
    """Return the lowest row of each column and the row above the highest, margins included."""
    low = np.full(wide + 2 * margin, 1 << 40)
    high = np.full(wide + 2 * margin, -1)
    for s in range(segments.shape[0]):
        a, b = segments[s, 0], segments[s, 1]
        if a[0] > b[0]:
            a, b = b, a
        for k in range(int(a[0]), min(int(b[0]), wide - 1) + 1):
            y, z = a[1], b[1]
            if b[0] > a[0]:
                y = a[1] + min(max((k - a[0]) / (b[0] - a[0]), 0.0), 1.0) * (b[1] - a[1])
                z = a[1] + min(max((k + 1 - a[0]) / (b[0] - a[0]), 0.0), 1.0) * (b[1] - a[1])
            for q in range(k, k + 2 * margin + 1):
                low[q] = min(low[q], int(min(y, z)))
                high[q] = max(high[q], int(max(y, z)))
    return low, high + 1 + 2 * margin


@kernel
def _lowest(horizon: Any, low: Any, high: Any) -> Any:
    """Return where a chart ends lowest: (top, cells lost below it, row, column)."""
    best_top, best_lost, best_row, best_column = 1 << 60, 1 << 60, 0, 0
    for column in range(horizon.size - low.size + 1):
        row = 0
        for k in range(low.size):
            row = max(row, horizon[column + k] - low[k])
        top, lost = 0, 0
        for k in range(low.size):
            top = max(top, row + high[k])
            lost += row + low[k] - horizon[column + k]
        if top < best_top or (top == best_top and lost < best_lost):
            best_top, best_lost, best_row, best_column = top, lost, row, column
    return best_top, best_lost, best_row, best_column


def outline(points: Floats, edges: Integers) -> Outline:
    """Make a chart of its points and its boundary edges (b, 2)."""
    return Outline(points[edges], points)
