"""Integrals over the surface, at the vertices or at the middles of the edges (section 3.2.3)."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_function
from beltrami.errors import BeltramiError, MeshError, check_name
from beltrami.mesh.mesh import Mesh
from beltrami.operators.areas import vertex_areas
from beltrami.operators.edge_areas import edge_areas

OfPositions: TypeAlias = Callable[[Floats], ArrayLike]
PLACES = ("vertex", "edge")


def integrate(
    mesh: Mesh, f: ArrayLike | OfPositions, how: str = "vertex", areas: str | None = None
) -> Floats:
    r"""Approximate :math:`\int f \approx \sum_i A_i f(x_i) \approx \sum_e A_e f(m_e)` (l. 226).

    Each edge counts once, at its middle m_e, and the areas add to that of the surface (E24).

    Chapter items: U14, P21.

    Parameters
    ----------
    mesh
        The surface.
    f
        (n,) or (n, c) values at the vertices, whose mean is taken at the middle of an edge; or a
        function of (q, d) positions that returns (q,) or (q, c) values.
    how
        ``"vertex"`` or ``"edge"``.
    areas
        A kind of ``vertex_areas``, by default ``"barycentric"``; or of ``edge_areas``, by default
        ``"circumcenter"``.

    Returns
    -------
    A number, or (c,) the integrals of the columns, in the unit of f times length².

    Raises
    ------
    UnknownNameError
        If there is no such way or kind of areas.
    DimensionError, NonFiniteError
        If f has the wrong shape, or values that are not finite.
    MeshError
        If f is a function that cannot be called with the positions.
    EmptyMeshError, NonFiniteError, DegenerateFaceError
        If the mesh is not sound.

    Notes
    -----
    The error is of second order in the lengths of the edges. Barycentric areas integrate a
    linear interpolant exactly; the other kinds do not (E24).

    Examples
    --------
    >>> from beltrami.mesh.shapes import grid
    >>> square = grid(9, 9)
    >>> float(integrate(square, square.vertices[:, 0]).round(12))
    0.5
    >>> float(integrate(square, lambda x: x[:, 0] ** 2, "edge").round(3))
    0.334
    """
    if check_name("way to integrate", how, PLACES) == "vertex":
        cells = vertex_areas(mesh, "barycentric" if areas is None else areas)
        values = _at(mesh.vertices, f) if callable(f) else as_function(f, mesh.n_vertices)
    else:
        cells = edge_areas(mesh, "circumcenter" if areas is None else areas)
        values = _at_middles(mesh, f)
    integrals: Floats = cells @ values  # a number where f has one column
    return integrals


def _at_middles(mesh: Mesh, f: ArrayLike | OfPositions) -> Floats:
    """Evaluate a function at the middles of the edges: values there are the mean of both ends."""
    i, j = mesh.edges.T
    if callable(f):
        return _at((mesh.vertices[i] + mesh.vertices[j]) / 2, f)
    at_vertices = as_function(f, mesh.n_vertices)
    return (at_vertices[i] + at_vertices[j]) / 2


def _at(positions: Floats, f: OfPositions) -> Floats:
    """Evaluate a function of positions, and check what it returns."""
    try:
        values = f(positions)
    except BeltramiError:
        raise
    except (TypeError, ValueError) as cause:
        raise MeshError(
            f"f cannot be called with positions of the shape {positions.shape}: {cause}",
            remedy="It gets all of them as one array: x[:, 0] is the first coordinate.",
        ) from cause
    return as_function(values, len(positions), "what the function returned")
