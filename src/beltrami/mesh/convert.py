"""From the objects of other libraries to a mesh."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami.errors import MeshError
from beltrami.mesh.mesh import Mesh


def as_mesh(source: Any) -> Mesh:
    """Make a mesh of a (vertices, faces) pair or of another library's triangle mesh.

    Accepted are a Mesh itself, pairs, and whatever has ``vertices`` and ``faces`` (trimesh),
    ``points`` and ``regular_faces`` (pyvista), ``points`` and ``cells_dict`` (meshio), or
    ``vertices`` and ``triangles`` (open3d). The order of vertices and faces is kept; quads of
    meshio are cut in two and come last, its points and lines are no faces.

    Raises
    ------
    MeshError
        If the object is none of these, or holds no triangles.

    Examples
    --------
    >>> as_mesh(([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]))
    <Mesh: 3 vertices in R², 1 faces>
    """
    if isinstance(source, Mesh):
        return source
    if isinstance(source, tuple | list) and len(source) == 2:
        return Mesh(source[0], source[1])
    for vertices, faces in (
        ("vertices", "faces"),
        ("vertices", "triangles"),
        ("points", "regular_faces"),
    ):
        if hasattr(source, vertices) and hasattr(source, faces):
            return Mesh(np.asarray(getattr(source, vertices)), np.asarray(getattr(source, faces)))
    if hasattr(source, "points") and hasattr(source, "cells_dict"):
        return Mesh(np.asarray(source.points), _triangles(source.cells_dict))
    raise MeshError(
        f"cannot make a mesh of an object of type {type(source).__name__}",
        remedy="Give a pair (vertices, faces).",
    )


def _triangles(cells: dict[str, Any]) -> np.ndarray:
    """Collect the triangles and the halves of the quads of meshio; refuse other faces."""
    unknown = set(cells) - {"triangle", "quad", "line", "vertex"}
    if unknown or not set(cells) & {"triangle", "quad"}:
        raise MeshError(f"triangles or quads are needed, and this meshio object has {list(cells)}")
    quads = np.asarray(cells.get("quad", np.zeros((0, 4), np.int64)))
    halves = quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    return np.concatenate([cells.get("triangle", halves[:0]), halves])
