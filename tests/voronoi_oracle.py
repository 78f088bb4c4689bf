"""Voronoi cells by scipy, for the areas that formulas claim to give."""

from __future__ import annotations

import numpy as np
from scipy.spatial import Voronoi


def clipped_cells(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Numbers and areas of the cells that lie inside the unit square."""
    diagram = Voronoi(points)
    areas = {}
    for i, region in enumerate(diagram.point_region):
        corners = diagram.regions[region]
        if -1 in corners:
            continue
        x = diagram.vertices[corners]
        if ((x > 0) & (x < 1)).all():
            angle = np.argsort(np.arctan2(*(x - x.mean(axis=0)).T))
            x, y = x[angle].T
            areas[i] = abs(x @ np.roll(y, 1) - y @ np.roll(x, 1)) / 2
    return np.array(list(areas)), np.array(list(areas.values()))
