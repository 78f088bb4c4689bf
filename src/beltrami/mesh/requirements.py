"""What an operation may ask of a topology: edges of two faces, a manifold, one orientation."""

from __future__ import annotations

from typing import TYPE_CHECKING

from beltrami.errors import NotManifoldError, NotOrientableError

if TYPE_CHECKING:  # the topology asks too
    from beltrami.mesh.topology import Topology

_SPLIT = "See repair(mesh, split_non_manifold=True)"


def require_edge_manifold(topology: Topology, problem: str, otherwise: str = "") -> None:
    """Raise NotManifoldError, with the edges, if some have more than two faces."""
    if not topology.is_edge_manifold:
        raise NotManifoldError(
            problem, edges=topology.non_manifold_edges, remedy=f"{_SPLIT}{otherwise}."
        )


def require_manifold(topology: Topology, problem: str) -> None:
    """Raise NotManifoldError, with vertices and edges, unless each link is a cycle or a path."""
    if not topology.is_manifold:
        raise NotManifoldError(
            problem,
            vertices=topology.non_manifold_vertices,
            edges=topology.non_manifold_edges,
            remedy=f"{_SPLIT}.",
        )


def require_oriented(topology: Topology, problem: str, one_sided: str) -> None:
    """Raise NotOrientableError, with the edges, if neighbours disagree on the outside.

    ``one_sided`` is the remedy where no choice of orientations is consistent.
    """
    if not topology.is_oriented:
        raise NotOrientableError(
            problem,
            edges=topology.inconsistent_edges,
            remedy="See repair(mesh, orient=True)." if topology.is_orientable else one_sided,
        )
