"""Lengths of the edges around vertices, and heights of faces."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats
from beltrami.mesh.mesh import Mesh


def lengths_around(mesh: Mesh, x: Floats) -> Floats:
    """Return the mean length of the edges at each vertex, of positions x (n, d); 0 without edges.

    Examples
    --------
    >>> strip = Mesh([[0, 0], [1, 0], [0, 3]], [[0, 1, 2]])
    >>> lengths_around(strip, strip.vertices)[0]
    np.float64(2.0)
    """
    i, j = mesh.edges.T
    lengths = np.linalg.norm(x[i] - x[j], axis=1)
    total = np.bincount(i, lengths, len(x)) + np.bincount(j, lengths, len(x))
    degrees = np.bincount(i, minlength=len(x)) + np.bincount(j, minlength=len(x))
    return np.asarray(total / np.maximum(degrees, 1))


def median_height(mesh: Mesh) -> float:
    """Return the median of the least heights of the faces; infinity, if none has an edge."""
    i, j, k = mesh.edge_lengths[mesh.topology.face_edges].T
    longest = np.maximum(np.maximum(i, j), k)
    kept = longest > 0
    if not kept.any():
        return np.inf
    return float(np.median(2 * mesh.face_areas[kept] / longest[kept]))
