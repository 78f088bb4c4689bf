"""What single faces of an intrinsic triangulation bring to the pair (L, B)."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats
from beltrami.operators.face_parts import split_masses
from beltrami.operators.intrinsic import IntrinsicTriangulation


def face_pairs(triangles: IntrinsicTriangulation, mass: str) -> tuple[Floats, Floats]:
    """Return the (q, 3) weights of the sides and masses of the corners that the faces bring.

    A face with three different vertices brings what it has. In a face (i, i, j) the two sides
    from i to j share their weights evenly and the third one has none: the sum over the faces is
    the same, and with the degree mass no corner gets a negative part. A face (i, i, i) brings
    nothing to L and is left out.
    """
    sides = triangles.half_cotangents
    corners = triangles.faces
    loops = np.roll(corners, -1, axis=1) == np.roll(corners, -2, axis=1)
    once = loops.sum(axis=1) == 1
    even = (sides[once] * ~loops[once]).sum(axis=1, keepdims=True) / 2
    sides[once] = np.where(loops[once], 0, even)
    kept = loops.sum(axis=1) < 3
    return sides[kept], corner_masses(triangles, sides, mass)[kept]


def corner_masses(triangles: IntrinsicTriangulation, sides: Floats, mass: str) -> Floats:
    """Split the masses among the corners of the faces; each sheet has its part of the areas."""
    of_sheets = triangles.sheets if mass not in ("degree", "unit") else 1
    parts = split_masses(mass, sides, triangles.faces, triangles.n_vertices, triangles.numbers)
    return parts / of_sheets
