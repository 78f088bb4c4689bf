"""Duplicates: vertices at the same place, faces with the same vertices."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from beltrami._arrays import Floats, Integers
from beltrami.mesh.connectivity import component_labels


def merge_targets(vertices: Floats, tolerance: float = 0.0) -> Integers:
    """Return, for each vertex, the first vertex at the same place (often itself).

    With a tolerance, vertices closer than ``tolerance`` times the diagonal of the bounding box
    are at the same place, and so are chains of such vertices. -0.0 equals 0.0; a vertex with a
    coordinate that is not finite equals none. Cost: O(n log n).

    Examples
    --------
    >>> merge_targets(np.array([[0.0, 1], [2, 3], [-0.0, 1]])).tolist()
    [0, 1, 0]
    """
    n = len(vertices)
    targets = np.arange(n)
    finite = np.flatnonzero(np.isfinite(vertices).all(axis=1))
    points = vertices[finite] + 0.0  # -0.0 becomes 0.0
    if not len(points):
        return targets
    if tolerance > 0:
        points = points / max(float(np.abs(points).max()), np.finfo(float).tiny)
        reach = tolerance * float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))
        pairs = cKDTree(points).query_pairs(reach, output_type="ndarray")
        labels = component_labels(pairs, len(points))
    else:
        labels = _rows_alike(points)
    first = np.full(int(labels.max()) + 1, n)
    np.minimum.at(first, labels, finite)
    targets[finite] = first[labels]
    return targets


def duplicate_vertices(vertices: Floats) -> Integers:
    """Return the vertices with exactly the coordinates of an earlier one."""
    return np.flatnonzero(merge_targets(vertices) != np.arange(len(vertices)))


def duplicate_faces(faces: Integers) -> Integers:
    """Return the faces with the same three vertices as an earlier face, in whatever order.

    Examples
    --------
    >>> duplicate_faces(np.array([[0, 1, 2], [0, 1, 3], [2, 1, 0]])).tolist()
    [2]
    """
    if not len(faces):
        return np.zeros(0, np.int64)
    labels = _rows_alike(np.sort(faces, axis=1))
    repeated = np.ones(len(faces), np.bool_)
    repeated[np.unique(labels, return_index=True)[1]] = False
    return np.flatnonzero(repeated)


def _rows_alike(rows: Floats | Integers) -> Integers:
    """Label equal rows with equal numbers, by sorting."""
    order = np.lexsort(rows.T[::-1])
    ordered = rows[order]
    new = np.ones(len(rows), np.bool_)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    labels = np.empty(len(rows), np.int64)
    labels[order] = np.cumsum(new) - 1
    return labels
