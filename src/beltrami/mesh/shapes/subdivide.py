"""Midpoint subdivision: each face becomes four, each edge gets a vertex."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel
from beltrami.errors import DegenerateFaceError, MeshError
from beltrami.mesh.half_edges import pair_sides
from beltrami.mesh.mesh import Mesh


def subdivide(mesh: Mesh, steps: int = 1) -> Mesh:
    """Cut each face into four at the midpoints of its sides, ``steps`` times.

    The old vertices keep their numbers; the children of face f are the faces 4f, 4f+1, 4f+2
    (at its corners 0, 1, 2) and 4f+3 (in the middle), oriented as f is. Functions on the
    vertices and the uv of the corners are interpolated linearly.

    Parameters
    ----------
    mesh
        Any triangle mesh, with boundary and non-manifold edges or not.
    steps
        How many times: m faces become 4^steps m.

    Raises
    ------
    MeshError
        If ``steps`` is negative.
    DegenerateFaceError
        If a face names a vertex twice.

    Notes
    -----
    Cost O(n + m) of the result.

    Examples
    --------
    >>> two = subdivide(Mesh([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]))
    >>> two.vertices.tolist()
    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.0, 0.5], [0.5, 0.5]]
    >>> two.faces.tolist()
    [[0, 3, 4], [3, 1, 5], [4, 5, 2], [5, 4, 3]]
    """
    if steps < 0:
        raise MeshError(f"steps is {steps} where 0 or more is needed")
    for _ in range(steps):
        faces, edges = split_faces(mesh.faces, mesh.n_vertices)
        data = {name: with_midpoints(values, edges) for name, values in mesh.vertex_data.items()}
        uv = None if mesh.corner_uv is None else _split_corners(mesh.corner_uv)
        mesh = Mesh(with_midpoints(mesh.vertices, edges), faces, data, uv)
    return mesh


def split_faces(faces: Integers, n: int) -> tuple[Integers, Integers]:
    """Return the faces (4m, 3), whose vertex n + e is on edge e, and those edges (p, 2)."""
    sides = pair_sides(faces, n)
    bad = np.flatnonzero((sides.face_edges < 0).any(axis=1))
    if len(bad):
        raise DegenerateFaceError(
            "faces that name a vertex twice cannot be subdivided",
            faces=bad,
            remedy="Drop them first.",
        )
    return _split(faces, sides.face_edges, n), sides.edges


def with_midpoints(values: NDArray[Any], edges: Integers) -> Floats:
    """Append the mean of both ends of each edge to values given at the vertices."""
    middle = values[edges[:, 0]] + values[edges[:, 1]]
    return np.concatenate([values, middle * 0.5])


def _split_corners(uv: Floats) -> Floats:
    a, b, c = uv.transpose(1, 0, 2)
    d, e, f = (b + c) / 2, (c + a) / 2, (a + b) / 2  # opposite the corners, as the sides are
    children = [[a, f, e], [f, b, d], [e, d, c], [d, e, f]]
    return np.stack([np.stack(child, axis=1) for child in children], axis=1).reshape(-1, 3, 2)


@kernel
def _split(faces: Any, face_edges: Any, n: int) -> Any:
    m = faces.shape[0]
    children = np.empty((4 * m, 3), np.int64)
    for f in range(m):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        d, e, g = n + face_edges[f, 0], n + face_edges[f, 1], n + face_edges[f, 2]
        children[4 * f, 0], children[4 * f, 1], children[4 * f, 2] = a, g, e
        children[4 * f + 1, 0], children[4 * f + 1, 1], children[4 * f + 1, 2] = g, b, d
        children[4 * f + 2, 0], children[4 * f + 2, 1], children[4 * f + 2, 2] = e, d, c
        children[4 * f + 3, 0], children[4 * f + 3, 1], children[4 * f + 3, 2] = d, e, g
    return children
