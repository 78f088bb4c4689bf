"""Distances along the edges: an upper bound, from scipy's algorithm of Dijkstra."""

from __future__ import annotations

import numpy as np
from scipy.sparse.csgraph import dijkstra

from beltrami._arrays import Floats, Integers
from beltrami.mesh.edge_matrix import symmetric_matrix
from beltrami.mesh.mesh import Mesh


def edge_distance(mesh: Mesh, sources: Integers) -> Floats:
    """Return the (n,) lengths of the shortest paths of edges from the nearest source.

    Never below the distance along the surface, and up to a constant factor above it however fine
    the mesh is. Vertices out of reach are at infinity. Cost: O(n log n).

    Examples
    --------
    >>> square = Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 3], [1, 2, 3]])
    >>> edge_distance(square, np.array([0])).tolist()
    [0.0, 1.0, 2.0, 1.0]
    """
    graph = symmetric_matrix(mesh.edges, mesh.edge_lengths, mesh.n_vertices)
    return np.asarray(dijkstra(graph, directed=True, indices=np.unique(sources), min_only=True))
