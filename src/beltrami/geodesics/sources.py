"""Sources of a distance, at the door."""

from __future__ import annotations

from numpy.typing import ArrayLike

from beltrami._arrays import Integers, as_indices
from beltrami.errors import MeshError


def checked_sources(sources: ArrayLike, n: int) -> Integers:
    """Return the sources as indices of vertices: one, several, or a mask of n truth values.

    Raises
    ------
    MeshError
        If there is none, or one is not an integer in 0..n-1; ``error.vertices`` lists them.
    """
    found = as_indices(sources, n, "sources")
    if not len(found):
        raise MeshError("a distance needs at least one source")
    return found
