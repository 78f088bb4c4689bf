"""Geometry of the faces: areas, normals, angles, lengths (l. 62-107 of the chapter)."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel
from beltrami.errors import MeshError, check_name
from beltrami.mesh.triangle import is_flat, measure

NORMAL_WEIGHTS = ("uniform", "area", "angle")


def in_space(vertices: Floats, faces: Integers) -> tuple[Floats, Integers]:
    """Return positions in R³, and faces into them, with the same lengths.

    Planar meshes get z = 0. In more than three dimensions each face is laid into a plane of its
    own: the positions are then 3m corners that no two faces share.
    """
    n, d = vertices.shape
    if d == 3:
        return vertices, faces
    if d == 2:
        return np.concatenate([vertices, np.zeros((n, 1))], axis=1), faces
    with np.errstate(invalid="ignore", over="ignore"):  # what is not finite stays so
        return _laid_flat(vertices[faces])


def _laid_flat(corners: Floats) -> tuple[Floats, Integers]:
    """Lay each (3, d) triangle into a plane of its own, first side along x."""
    m = len(corners)
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    length = np.linalg.norm(u, axis=1)
    along = u / np.where(length > 0, length, 1)[:, None]
    x = (v * along).sum(axis=1)
    flat = np.zeros((m, 3, 3))
    flat[:, 1, 0] = length
    flat[:, 2, 0] = x
    flat[:, 2, 1] = np.linalg.norm(v - x[:, None] * along, axis=1)
    return flat.reshape(-1, 3), np.arange(3 * m).reshape(-1, 3)


def well_scaled(positions: Floats) -> tuple[Floats, float]:
    """Return positions whose fourth powers neither underflow nor overflow, and the unit.

    The unit is a power of two, so that nothing is rounded: positions = result * unit. It is 1
    but for meshes with coordinates beyond 1e-50 or 1e50.

    Raises
    ------
    MeshError
        If the coordinates are so large or small that an area is no number any more.
    """
    squares = float(np.vdot(positions, positions))
    if positions.size * 1e-100 < squares < 1e100:  # then so is the square of the largest
        return positions, 1.0
    largest = float(np.abs(positions).max(initial=0.0))
    if largest == 0 or 1e-50 < largest < 1e50 or not np.isfinite(largest):
        return positions, 1.0
    if not 1e-150 < largest < 1e150:
        raise MeshError(
            f"coordinates of {largest:.0e} leave no room for areas", remedy="Choose another unit."
        )
    unit = float(2.0 ** np.floor(np.log2(largest)))
    return positions / unit, unit


def face_vectors(vertices: Floats, faces: Integers) -> Floats:
    """Return (x_j - x_i) ∧ (x_k - x_i) of each face: twice its area along its normal."""
    return np.asarray(_face_vectors(*in_space(vertices, faces)))


def face_areas(vertices: Floats, faces: Integers) -> Floats:
    """Return the area of each face, in any dimension.

    Chapter items: U6.

    Examples
    --------
    >>> face_areas(np.array([[0.0, 0], [2, 0], [0, 1]]), np.array([[0, 1, 2]])).tolist()
    [1.0]
    """
    scaled, unit = well_scaled(vertices)
    vectors = face_vectors(scaled, faces)
    areas: Floats = np.sqrt(np.einsum("fc,fc->f", vectors, vectors)) / 2
    return areas if unit == 1 else areas * unit**2


def unit(vectors: Floats) -> Floats:
    """Divide each row (x, y, z) by its length; a zero row stays, and what is not finite so.

    Examples
    --------
    >>> unit(np.array([[3e-300, 0, 4e-300], [0, 0, 0]])).round(9).tolist()
    [[0.6, 0.0, 0.8], [0.0, 0.0, 0.0]]
    """
    out = np.empty(vectors.shape)
    _unit(vectors, out)
    return out


def corner_angles(vertices: Floats, faces: Integers) -> Floats:
    """Return the (m, 3) angles at the corners, in radians: exact also for needles.

    Chapter items: U12.

    Examples
    --------
    >>> right = corner_angles(np.array([[0.0, 0], [1, 0], [0, 1]]), np.array([[0, 1, 2]]))
    >>> np.degrees(right).round(9).tolist()
    [[90.0, 45.0, 45.0]]
    """
    return np.asarray(_corner_angles(*in_space(well_scaled(vertices)[0], faces)))


def vertex_normals(vertices: Floats, faces: Integers, weights: str) -> Floats:
    """Return the (n, 3) unit normals at the vertices: a weighted mean of those of the faces.

    ``"uniform"`` is the rule of the chapter (l. 105), ``"area"`` weighs by the area of each face
    and ``"angle"`` by its angle at the vertex, which alone does not depend on how a flat piece
    is cut into faces (E10). Where the mean vanishes, the normal is zero.

    Chapter items: U10.

    Raises
    ------
    UnknownNameError
        If ``weights`` is none of the three.
    """
    check_name("weights of normals", weights, NORMAL_WEIGHTS)
    positions, corners = in_space(well_scaled(vertices)[0], faces)
    vectors = np.asarray(_face_vectors(positions, corners))
    if weights != "area":
        vectors = unit(vectors)
    if weights == "angle":
        shares = np.asarray(_corner_angles(positions, corners))
    else:
        shares = np.ones(faces.shape)
    return unit(np.asarray(_gather(vectors, shares, faces, len(vertices))))


def degenerate_faces(vertices: Floats, faces: Integers) -> Integers:
    """Return the faces that name a vertex twice, or whose area vanishes beside their edges.

    The bound is area <= 1e-12 (longest edge)², so it does not depend on the unit of length.
    Faces with a coordinate that is not finite are not among them.
    """
    positions, corners = in_space(well_scaled(vertices)[0], faces)
    return np.flatnonzero(_degenerate(positions, corners, faces)).astype(np.int64)


@kernel
def _unit(vectors: Any, out: Any) -> None:
    """Divide first by the largest component, so that no square underflows."""
    for f in range(np.uint64(out.shape[0])):
        a, b, c = vectors[f, 0], vectors[f, 1], vectors[f, 2]
        scale = max(abs(a), abs(b), abs(c))
        if not scale > 0 or np.isnan(a) or np.isnan(b) or np.isnan(c):
            scale = 1.0
        a, b, c = a / scale, b / scale, c / scale
        length = np.sqrt(a * a + c * c + b * b)
        if not length > 0:
            length = 1.0
        out[f, 0], out[f, 1], out[f, 2] = a / length, b / length, c / length


@kernel
def _face_vectors(x: Any, faces: Any) -> Any:
    """Cross product of two sides of each face."""
    out = np.empty((faces.shape[0], 3))
    for f in range(faces.shape[0]):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        a, b, c = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], x[j, 2] - x[i, 2]
        d, e, g = x[k, 0] - x[i, 0], x[k, 1] - x[i, 1], x[k, 2] - x[i, 2]
        out[f, 0] = b * g - c * e
        out[f, 1] = c * d - a * g
        out[f, 2] = a * e - b * d
    return out


@kernel
def _corner_angles(x: Any, faces: Any) -> Any:
    """Angle = atan2(|u ∧ v|, <u, v>), precise near 0 and π as the arc cosine is not."""
    out = np.empty((faces.shape[0], 3))
    for f in range(faces.shape[0]):
        for c in range(3):
            i, j, k = faces[f, c], faces[f, (c + 1) % 3], faces[f, (c + 2) % 3]
            a, b, e = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], x[j, 2] - x[i, 2]
            p, q, r = x[k, 0] - x[i, 0], x[k, 1] - x[i, 1], x[k, 2] - x[i, 2]
            cross = np.sqrt((b * r - e * q) ** 2 + (e * p - a * r) ** 2 + (a * q - b * p) ** 2)
            out[f, c] = np.arctan2(cross, a * p + b * q + e * r)
    return out


@kernel
def _gather(vectors: Any, shares: Any, faces: Any, n: int) -> Any:
    """Sum share times vector of each face at its three vertices."""
    out = np.zeros((n, 3))
    for f in range(faces.shape[0]):
        for c in range(3):
            for x in range(3):
                out[faces[f, c], x] += shares[f, c] * vectors[f, x]
    return out


@kernel
def _degenerate(x: Any, corners: Any, faces: Any) -> Any:
    """Whether a face names a vertex twice, or is flat; false where something is not finite."""
    out = np.zeros(faces.shape[0], np.bool_)
    for f in range(faces.shape[0]):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        if i == j or j == k or k == i:
            out[f] = True
            continue
        at_i, at_j, at_k, double = measure(x, corners[f, 0], corners[f, 1], corners[f, 2])
        finite = np.isfinite(at_i + at_j + at_k)
        out[f] = finite and is_flat(at_i, at_j, at_k, double)
    return out
