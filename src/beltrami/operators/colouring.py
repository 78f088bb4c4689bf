"""Colouring the vertices of a graph (definition 18)."""

from __future__ import annotations

from heapq import heapify, heappop, heappush
from typing import Any

import numpy as np
from scipy.sparse import coo_array, issparse

from beltrami._arrays import Integers
from beltrami._jit import kernel
from beltrami.errors import DimensionError, MeshError
from beltrami.mesh.connectivity import parity_colouring
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology


def colouring(graph: Mesh | Topology | Any) -> Integers:
    """Colour the vertices 0, 1, ... so that the ends of every edge differ (definition 18).

    With two colours wherever two suffice. Where they do not, greedily, in the smallest-last
    order (D. Matula and L. Beck, 1983): not always the least number, but at most six on a mesh
    that can be drawn in the plane, and seven on a torus, since there each part of the graph has
    a vertex with at most five, or six, neighbours. A mesh with a face needs three at least
    (E63). Cost: O((n + p) log n).

    Chapter items: D18, P7.

    Parameters
    ----------
    graph
        A mesh, a topology, or a symmetric sparse matrix whose entries, other than zero and off
        the diagonal, are the edges.

    Returns
    -------
    (n,) int; the first vertex has the colour 0 wherever two suffice.

    Raises
    ------
    MeshError
        If a matrix is not square, or its pattern not symmetric.
    DimensionError
        If it is no graph at all.

    Examples
    --------
    >>> from beltrami.mesh.shapes import tetrahedron
    >>> sorted(colouring(tetrahedron()).tolist())
    [0, 1, 2, 3]
    >>> from scipy.sparse import csr_array
    >>> path = csr_array([[0, 1, 0], [1, 0, 1], [0, 1, 0]])
    >>> colouring(path).tolist()
    [0, 1, 0]
    """
    edges, n = _edges_of(graph)
    two = parity_colouring(edges, np.ones(len(edges), np.bool_), n)
    if two is not None:
        return two.astype(np.int64)
    both = np.concatenate([edges, edges[:, ::-1]])
    order = np.lexsort((both[:, 1], both[:, 0]))
    starts = np.searchsorted(both[order, 0], np.arange(n + 1))
    return np.asarray(_smallest_last(starts, both[order, 1]), dtype=np.int64)


def _edges_of(graph: Any) -> tuple[Integers, int]:
    """Return the edges, once each, and the number of vertices."""
    if isinstance(graph, Mesh | Topology):
        return graph.edges, graph.n_vertices
    if not issparse(graph):
        raise DimensionError(
            f"an object of type {type(graph).__name__} is no graph",
            remedy="Give a Mesh, a Topology or a symmetric sparse matrix.",
        )
    given: Any = graph
    matrix = coo_array(given)
    n = matrix.shape[0]
    if matrix.shape != (n, n):
        raise MeshError(f"the matrix of a graph is square, and this is {matrix.shape}")
    matrix.sum_duplicates()
    i, j = (axis[matrix.data != 0].astype(np.int64) for axis in matrix.coords)
    up, down = i < j, i > j
    edges = np.stack([i[up], j[up]], axis=1)
    mirrored = np.stack([j[down], i[down]], axis=1)
    if not np.array_equal(np.unique(edges, axis=0), np.unique(mirrored, axis=0)):
        raise MeshError("the matrix of a graph is symmetric")
    return edges, n


@kernel
def _smallest_last(starts: Any, neighbours: Any) -> Any:
    """Take away, again and again, a vertex with the fewest neighbours left; colour backwards."""
    n = starts.size - 1
    left = starts[1:] - starts[:-1]
    heap = [(left[v], v) for v in range(n)]
    heapify(heap)
    gone = np.zeros(n, np.bool_)
    order = np.empty(n, np.int64)
    count = 0
    while count < n:
        _, v = heappop(heap)
        if gone[v]:
            continue  # an old entry: a newer one, with fewer neighbours, came out before
        gone[v] = True
        order[count] = v
        count += 1
        for q in range(starts[v], starts[v + 1]):
            w = neighbours[q]
            if not gone[w]:
                left[w] -= 1
                heappush(heap, (left[w], w))
    colour = np.full(n, -1)
    last_user = np.full(n + 1, -1)  # of each colour: the vertex that last saw it beside it
    for v in order[::-1]:
        for q in range(starts[v], starts[v + 1]):
            if colour[neighbours[q]] >= 0:
                last_user[colour[neighbours[q]]] = v
        free = 0
        while last_user[free] == v:
            free += 1
        colour[v] = free
    return colour
