"""What single faces of an intrinsic triangulation bring to the pair (L, B)."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel
from beltrami.mesh.triangle import shares
from beltrami.operators.areas import AREA_KINDS
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
    """Split the masses among the corners of the faces."""
    if mass == "degree":
        return np.asarray(sides.sum(axis=1, keepdims=True) - sides)
    if mass == "unit":
        around = np.bincount(triangles.faces.ravel(), minlength=triangles.n_vertices)
        return np.asarray(1 / around[triangles.faces])
    if mass == "consistent":  # (A/12)⁻¹ L_f has the eigenvalues of the pair, because L_f 1 = 0
        return np.repeat(triangles.area_parts[:, None] / 12, 3, axis=1)
    parts = _shares(triangles.dots, triangles.double_areas, AREA_KINDS[mass])
    return np.asarray(parts) * (triangles.unit**2 / triangles.sheets)


@kernel
def _shares(dots: Any, double: Any, kind: int) -> Any:
    """Split the area of each face among its corners."""
    out = np.empty(dots.shape)
    for f in range(dots.shape[0]):
        out[f, 0], out[f, 1], out[f, 2] = shares(
            dots[f, 0], dots[f, 1], dots[f, 2], double[f], kind
        )
    return out
