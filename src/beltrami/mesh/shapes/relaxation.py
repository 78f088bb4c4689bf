"""Better triangles with the same vertices: edge flips and tangential relaxation."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Booleans, Floats, Integers
from beltrami.mesh.face_pairs import pair_faces
from beltrami.mesh.half_edges import pair_sides


def split_quads(vertices: Floats, quads: Integers) -> Integers:
    """Cut each quadrilateral along its shorter diagonal; (2q, 3)."""
    a, b, c, d = vertices[quads].transpose(1, 0, 2)
    along_ac = ((a - c) ** 2).sum(axis=1) <= ((b - d) ** 2).sum(axis=1)
    halves = np.where(
        along_ac[:, None, None],
        quads[:, [[0, 1, 2], [0, 2, 3]]],
        quads[:, [[1, 2, 3], [1, 3, 0]]],
    )
    return halves.reshape(-1, 3)


def flip_edges(vertices: Floats, faces: Integers, fixed: Booleans, passes: int = 20) -> Integers:
    """Flip edges until the two angles opposite each add up to at most pi (Delaunay).

    No flip makes an edge between two ``fixed`` vertices, a second copy of an edge, or folds
    the surface. Each pass flips edges that have no face in common, the worst ones first.
    """
    faces = faces.copy()
    for _ in range(passes):
        if not _flip_once(vertices, faces, fixed):
            break
    return faces


def _flip_once(vertices: Floats, faces: Integers, fixed: Booleans) -> int:
    n = len(vertices)
    sides = pair_sides(faces, n)
    h, g, _ = pairs = pair_faces(faces, sides.twins)
    f, e = pairs.faces.T
    top, left, right = (faces[f, (h + s) % 3] for s in (0, 1, 2))  # the edge runs left to right
    bottom = faces[e, g % 3]
    excess = _angle(vertices, top, left, right) + _angle(vertices, bottom, right, left) - np.pi
    keys = np.minimum(top, bottom) * n + np.maximum(top, bottom)
    taken = np.isin(keys, sides.edges[:, 0] * n + sides.edges[:, 1])
    wanted = (excess > 1e-9) & ~taken & ~(fixed[top] & fixed[bottom])
    wanted &= _stays_flat(vertices, top, left, bottom, right)
    gain = np.where(wanted, excess, 0.0)
    best = np.zeros(len(faces))
    np.maximum.at(best, f, gain)
    np.maximum.at(best, e, gain)
    chosen = np.flatnonzero(wanted & (gain == best[f]) & (gain == best[e]))
    _, first = np.unique(keys[chosen], return_index=True)
    chosen = chosen[np.sort(first)]
    _, seen_f = np.unique(np.concatenate([f[chosen], e[chosen]]), return_index=True)
    if len(seen_f) < 2 * len(chosen):  # equal gains around one face: let the next pass decide
        chosen = chosen[:1]
    faces[f[chosen]] = np.stack([top, left, bottom], axis=1)[chosen]
    faces[e[chosen]] = np.stack([top, bottom, right], axis=1)[chosen]
    return len(chosen)


def _angle(vertices: Floats, at: Integers, one: Integers, two: Integers) -> Floats:
    u, v = vertices[one] - vertices[at], vertices[two] - vertices[at]
    return np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(axis=1))


def _stays_flat(
    vertices: Floats, top: Integers, left: Integers, bottom: Integers, right: Integers
) -> Booleans:
    """Whether the two new faces look the same way as the two old ones together."""
    x, y, z, w = vertices[top], vertices[left], vertices[bottom], vertices[right]
    one, two = np.cross(y - x, z - x), np.cross(z - x, w - x)
    old = np.cross(y - x, w - x) + np.cross(w - z, y - z)
    return ((one * old).sum(axis=1) > 0) & ((two * old).sum(axis=1) > 0)


def relax(vertices: Floats, faces: Integers, bound: Booleans) -> Floats:
    """Move each vertex, within its tangent plane, half way to the mean of its neighbours.

    Vertices in ``bound`` (on the plane y = 0) average over their ``bound`` neighbours only: they
    slide along the curve in which the surface meets the plane.
    """
    n = len(vertices)
    edges = pair_sides(faces, n).edges
    i, j = np.concatenate([edges, edges[:, ::-1]]).T
    used = ~bound[i] | bound[j]
    i, j = i[used], j[used]
    count = np.bincount(i, minlength=n)
    mean = np.stack([np.bincount(i, vertices[j, c], n) for c in range(3)], axis=1)
    move = mean / np.maximum(count, 1)[:, None] - vertices
    # the normals of the mesh, not of the field: at a rim thinner than a triangle the field's
    # own normal lets the vertices slide off the rim
    a, b, c = vertices[faces].transpose(1, 0, 2)
    across = np.repeat(np.cross(b - a, c - a), 3, axis=0)
    normals = np.stack([np.bincount(faces.ravel(), across[:, k], n) for k in range(3)], axis=1)
    normals[bound, 1] = 0.0
    size = np.maximum((normals * normals).sum(axis=1), 1e-300)
    move -= ((move * normals).sum(axis=1) / size)[:, None] * normals
    return vertices + 0.5 * move
