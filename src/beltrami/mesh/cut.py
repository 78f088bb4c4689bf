"""Cut: a surface opened along edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import dijkstra

from beltrami._arrays import Booleans, Floats, Integers, read_only
from beltrami.mesh.edge_matrix import symmetric_matrix
from beltrami.mesh.fans import group_corners
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology

_FREE = 1e-9  # length of an edge of the boundary, over the longest: walking there costs nothing


@dataclass(frozen=True, eq=False, repr=False)
class Cut:
    """A surface cut open.

    Attributes
    ----------
    mesh
        The same faces in the same order. A vertex that the cut runs through has several copies:
        the first keeps its number, the others come at the end.
    vertex_map : (new n,) int
        The vertex of the input that each vertex is a copy of.
    edges : (q, 2) int
        The edges of the input that were cut.
    """

    mesh: Mesh
    vertex_map: Integers
    edges: Integers

    def __repr__(self) -> str:
        return f"<Cut: {len(self.edges)} edges, {self.mesh!r}>"


def cut_along(mesh: Mesh, chosen: Booleans) -> Cut:
    """Cut the edges that are marked, and those of more than two faces.

    An edge opens where a boundary begins at one of its ends or another cut edge goes on.

    Parameters
    ----------
    mesh
        The mesh.
    chosen
        (p,) bool, in the order of ``mesh.edges``.
    """
    topology = mesh.topology
    sides = topology.face_edges
    cut = chosen & (topology.edge_face_count == 2)
    twins = np.where((sides >= 0) & cut[sides], np.int32(-1), topology.twins)
    root = group_corners(topology.faces, twins, topology.n_vertices).root.reshape(-1, 3)
    n = topology.n_vertices
    fans, fan_of_corner = np.unique(root, return_inverse=True)
    origin = topology.faces.ravel()[fans]
    _, first = np.unique(origin, return_index=True)
    extra = np.ones(len(fans), np.bool_)
    extra[first] = False
    vertex_map = np.concatenate([np.arange(n), origin[extra]])
    edges = topology.edges[cut | (topology.edge_face_count > 2)]
    if not extra.any():
        return Cut(mesh, read_only(vertex_map), read_only(edges[:0]))
    number = np.where(extra, n + np.cumsum(extra) - 1, origin)
    data = {name: values[vertex_map] for name, values in mesh.vertex_data.items()}
    faces = number[fan_of_corner].reshape(-1, 3)
    opened = Mesh(mesh.vertices[vertex_map], faces, data, mesh.corner_uv)
    return Cut(opened, read_only(vertex_map), read_only(edges))


def shortest_paths(mesh: Mesh, sources: Integers) -> tuple[Floats, Integers]:
    """Return the (n,) distances along edges from the sources, and the vertex before each one.

    Edges of the boundary are nearly free.
    """
    lengths = np.maximum(mesh.edge_lengths, _FREE * mesh.edge_lengths.max())
    on_boundary = mesh.topology.edge_face_count == 1
    lengths = np.where(on_boundary, _FREE * lengths.max(), lengths)
    graph = symmetric_matrix(mesh.edges, lengths, mesh.n_vertices)
    distance, before, _ = dijkstra(
        graph, directed=True, indices=sources, min_only=True, return_predecessors=True
    )
    return np.asarray(distance), np.asarray(before, dtype=np.int64)


def edges_between(topology: Topology, i: Integers, j: Integers) -> Integers:
    """Return the numbers of the edges (i, j), which exist."""
    n, edges = topology.n_vertices, topology.edges
    keys = np.minimum(i, j) * n + np.maximum(i, j)
    return np.searchsorted(edges[:, 0] * n + edges[:, 1], keys)
