"""Insertion: vertices put back into a map, each where it is least distorted, without a fold."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel
from beltrami.mesh.geometry import well_scaled
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.stars import at_rest, best_place
from beltrami.parameterization.thinning import Thinned

_STEPS = 12  # of Newton for a vertex, at most


def inserted(fine: Mesh, coarse: Thinned, uv: Floats, scale: float) -> Floats:
    r"""Return positions of all vertices; uv are those of the coarse mesh, without a fold.

    A vertex that went along an edge left a hole that is seen as a whole from one of its corners.
    So the half-planes within its sides have points in common, and with the vertex at any of them
    no face is folded (H. Shen, Z. Jiang, D. Zorin, D. Panozzo, Progressive embedding, 2019). From
    the middle of these points it goes where the symmetric Dirichlet energy of its faces is least.
    In floating point there may be no such points: a vertex is left on a neighbour then, and its
    faces are found to have no area by who looks.

    ``scale`` is what lengths of uv are to be multiplied with for those of ``fine``. Cost: O(n).
    """
    positions, unit = well_scaled(fine.vertices)
    x = np.zeros((fine.n_vertices, 2))
    x[coarse.kept] = uv
    _insert(positions, x, coarse.removed, coarse.starts, coarse.rings, scale / unit)
    return x


@kernel
def _insert(positions: Any, x: Any, removed: Any, starts: Any, rings: Any, scale: float) -> None:
    """Put them back, the last one first."""
    widest = 0
    for t in range(removed.size):
        widest = max(widest, starts[t + 1] - starts[t])
    corners, spare = np.empty((2 * widest + 4, 2)), np.empty((2 * widest + 4, 2))
    sides, rest = np.empty((widest, 4)), np.empty((widest, 4))
    for t in range(removed.size - 1, -1, -1):
        v, k = removed[t], starts[t + 1] - starts[t]
        ring = rings[starts[t] : starts[t + 1]]
        far = 0.0
        for q in range(k):
            a, b = ring[q], ring[(q + 1) % k]
            for c in range(2):
                sides[q, c] = scale * (x[a, c] - x[ring[0], c])
                sides[q, 2 + c] = scale * (x[b, c] - x[ring[0], c])
                far = max(far, abs(sides[q, c]))
            at_rest(positions, v, a, b, rest[q])
        px, py = _middle(sides, k, far, corners, spare)
        px, py = best_place(sides, rest, k, px, py, _STEPS)
        x[v, 0], x[v, 1] = x[ring[0], 0] + px / scale, x[ring[0], 1] + py / scale


@kernel
def _middle(sides: Any, k: int, far: float, corners: Any, spare: Any) -> Any:
    """Return the middle of the points on the left of all sides; 0, a corner, if there are none."""
    count = 4
    for c in range(4):  # a square around all, cut by one side after the other
        corners[c, 0] = far if c in (1, 2) else -far
        corners[c, 1] = far if c in (2, 3) else -far
    for q in range(k):
        ax, ay = sides[q, 0], sides[q, 1]
        sx, sy = sides[q, 2] - ax, sides[q, 3] - ay
        made = 0
        for c in range(count):
            px, py = corners[c, 0], corners[c, 1]
            nx, ny = corners[(c + 1) % count, 0], corners[(c + 1) % count, 1]
            here, there = sx * (py - ay) - sy * (px - ax), sx * (ny - ay) - sy * (nx - ax)
            if here >= 0:
                spare[made, 0], spare[made, 1] = px, py
                made += 1
            if (here > 0 and there < 0) or (here < 0 and there > 0):
                part = here / (here - there)
                spare[made, 0], spare[made, 1] = px + part * (nx - px), py + part * (ny - py)
                made += 1
        count = made
        corners[:count] = spare[:count]
    if count == 0:
        return 0.0, 0.0
    return corners[:count, 0].mean(), corners[:count, 1].mean()
