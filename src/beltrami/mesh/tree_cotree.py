"""Cuts that make disks of surfaces: tree and cotree (l. 657 of the chapter)."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import DROP, Booleans, Floats, Integers, read_only, require_finite
from beltrami._jit import kernel
from beltrami.errors import (
    DegenerateFaceError,
    EmptyMeshError,
    UnreferencedVertexError,
)
from beltrami.mesh.cut import Cut, cut_along, edges_between, shortest_paths
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.requirements import require_oriented
from beltrami.mesh.topology import Topology


def cut_to_disk(mesh: Mesh) -> Cut:
    """Cut a surface along edges so that each component becomes a disk.

    Any genus, closed or with any number of boundary loops. The cut is short, not the shortest: a
    tree of shortest paths from a point far away (from the boundary if there is one), and of the
    edges that then close a loop those that close the shortest ones (a greedy tree and cotree: J.
    Erickson, K. Whittlesey, Greedy optimal homotopy and homology generators, 2005). A sphere is
    cut along one path, as long as possible. Where the surface is not a manifold it is cut apart
    first. What is a disk is left as it is.

    Chapter items: P69.

    Raises
    ------
    EmptyMeshError, NonFiniteError, DegenerateFaceError, UnreferencedVertexError
        If the mesh has no faces, a coordinate is not finite, a face names a vertex twice, or a
        vertex is in no face.
    NotOrientableError
        If neighbouring faces disagree on the outside.

    Notes
    -----
    Cost: O(m log m).

    Examples
    --------
    >>> from beltrami.mesh.shapes import torus
    >>> cut = cut_to_disk(torus(12, 8))
    >>> cut.mesh.euler_characteristic, len(cut.mesh.boundary_loops), len(cut.edges)
    (1, 1, 20)
    """
    _require_cuttable(require_mesh(mesh, "a cut"))
    whole = cut_along(mesh, np.zeros(mesh.topology.n_edges, np.bool_))  # apart, if not a manifold
    chosen = _disk_edges(whole.mesh)
    if not chosen.any():
        return whole
    final = cut_along(whole.mesh, chosen)
    chain = whole.vertex_map
    edges = np.concatenate([whole.edges, np.sort(chain[final.edges], axis=1)])
    return Cut(final.mesh, read_only(chain[final.vertex_map]), read_only(edges))


def _require_cuttable(mesh: Mesh) -> None:
    topology = mesh.topology
    if not topology.n_faces:
        raise EmptyMeshError("the mesh has no faces")
    if not topology.half_edges.complete:
        raise DegenerateFaceError(
            "faces name a vertex twice",
            faces=np.flatnonzero(topology.face_edges[:, 0] < 0),
            remedy="Drop them with repair(mesh, remove_degenerate_faces=True).",
        )
    if not topology.referenced.all():
        raise UnreferencedVertexError(
            "vertices belong to no face",
            vertices=np.flatnonzero(~topology.referenced),
            remedy="Drop them with repair(mesh, remove_unreferenced=True).",
        )
    require_finite(mesh.vertices, "the mesh", DROP)
    require_oriented(
        topology,
        "neighbouring faces disagree on which side is outside",
        "The surface has one side only: no cut into one piece per component lays it out.",
    )


def _disk_edges(mesh: Mesh) -> Booleans:
    """Mark the edges of a manifold to be cut, so that each component becomes a disk."""
    topology = mesh.topology
    roots = _roots(mesh)
    distance, before = shortest_paths(mesh, roots)
    entries = _enter_loops_once(topology, before)
    in_tree = np.zeros(topology.n_edges, np.bool_)
    reached = np.flatnonzero(before >= 0)
    in_tree[edges_between(topology, reached, before[reached])] = True
    inner = topology.edge_face_count == 2
    i, j = topology.edges.T
    loop_length = distance[i] + distance[j] + mesh.edge_lengths
    candidates = np.flatnonzero(inner & ~in_tree)
    candidates = candidates[np.argsort(-loop_length[candidates], kind="stable")]
    crossed = _cotree(candidates, *_faces_of_edges(topology), topology.n_faces)
    closing = inner & ~in_tree
    closing[candidates[crossed]] = False
    bound = np.zeros(topology.n_vertices, np.bool_)
    bound[topology.boundary_edges.ravel()] = True
    marked = np.zeros(topology.n_vertices, np.bool_)  # whose way to the root is cut
    for v in [*topology.edges[closing].ravel(), *entries]:
        while before[v] >= 0 and not marked[v]:
            marked[v] = True
            v = before[v]
    on_way = np.flatnonzero(marked)
    chosen = closing
    chosen[edges_between(topology, on_way, before[on_way])] = True
    chosen = _pruned(topology, chosen & inner, bound)
    return _with_seams(topology, chosen, roots, distance, before)


def _roots(mesh: Mesh) -> Integers:
    """Return a vertex of each component: of its longest boundary, or far from everything."""
    topology = mesh.topology
    label = np.empty(topology.n_vertices, np.int64)
    label[topology.faces.ravel()] = np.repeat(topology.components(), 3)
    roots = np.full(int(label.max()) + 1, -1)
    for loop in reversed(topology.boundary_loops):  # the longest comes first, so it wins
        roots[label[loop[0]]] = loop[0]
    closed = np.flatnonzero(roots < 0)
    if len(closed):
        _, first = np.unique(label, return_index=True)
        distance, _ = shortest_paths(mesh, first[closed])
        for component in closed:
            own = np.flatnonzero(label == component)
            roots[component] = own[distance[own].argmax()]
    return roots


def _faces_of_edges(topology: Topology) -> tuple[Integers, Integers]:
    """Return the two faces of each edge; meaningless for others than inner edges."""
    sides = topology.face_edges.ravel()
    one, two = np.zeros(topology.n_edges, np.int64), np.zeros(topology.n_edges, np.int64)
    half = np.arange(len(sides))
    one[sides] = half // 3
    paired = topology.twins.ravel() >= 0
    two[sides[paired]] = topology.twins.ravel()[paired] // 3
    one[sides[paired]] = half[paired] // 3
    return one, two


def _enter_loops_once(topology: Topology, before: Integers) -> list[int]:
    """Let the tree end at the boundary, but for one way into each loop; return these ends.

    For the cut a loop is one point: paths of equal length may enter it at several vertices, and
    all but one of them would close a loop.
    """
    entries = []
    for loop in topology.boundary_loops:
        entered = loop[(before[loop] >= 0) & ~np.isin(before[loop], loop)][:1]
        way = before[entered]
        before[loop] = -1
        before[entered] = way
        entries += entered.tolist()
    return entries


def _pruned(topology: Topology, chosen: Booleans, bound: Booleans) -> Booleans:
    """Drop chosen edges with an end where nothing goes on, again and again."""
    chosen = chosen.copy()
    while True:
        ends = topology.edges[chosen]
        loose = (np.bincount(ends.ravel(), minlength=topology.n_vertices) == 1) & ~bound
        drop = loose[ends].any(axis=1)
        if not drop.any():
            return chosen
        chosen[np.flatnonzero(chosen)[drop]] = False


def _with_seams(
    topology: Topology, chosen: Booleans, roots: Integers, distance: Floats, before: Integers
) -> Booleans:
    """Add a path of at least two edges in each component that is still closed: a sphere."""
    label = np.empty(topology.n_vertices, np.int64)
    label[topology.faces.ravel()] = np.repeat(topology.components(), 3)
    has_cut = np.zeros(len(roots), np.bool_)
    has_cut[label[topology.edges[chosen].ravel()]] = True
    has_cut[label[topology.boundary_edges.ravel()]] = True
    for component in np.flatnonzero(~has_cut):
        own = np.flatnonzero(label == component)
        path = [int(own[distance[own].argmax()])]
        while before[path[-1]] >= 0:
            path.append(int(before[path[-1]]))
        if len(path) < 3:
            around = topology.ring(path[0])
            path.insert(0, int(around[~np.isin(around, path)][0]))
        chosen[edges_between(topology, np.array(path[1:]), np.array(path[:-1]))] = True
    return chosen


@kernel
def _cotree(candidates: Any, one: Any, two: Any, m: int) -> Any:
    """Say which edges, taken in order, join faces that are not joined yet (Kruskal)."""
    root = np.arange(m)
    joins = np.zeros(candidates.size, np.bool_)
    for q in range(candidates.size):
        a, b = one[candidates[q]], two[candidates[q]]
        while root[a] != a:
            root[a] = root[root[a]]
            a = root[a]
        while root[b] != b:
            root[b] = root[root[b]]
            b = root[b]
        if a != b:
            root[max(a, b)] = min(a, b)
            joins[q] = True
    return joins
