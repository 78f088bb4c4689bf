"""Faces at the door: an (m, 3) array of integers that name vertices."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Integers, frozen, rectangular, whole
from beltrami._jit import unsigned
from beltrami.errors import DimensionError, MeshError

_POLYGONS = "Triangulate polygons; read_mesh does it for files."
_WHOLE = "Give Mesh(vertices, faces), in this order, and faces.astype(int) if these are indices."


def checked_faces(faces: ArrayLike, n_vertices: int | None) -> tuple[Integers, int]:
    """Return the faces as a read-only (m, 3) int64 array, and the number of vertices.

    Raises
    ------
    DimensionError
        If they are not (m, 3) integers.
    MeshError
        If one names a vertex outside 0..n-1; ``error.faces`` lists them.
    """
    given = rectangular(faces)
    if given.size == 0 and given.shape[-1] in (0, 3):
        given = np.zeros((0, 3), np.int64)
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in "iu":
        raise DimensionError(
            f"faces are an array of shape {given.shape} and type {given.dtype} where (m, 3) "
            "integers are needed",
            remedy=_WHOLE if given.dtype.kind == "f" else _POLYGONS,
        )
    array = frozen(given, np.int64)
    if n_vertices is None:
        n = int(array.max(initial=-1)) + 1
    else:
        n = whole("the number of vertices", n_vertices, least=0)
    if len(array) and unsigned(array).max() >= n:  # a negative index is a huge unsigned one
        raise MeshError(
            f"faces name vertices outside 0..{n - 1}",
            faces=np.flatnonzero(((array < 0) | (array >= n)).any(axis=1)),
            remedy="Indices start at 0 and end at the number of vertices less one.",
        )
    return array, n
