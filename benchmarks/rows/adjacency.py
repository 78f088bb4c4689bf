"""Edges, twins, boundary and the manifold test, from the faces alone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.cases import Case
from benchmarks.claims import Contender, Goal, Row
from benchmarks.packages import package


def sorted_pairs(edges: NDArray[Any]) -> NDArray[Any]:
    """Write each edge with its smaller vertex first, in lexicographic order."""
    pairs = np.sort(np.asarray(edges), axis=1)
    return pairs[np.lexsort(pairs.T[::-1])]


def difference(a: NDArray[Any], b: NDArray[Any]) -> float:
    """How many edges are not the same."""
    if a.shape != b.shape:
        return float("inf")
    return float(np.count_nonzero((a != b).any(axis=1)))


def peer(name: str, run: Any, **keywords: Any) -> Contender:
    return Contender(name, run, canonical=sorted_pairs, tolerance=0, **keywords)


def contenders(case: Case) -> Sequence[Contender]:
    V, F = case.vertices, case.faces
    n = len(V)
    small = F.astype(np.int32)

    def ours(link_test: bool) -> NDArray[np.int64]:
        topology = package("beltrami.mesh.topology").Topology(F, n)
        manifold = topology.is_manifold if link_test else topology.is_edge_manifold
        twins, boundary = topology.twins, topology.boundary_edges
        if twins.shape != F.shape or not manifold or len(boundary):
            raise RuntimeError("the mesh is closed and manifold, and was not found so")
        return topology.edges

    def igl_all(_: None) -> NDArray[Any]:
        igl = package("igl")
        igl.triangle_triangle_adjacency(F)
        igl.is_edge_manifold(F)
        return igl.edges(F)

    def trimesh(_: None) -> NDArray[Any]:
        return package("trimesh").Trimesh(V, F, process=False).edges_unique

    return [
        peer("beltrami", lambda _: ours(link_test=False), ours=True),
        peer("beltrami, link test too", lambda _: ours(link_test=True), ours=True),
        peer("libigl, edges alone", lambda _: package("igl").edges(F)),
        peer("libigl, edges alone, 32-bit faces", lambda _: package("igl").edges(small)),
        peer("libigl, edges, neighbours, manifold test", igl_all),
        peer("trimesh, edges alone", trimesh),
        peer("potpourri3d, edges alone", lambda _: package("potpourri3d").edges(V, F)),
    ]


ADJACENCY = Row(
    name="adjacency",
    work="edges, twins, boundary and edge-manifold test, from the raw faces",
    contenders=contenders,
    goals=(Goal(0.2),),
    difference=difference,
    size=537_000,
    alone=True,
)
