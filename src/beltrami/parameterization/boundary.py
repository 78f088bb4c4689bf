"""Boundary curves: where the loop of a disk goes, and whether the theorem allows it (E89)."""

from __future__ import annotations

import numbers
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, Integers, rectangular
from beltrami.errors import BoundaryCurveError, MeshError, check_name, shown
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.crossings import crossings
from beltrami.parameterization.predicates import orientation

Curve: TypeAlias = str | int | ArrayLike
CURVES = ("circle", "square")
SPACINGS = ("arclength", "uniform")
_LARGEST_BULGE = 0.1
_LEAST_STEP = 1e-6  # of the mean one: vertices at the same place do not stay there


def place_boundary(
    mesh: Mesh,
    loop: Integers,
    curve: Curve = "circle",
    *,
    spacing: str = "arclength",
    corners: ArrayLike | None = None,
    bulge: float = 0.0,
) -> Floats:
    r"""Return the (b, 2) positions :math:`\psi^0` of a boundary loop on a convex curve (l. 673).

    Chapter items: P73.

    Parameters
    ----------
    mesh
        The mesh, for the lengths of its edges.
    loop
        The b vertices of the loop in order.
    curve
        ``"circle"`` of radius 1 around 0, ``"square"`` [-1, 1]², a number of sides of a regular
        polygon in that circle, or the (k, 2) corners of a convex polygon, counter-clockwise.
    spacing
        ``"arclength"``: steps along the curve are as the edges (no edge less than 1e-6 of the
        mean, lest two vertices coincide); ``"uniform"``: all alike.
    corners
        The k vertices of the loop that go to the corners, in order; by default corners divide the
        loop as they divide the polygon, from the first vertex of the loop on.
    bulge
        Bend the sides outwards, by this part of their length in the middle: a little (0.01) makes
        the curve strictly convex, so that no edge can divide a side (E89).

    Raises
    ------
    BoundaryCurveError
        If the polygon is not convex and counter-clockwise, or has a corner twice; if a bulge is
        not from 0 to 0.1, or is given for a circle.
    MeshError
        If the corners are not vertices of the loop in its order, or outnumber them.
    UnknownNameError
        If there is no such curve or spacing.

    Examples
    --------
    >>> from beltrami.mesh.shapes import grid
    >>> mesh = grid(2, 2)
    >>> place_boundary(mesh, mesh.boundary_loops[0], "square", spacing="uniform")[:3].tolist()
    [[-1.0, -1.0], [0.0, -1.0], [1.0, -1.0]]
    """
    check_name("spacing", spacing, SPACINGS)
    ends = mesh.vertices[loop], mesh.vertices[np.roll(loop, -1)]
    steps = np.linalg.norm(ends[1] - ends[0], axis=1) if spacing == "arclength" else np.ones(1)
    steps = np.broadcast_to(steps, len(loop)) / (steps.max() or 1.0)
    steps = np.maximum(steps, _LEAST_STEP * (steps.mean() or 1.0))
    if isinstance(curve, str) and check_name("boundary curve", curve, CURVES) == "circle":
        if corners is not None:
            raise MeshError("a circle has no corners to place vertices at")
        if bulge != 0:
            raise BoundaryCurveError("a circle has no straight sides to bend by a bulge")
        turn = 2 * np.pi * (np.cumsum(steps) - steps) / steps.sum()
        return np.stack([np.cos(turn), np.sin(turn)], axis=1)
    if isinstance(curve, int | np.integer) and curve > len(loop):
        raise MeshError(f"a loop of {len(loop)} vertices cannot fill a polygon of {curve} corners")
    polygon = corners_of(curve)
    at = _corner_places(loop, steps, polygon, corners)
    if not (isinstance(bulge, numbers.Real) and 0 <= bulge <= _LARGEST_BULGE):
        raise BoundaryCurveError(f"a bulge is from 0 to {_LARGEST_BULGE}, not {shown(bulge)}")
    placed = _along(polygon, at, steps, bulge)
    if bulge > 0:
        require_convex(placed)
    return placed


def corners_of(curve: Curve) -> Floats:
    """Return the (k, 2) corners of a curve with straight sides, checked."""
    if isinstance(curve, str):
        return np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    if isinstance(curve, int | np.integer):
        if curve < 3:
            raise BoundaryCurveError(f"a polygon cannot have {curve} sides")
        turn = 2 * np.pi * np.arange(int(curve)) / int(curve)
        return np.stack([np.cos(turn), np.sin(turn)], axis=1)
    polygon = np.ascontiguousarray(rectangular(curve), dtype=np.float64)
    if polygon.ndim != 2 or polygon.shape[1] != 2 or len(polygon) < 3:
        raise BoundaryCurveError(
            f"a polygon has the shape {polygon.shape} where (k, 2), k >= 3 is needed"
        )
    if not np.isfinite(polygon).all():
        raise BoundaryCurveError("corners of the polygon are NaN or infinite")
    require_convex(polygon)
    return polygon


