"""geodesic_distance: how far each vertex is from the nearest source, along the surface."""

from __future__ import annotations

from numpy.typing import ArrayLike

from beltrami._arrays import Floats
from beltrami._kinds import require_kind
from beltrami.errors import BeltramiError, check_name
from beltrami.geodesics.edge_paths import edge_distance
from beltrami.geodesics.exact import exact_distance
from beltrami.geodesics.heat_method import HeatMethod
from beltrami.geodesics.sources import checked_sources
from beltrami.mesh.mesh import Mesh
from beltrami.operators.soundness import refuse_unreferenced, require_sound

DISTANCE_METHODS = ("heat", "exact", "edges")


def geodesic_distance(
    mesh: Mesh,
    sources: ArrayLike,
    *,
    method: str = "heat",
    time: float | None = None,
    intrinsic: bool = True,
    boundary: str = "neumann",
) -> Floats:
    """Return the (n,) distances along the surface from the nearest source.

    Parameters
    ----------
    mesh
        A sound mesh, closed or open.
    sources
        One vertex, several, or a mask of n truth values.
    method
        ``"heat"``: approximate, two linear solves (see ``HeatMethod``, which keeps the
        factorisations for more than one set of sources). ``"exact"``: the length of the shortest
        path on the polyhedral surface, for some thousand vertices (see ``exact_distance``).
        ``"edges"``: the shortest path of edges, an upper bound.
    time, intrinsic, boundary
        Of the heat method alone. Without intrinsic triangles it is faster to prepare, and wrong
        by half near a source among obtuse faces.

    Returns
    -------
    (n,) float, in the unit of length; infinite at vertices that no source reaches.

    Raises
    ------
    MeshError
        If there are no sources, or they are not vertices; ``error.vertices`` lists them.
    EmptyMeshError, NonFiniteError, DegenerateFaceError, UnreferencedVertexError
        If the mesh is not sound.
    NotManifoldError
        With the exact method, if an edge has more than two faces.
    UnknownNameError, BeltramiError
        If a name is misspelt, or an option belongs to another method.

    Examples
    --------
    >>> from beltrami.mesh.shapes import cube
    >>> box = cube(4)  # 4 x 4 squares a side
    >>> corner = int(box.vertices.sum(axis=1).argmin())
    >>> far = int(box.vertices.sum(axis=1).argmax())
    >>> [round(float(geodesic_distance(box, corner, method=m)[far]), 3)
    ...  for m in ("exact", "edges", "heat")]
    [2.236, 2.414, 2.151]
    """
    check_name("method of distance", method, DISTANCE_METHODS)
    require_kind("intrinsic", intrinsic, ("bool",))
    if method == "heat":
        prepared = HeatMethod(mesh, time=time, intrinsic=intrinsic, boundary=boundary)
        return prepared.distance(sources)
    if time is not None or not intrinsic or str(boundary) != "neumann":
        raise BeltramiError(
            f"time, intrinsic and boundary belong to the heat method, not to {method!r}"
        )
    require_sound(mesh)
    if not mesh.topology.referenced.all():
        refuse_unreferenced(mesh.topology)
    places = checked_sources(sources, mesh.n_vertices)
    return exact_distance(mesh, places) if method == "exact" else edge_distance(mesh, places)
