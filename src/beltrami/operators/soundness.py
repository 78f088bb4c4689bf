"""What an operator asks of a mesh before it starts: faces, finite numbers, no flat faces."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import DROP, Floats, require_finite
from beltrami.errors import (
    DegenerateFaceError,
    EmptyMeshError,
    MeshError,
    UnreferencedVertexError,
)
from beltrami.mesh.door import require_mesh
from beltrami.mesh.geometry import degenerate_faces
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology


def require_faces(topology: Topology) -> None:
    """Raise EmptyMeshError without faces, DegenerateFaceError if one names a vertex twice."""
    if not topology.n_faces:
        raise EmptyMeshError("the mesh has no faces")
    if not topology.half_edges.complete:
        raise DegenerateFaceError(
            "faces name a vertex twice",
            faces=np.flatnonzero(topology.face_edges[:, 0] < 0),
            remedy="Drop them with repair(mesh, remove_degenerate_faces=True).",
        )


def refuse_unreferenced(topology: Topology) -> None:
    """Raise UnreferencedVertexError with the vertices that belong to no face."""
    stray = np.flatnonzero(~topology.referenced)
    raise UnreferencedVertexError(
        f"{len(stray)} of {topology.n_vertices} vertices belong to no face",
        vertices=stray,
        remedy="Drop them with repair(mesh, remove_unreferenced=True).",
    )


def require_positions(mesh: Mesh) -> None:
    """Raise NonFiniteError, with the vertices, if a coordinate is NaN or infinite."""
    require_finite(mesh.vertices, "the mesh", DROP)


def refuse_flat_faces(mesh: Mesh) -> None:
    """Raise DegenerateFaceError with the faces that have no area."""
    raise DegenerateFaceError(
        "faces have no area (at most 1e-12 times their longest side squared)",
        faces=degenerate_faces(mesh.vertices, mesh.faces),
        remedy="Drop them with repair(mesh, remove_degenerate_faces=True).",
    )


def require_sound(mesh: Mesh) -> None:
    """Raise unless it is a Mesh with faces, finite coordinates and no flat face."""
    require_faces(require_mesh(mesh).topology)
    require_positions(mesh)
    if len(degenerate_faces(mesh.vertices, mesh.faces)):
        refuse_flat_faces(mesh)


def require_degrees(degrees: Floats) -> None:
    """Raise MeshError, with the vertices, unless D can be inverted."""
    if not (degrees > 0).all():
        raise MeshError(
            "vertices have no positive degree, so D cannot be inverted",
            vertices=np.flatnonzero(~(degrees > 0)),
            remedy='Leave them out of the graph; where D is but the mass, use mass="unit".',
        )
