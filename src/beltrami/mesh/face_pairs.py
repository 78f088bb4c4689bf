"""Pairs of faces: each edge of two faces, seen from both of them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Booleans, Integers, read_only


class FacePairs(NamedTuple):
    """The pairs of faces that share an edge which no third face has, each pair once.

    Attributes
    ----------
    side : (q,) int
        The half-edge 3 f + c in the face with the smaller number.
    other : (q,) int
        The half-edge in the other face.
    agree : (q,) bool
        Whether the two run through their edge in opposite directions, as oriented faces do.
    """

    side: Integers
    other: Integers
    agree: Booleans

    @property
    def faces(self) -> Integers:
        """(q, 2) int: the two faces."""
        return np.stack([self.side // 3, self.other // 3], axis=1)


def pair_faces(faces: Integers, twins: NDArray[np.int32]) -> FacePairs:
    """Pair the faces across the sides that have a twin, in the order of the half-edges; O(m).

    Examples
    --------
    >>> from beltrami.mesh.half_edges import pair_sides
    >>> turned = np.array([[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 2, 5]])  # the last runs backwards
    >>> pairs = pair_faces(turned, pair_sides(turned, 6).twins)
    >>> pairs.faces.tolist(), pairs.agree.tolist()
    ([[0, 1], [1, 2], [2, 3]], [True, True, False])
    """
    across = twins.ravel()
    side = np.flatnonzero(across > np.arange(len(across)))
    other = across[side].astype(np.int64)
    agree = faces[side // 3, (side + 1) % 3] != faces[other // 3, (other + 1) % 3]
    return FacePairs(read_only(side), read_only(other), read_only(agree))
