"""Maps to the plane in a page: one that is made for it, and the texture coordinates of a mesh."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami.display.page_codes import Sections, guesses_of, quantized
from beltrami.display.page_order import Order
from beltrami.errors import BeltramiError, MeshError
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.distortion import Distortion, measured
from beltrami.parameterization.parameterize import parameterize

OWN = "own "  # begins the names of the sections of the coordinates that a mesh has
MOST_PICTURES = 4096  # that texture coordinates may cover: single floats then tell 1/4096 of one
_FLAT = 1 / 8192  # of the width of a map, or of a picture: the steps of the coordinates


def made_map(sections: Sections, mesh: Mesh, order: Order) -> dict[str, Any]:
    """Append a map to the plane, or return why there is none."""
    try:
        found = parameterize(mesh)
    except BeltramiError as error:
        return {"reason": str(error)}
    corners = found.mesh.faces.ravel()[order.corners]
    step = float(np.ptp(found.uv, axis=0).max()) * _FLAT
    origin = found.uv.min(axis=0)
    _add(sections, "", order, corners, found.vertex_map, (found.uv - origin, step))
    return {
        "method": found.method,
        "bijective": found.is_bijective,
        "flipped": len(found.flipped),
        "cut": len(found.cut_edges),
        "step": step,
        "origin": origin.tolist(),
        **_told(found.distortion),
    }


def own_coordinates(mesh: Mesh) -> Floats | None:
    """(m, 3, 2) texture coordinates of a mesh, NaN in all of a face where one is not known.

    None if there are none.

    Raises
    ------
    MeshError
        If they spread over more pictures than the page can tell.
    """
    if mesh.corner_uv is None:
        return None
    known = np.asarray(np.isfinite(mesh.corner_uv).all(axis=(1, 2)))
    if not known.any():
        return None
    uv = mesh.corner_uv[known]
    with np.errstate(over="ignore"):
        extent = float((uv.max(axis=(0, 1)) - uv.min(axis=(0, 1))).max())
    if extent > MOST_PICTURES:
        raise MeshError(
            f"texture coordinates spread over {extent:.3g} pictures, where a page can tell "
            f"{MOST_PICTURES}",
            remedy="Map the mesh anew: parameterize(mesh).textured or atlas(mesh).mesh.",
        )
    return np.where(known[:, None, None], mesh.corner_uv, np.nan)


def own_map(sections: Sections, mesh: Mesh, order: Order, corner_uv: Floats) -> dict[str, Any]:
    """Append ``own_coordinates`` as a map of the faces that have some."""
    known = np.isfinite(corner_uv[:, 0, 0])
    given = corner_uv[known]
    origin = given.min(axis=(0, 1))
    extent = float((given - origin).max())
    uv = np.zeros_like(corner_uv)
    uv[known] = given - origin
    has = np.repeat(known, 3)
    keys = np.column_stack([mesh.faces.ravel(), has, uv.reshape(-1, 2)])
    rows, inverse = np.unique(keys, axis=0, return_inverse=True)
    number, x = inverse.ravel(), np.asarray(rows[:, 2:], np.float64)
    vertex_map, bare = rows[:, 0].astype(np.int64), rows[:, 1] == 0
    step = min(extent, 1.0) * _FLAT
    places = _add(sections, OWN, order, number[order.corners], vertex_map, (x, step))
    sections.add(OWN + "bare", np.diff(np.sort(places[bare]), prepend=0)[:, None])
    cut = Mesh(mesh.vertices[vertex_map], number.reshape(-1, 3)[known])
    return {
        **_certified(cut, x),
        "method": "",
        "cut": cut.topology.n_edges - Mesh(mesh.vertices, mesh.faces[known]).topology.n_edges,
        "without": int((~known).sum()),
        "step": step,
        "origin": (origin - np.floor(origin)).tolist(),  # pictures go on periodically
        **_told(measured(cut, x)),
    }


def _certified(cut: Mesh, uv: Floats) -> dict[str, Any]:
    """Decide whether texture coordinates are a bijection, or say why that cannot be decided."""
    try:
        certificate = certify(cut.topology, uv)
    except BeltramiError as error:
        return {"bijective": False, "flipped": 0, "undecided": str(error)}
    return {"bijective": certificate.is_bijective, "flipped": len(certificate.flipped)}


def _told(distortion: Distortion) -> dict[str, float | None]:
    """Return means of the distortion; None where a face without area makes one infinite."""
    found = {
        "conformal": distortion.mean_conformal,
        "area": distortion.mean_area,
        "dirichlet": distortion.symmetric_dirichlet,
    }
    return {name: value if math.isfinite(value) else None for name, value in found.items()}


def _add(
    sections: Sections,
    prefix: str,
    order: Order,
    corners: Integers,
    vertex_map: Integers,
    uv: tuple[Floats, float],
) -> Integers:
    """Append a cut mesh and its coordinates (from 0 on, and their step).

    ``corners`` are the vertices of the cut mesh in the faces of the page, ``vertex_map`` the
    vertices of the mesh. Returns the number of each vertex of the cut mesh in the page.
    """
    n = len(order.vertices)
    number = _numbers(vertex_map, order)
    faces = number[corners].reshape(-1, 3)
    changed = np.flatnonzero(faces.ravel() != order.faces.ravel())
    copy_of = np.empty(len(number), np.int64)
    copy_of[faces.ravel()] = order.faces.ravel()
    sections.add(prefix + "seam corners", np.diff(changed, prepend=0)[:, None])
    sections.add(prefix + "seam vertices", np.diff(faces.ravel()[changed], prepend=0)[:, None])
    sections.add(prefix + "seam copies", np.diff(copy_of[n:], prepend=0)[:, None])
    values, step = uv
    ordered = np.empty_like(values)
    ordered[number] = values
    levels = quantized(ordered, np.full(2, step))
    sections.add(prefix + "plane", guesses_of(faces, len(number)).residuals(levels))
    return number


def _numbers(vertex_map: Integers, order: Order) -> Integers:
    """Give each vertex of a cut mesh a number, the first copy of one that of the original."""
    n = len(order.vertices)
    page = np.empty(n, np.int64)
    page[order.vertices] = np.arange(n)
    original = page[vertex_map]
    firsts = np.unique(original, return_index=True)[1]
    extra = np.setdiff1d(np.arange(len(original)), firsts)
    number = original.copy()
    number[extra] = n + np.arange(len(extra))
    return np.asarray(number)
