"""Texture coordinates of PLY files: columns of the vertices, or a list in each face."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami.io.faces import fan

PAIRS = (("texture_u", "texture_v"), ("u", "v"), ("s", "t"))
LISTS = ("texcoord",)


def pair_of(columns: dict[str, Any]) -> tuple[str, str] | None:
    """Return the names of the columns that are texture coordinates: the first pair of floats.

    Examples
    --------
    >>> pair_of({"s": np.zeros(3, np.float32), "t": np.zeros(3, np.float32)})
    ('s', 't')
    """
    for pair in PAIRS:
        if all(name in columns and columns[name].dtype.kind == "f" for name in pair):
            return pair
    return None


def of_vertices(scalars: dict[str, NDArray[Any]]) -> Floats | None:
    """Take the texture coordinates (n, 2) out of the columns of the vertices; None without any."""
    pair = pair_of(scalars)
    if pair is None:
        return None
    return np.stack([scalars.pop(name).astype(np.float64) for name in pair], axis=1)


def of_faces(
    sizes: Integers | int, faces: int, turns: Floats, lengths: Integers | int
) -> Floats | None:
    """Return the texture coordinates (m, 3, 2) of polygons cut into triangles.

    A face with ``sizes`` corners has twice as many numbers, u and v for each corner. One with
    another number has none: NaN.

    Examples
    --------
    >>> of_faces(4, 1, np.arange(8.0), 8)[:, :, 0].tolist()
    [[0.0, 2.0, 4.0], [0.0, 4.0, 6.0]]
    """
    corners = np.broadcast_to(np.asarray(sizes, np.int64), faces)
    given = np.broadcast_to(np.asarray(lengths, np.int64), faces)
    known = (given == 2 * corners) & (given > 0)
    if not known.any():
        return None
    by_corner = np.full((int(corners.sum()), 2), np.nan)
    kept = turns.ravel()[np.repeat(known, given)].reshape(-1, 2)
    by_corner[np.repeat(known, corners)] = np.where(np.isfinite(kept), kept, np.nan)
    if (corners == 3).all():
        return by_corner.reshape(-1, 3, 2)
    return by_corner[fan(np.arange(len(by_corner)), corners)]