def require_convex(polygon: Floats) -> None:
    """Raise BoundaryCurveError unless every corner turns left and the sides go around once."""
    count = np.arange(len(polygon))
    turns = orientation(np.roll(polygon, 1, axis=0), polygon, np.roll(polygon, -1, axis=0))
    if (turns <= 0).any():
        raise BoundaryCurveError(
            "the polygon does not turn left at each of its corners, so it is not strictly convex "
            "and counter-clockwise, and the map would fold",
            vertices=count[turns <= 0],
        )
    met = crossings(polygon, np.stack([count, np.roll(count, -1)], axis=1))
    if len(met):
        raise BoundaryCurveError("the polygon crosses itself", vertices=np.unique(met))


def _corner_places(
    loop: Integers, steps: Floats, polygon: Floats, corners: ArrayLike | None
) -> Integers:
    """Return the places in the loop of the corners of the polygon, ascending but for one wrap."""
    k, b = len(polygon), len(loop)
    if b < k:
        raise MeshError(f"a loop of {b} vertices cannot fill a polygon of {k} corners")
    if corners is None:
        sides = np.linalg.norm(np.roll(polygon, -1, axis=0) - polygon, axis=1)
        ideal = (np.cumsum(sides) - sides) / sides.sum() * steps.sum()
        at = np.abs((np.cumsum(steps) - steps)[:, None] - ideal).argmin(axis=0)
        for q in range(1, k):  # each after the last, and room for those to come
            at[q] = min(max(at[q], at[q - 1] + 1), b - k + q)
        return np.asarray(at, dtype=np.int64)
    wanted = np.asarray(rectangular(corners)).ravel()
    if len(wanted) != k:
        raise MeshError(f"{len(wanted)} vertices for the {k} corners of the polygon")
    place = {int(v): q for q, v in enumerate(loop)}
    missing = [int(v) for v in wanted if int(v) not in place]
    if missing:
        raise MeshError("corners are not on the boundary loop", vertices=missing)
    at = np.array([place[int(v)] for v in wanted])
    gaps = np.diff(np.append(at, at[0])) % b
    if gaps.sum() != b or (gaps == 0).any():
        raise MeshError("the corners do not follow the order of the loop", vertices=wanted)
    return at


def _along(polygon: Floats, at: Integers, steps: Floats, bulge: float) -> Floats:
    """Divide each side, or the parabola on it, between its vertices."""
    b = len(steps)
    placed = np.empty((b, 2))
    for q in range(len(polygon)):
        own = (at[q] + np.arange((at[(q + 1) % len(at)] - at[q]) % b)) % b
        share = (np.cumsum(steps[own]) - steps[own]) / steps[own].sum()
        start, end = polygon[q], polygon[(q + 1) % len(polygon)]
        outwards = np.array([end[1] - start[1], start[0] - end[0]])
        height = 4 * bulge * share * (1 - share)
        placed[own] = (1 - share)[:, None] * start + share[:, None] * end
        placed[own] += height[:, None] * outwards
    return placed


def refuse_dividing_edges(
    mesh: Mesh, loop: Integers, placed: Floats, names: Integers | None = None
) -> None:
    """Raise BoundaryCurveError for inner edges with both ends on one straight side.

    The part of the disk that such an edge cuts off has all of its boundary on a line, so it gets
    no area (E89). Strictly convex curves have no straight side, and no such edges.

    Chapter items: T21.

    Raises
    ------
    BoundaryCurveError
        With the edges; their ends have the ``names``, (n,), of those vertices if these are given.
    """
    before, after = np.roll(placed, 1, axis=0), np.roll(placed, -1, axis=0)
    scale = np.abs(placed - before).sum(axis=1) * np.abs(after - placed).sum(axis=1)
    u, v = placed - before, after - placed
    is_corner = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) > 1e-12 * scale
    if not is_corner.any():
        is_corner[0] = True
    first = int(np.flatnonzero(is_corner)[0])
    side_after = np.roll(np.cumsum(np.roll(is_corner, -first)) - 1, first)
    count = int(side_after.max()) + 1
    side_before = np.where(is_corner, (side_after - 1) % count, side_after)
    sides = np.full((mesh.n_vertices, 2), -1)
    sides[loop] = np.stack([side_before, side_after], axis=1)
    inner = mesh.edges[mesh.topology.edge_face_count == 2]
    i, j = sides[inner].transpose(1, 0, 2)
    common = ((i[:, :, None] == j[:, None, :]) & (i[:, :, None] >= 0)).any(axis=(1, 2))
    if common.any():
        raise BoundaryCurveError(
            "inner edges have both ends on one straight side of the boundary curve, and what they "
            "cut off would get no area",
            edges=inner[common] if names is None else np.sort(names[inner[common]], axis=1),
            remedy='Take boundary="circle", bend the sides a little (bulge=0.01), or place corners '
            "between their ends.",
        )
