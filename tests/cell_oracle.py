"""Cells of Voronoi by clipping polygons with half planes, written from definitions 10 and 11.

Nothing here uses cotangents, circumcentres or incentres: a cell is what is left of a polygon
after each half plane of nearer points has been cut away.
"""

from __future__ import annotations

import numpy as np

UNIT_SQUARE = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])


def clip(polygon: np.ndarray, normal: np.ndarray, bound: float) -> np.ndarray:
    """Keep the part of a convex polygon where <x, normal> <= bound (Sutherland and Hodgman)."""
    if not len(polygon):
        return polygon
    height = polygon @ normal - bound
    kept = []
    for k in range(len(polygon)):
        a, b = height[k - 1], height[k]
        if (a <= 0) != (b <= 0):
            kept.append(polygon[k - 1] + (polygon[k] - polygon[k - 1]) * (a / (a - b)))
        if b <= 0:
            kept.append(polygon[k])
    return np.array(kept).reshape(-1, 2)


def area(polygon: np.ndarray) -> float:
    """Area by the shoelace formula; 0 for nothing."""
    if len(polygon) < 3:
        return 0.0
    x, y = (polygon - polygon[0]).T
    return float(np.roll(y, -1) @ x - np.roll(x, -1) @ y) / 2


def vertex_cells(points: np.ndarray, domain: np.ndarray = UNIT_SQUARE) -> list[np.ndarray]:
    """The points of a convex domain that are nearest to each point (definition 10)."""
    cells = []
    for i, x in enumerate(points):
        order = np.argsort(((points - x) ** 2).sum(axis=1))
        polygon = domain
        for j in order[order != i]:
            reach = np.linalg.norm(polygon - x, axis=1).max()
            if np.linalg.norm(points[j] - x) > 2 * reach:
                break  # all that follow are too far to cut
            normal = points[j] - x
            polygon = clip(polygon, normal, normal @ (points[j] + x) / 2)
        cells.append(polygon)
    return cells


def side_cells(corners: np.ndarray) -> np.ndarray:
    """Areas of the parts of a triangle nearest to the side opposite each corner.

    The corners go counter-clockwise. The distance to a side is linear inside, so two half planes
    cut each part (definition 11): from a point of a face the way to any other edge leads across
    a side of its own.
    """
    inward, offset = [], []
    for c in range(3):
        a, b = corners[(c + 1) % 3], corners[(c + 2) % 3]
        n = np.array([a[1] - b[1], b[0] - a[0]]) / np.linalg.norm(b - a)
        inward.append(n)
        offset.append(n @ a)
    parts = []
    for c in range(3):
        polygon = corners
        for d in ((c + 1) % 3, (c + 2) % 3):
            polygon = clip(polygon, inward[c] - inward[d], offset[c] - offset[d])
        parts.append(area(polygon))
    return np.array(parts)


def edge_cells(vertices: np.ndarray, faces: np.ndarray) -> dict[tuple[int, int], float]:
    """Areas of the parts of a planar mesh nearest to each of its edges (definition 11)."""
    cells: dict[tuple[int, int], float] = {}
    for face in faces:
        for c, part in enumerate(side_cells(vertices[face])):
            i, j = sorted((int(face[(c + 1) % 3]), int(face[(c + 2) % 3])))
            cells[i, j] = cells.get((i, j), 0.0) + part
    return cells
