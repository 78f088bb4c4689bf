"""At the door: a Mesh, or a Topology, and one clear line for anything else."""

from __future__ import annotations

from beltrami.errors import DimensionError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology

_REMEDY = (
    "as_mesh makes one of (vertices, faces) or of another library's mesh, read_mesh of a file."
)


def require_mesh(domain: object, what: str = "") -> Mesh:
    """Return the domain if it is a Mesh.

    Raises
    ------
    DimensionError
        If it is anything else; the line says what was given, and for ``what`` a Mesh is needed.

    Examples
    --------
    >>> require_mesh(([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]), "curvature")
    Traceback (most recent call last):
        ...
    beltrami.errors.DimensionError: a Mesh is needed for curvature, not an object of type tuple. ...
    """
    if isinstance(domain, Mesh):
        return domain
    wanted = f"a Mesh is needed for {what}" if what else "a Mesh is needed"
    if isinstance(domain, Topology):
        raise DimensionError(
            f"{wanted}: a Topology has no positions of the vertices",
            remedy="Give Mesh(vertices, topology).",
        )
    raise DimensionError(f"{wanted}, not {_said(domain)}", remedy=_REMEDY)


def topology_of(domain: object) -> Topology:
    """Return the topology of a Mesh, or the Topology that is given.

    Raises
    ------
    DimensionError
        If it is anything else.
    """
    if isinstance(domain, Mesh):
        return domain.topology
    if isinstance(domain, Topology):
        return domain
    raise DimensionError(f"a Mesh or a Topology is needed, not {_said(domain)}", remedy=_REMEDY)


def _said(thing: object) -> str:
    if isinstance(thing, type):
        return f"the class {thing.__name__}"
    return f"an object of type {type(thing).__name__}"
