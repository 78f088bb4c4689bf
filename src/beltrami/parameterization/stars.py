"""Stars: the faces around each vertex, and where a vertex lies best among its neighbours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Booleans, Floats, Integers
from beltrami._jit import kernel
from beltrami.mesh.geometry import well_scaled
from beltrami.mesh.mesh import Mesh

_HALVINGS = 40  # of a step, before it is given up
_NO_MORE = 1e-3  # decrease of the energy in a step at which a vertex stays
_LIFT = 1e-3  # least curvature, over the largest ones


@dataclass(frozen=True, eq=False)
class Stars:
    """The corners of each vertex, one after the other, to go through those that may move.

    Attributes
    ----------
    unit
        Of length, in which the corners are measured.
    starts : (n + 1,) int
        Where the corners of each vertex begin.
    ends : (3 m, 2) int32
        The other two vertices of the face of each corner, counter-clockwise.
    rest : (3 m, 4)
        What ``at_rest`` says of each corner.
    movable : int array
        The vertices that may move, none of them on the boundary.
    """

    unit: float
    starts: Integers
    ends: NDArray[np.int32]
    rest: Floats
    movable: Integers

    def swept(self, x: Floats, scale: float, count: int, chosen: Booleans | None = None) -> Floats:
        """Return x after one step of Newton for each vertex, in turn, and this so many times.

        Only the symmetric Dirichlet energy of its faces falls; none of them folds. This evens out
        in no time what is rough, which stands in the way of all vertices moving at once, and does
        little for what is far. ``scale`` is what lengths of x are to be multiplied with for those
        of the surface. Of the movable vertices only the ``chosen`` ones of a mask (n,) are moved,
        if it is given. Cost: O(n) each, or as many as are moved.
        """
        moved = np.array(x)
        movable = self.movable if chosen is None else self.movable[chosen[self.movable]]
        for _ in range(count):
            _sweep(self.starts, self.ends, self.rest, moved, movable, scale / self.unit)
        return moved


def stars(mesh: Mesh, free: Booleans | None = None) -> Stars:
    """Prepare the inner vertices of a mesh, or those of them that are free; O(n)."""
    positions, unit = well_scaled(mesh.vertices)
    inner = ~mesh.topology.on_boundary
    count = 3 * mesh.n_faces
    ends, rest = np.empty((count, 2), np.int32), np.empty((count, 4))
    starts = np.zeros(mesh.n_vertices + 1, np.int64)
    np.cumsum(np.bincount(mesh.faces.ravel(), minlength=mesh.n_vertices), out=starts[1:])
    _collect(positions, mesh.faces, starts[:-1].copy(), ends, rest)
    return Stars(unit, starts, ends, rest, np.flatnonzero(inner if free is None else inner & free))


@kernel
def _collect(positions: Any, faces: Any, at: Any, ends: Any, rest: Any) -> None:
    for f in range(faces.shape[0]):
        for k in range(3):
            v, a, b = faces[f, k], faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
            ends[at[v], 0], ends[at[v], 1] = a, b
            at_rest(positions, v, a, b, rest[at[v]])
            at[v] += 1


@kernel
def corner_lists(faces: Any, n: int) -> Any:
    """Return a corner of each vertex, and the next one of the same vertex; -1 where there is none.

    Corner c is the one of face c // 3 at its vertex c % 3.
    """
    first, after = np.full(n, -1, np.int64), np.full(3 * faces.shape[0], -1, np.int64)
    for c in range(3 * faces.shape[0]):
        v = faces[c // 3, c % 3]
        after[c], first[v] = first[v], c
    return first, after


@kernel
def _sweep(starts: Any, ends: Any, rest: Any, x: Any, movable: Any, scale: float) -> None:
    sides = np.empty((64, 4))
    for t in range(movable.size):
        v = movable[t]
        first, last = starts[v], starts[v + 1]
        if last - first > sides.shape[0]:
            sides = np.empty((2 * (last - first), 4))
        for c in range(first, last):
            a, b = ends[c, 0], ends[c, 1]
            for d in range(2):
                sides[c - first, d] = scale * (x[a, d] - x[v, d])
                sides[c - first, 2 + d] = scale * (x[b, d] - x[v, d])
        px, py = best_place(sides, rest[first:last], last - first, 0.0, 0.0, 1)
        x[v, 0] += px / scale
        x[v, 1] += py / scale


@kernel
def at_rest(x: Any, v: int, a: int, b: int, rest: Any) -> None:
    """Write where v stands over a side on the surface, 1 / its length, 1 / the height, the area.

    The area is 0 where the face has none.
    """
    aa = ap = hh = 0.0
    for c in range(x.shape[1]):
        side, p = x[b, c] - x[a, c], x[v, c] - x[a, c]
        aa, ap = aa + side * side, ap + side * p
    share = ap / aa if aa > 0 else 0.0
    for c in range(x.shape[1]):
        hh += (x[v, c] - x[a, c] - share * (x[b, c] - x[a, c])) ** 2
    length, height = np.sqrt(aa), np.sqrt(hh)
    rest[3] = length * height / 2
    if rest[3] > 0:
        rest[0], rest[1], rest[2] = share * length, 1 / length, 1 / height


@kernel
def best_place(sides: Any, rest: Any, k: int, px: float, py: float, steps: int) -> Any:
    """Go down from a point by so many steps of Newton, as far as the energy falls."""
    here, gx, gy, a, b, c = star_energy(sides, rest, k, px, py)
    for turn in range(steps):
        if not here < np.inf:
            break
        lift = max(0.0, _LIFT * (abs(a) + abs(c)) - (a + c) / 2 + np.hypot((a - c) / 2, b))
        a, c = a + lift, c + lift
        determinant = a * c - b * b
        if not determinant > 0:
            break
        dx, dy = (b * gy - c * gx) / determinant, (b * gx - a * gy) / determinant
        slope = gx * dx + gy * dy
        step, start = 1.0, here
        here = star_sum(sides, rest, k, px + dx, py + dy)
        for _ in range(_HALVINGS):
            if here <= start + 1e-4 * step * slope:
                break
            step /= 2
            here = star_sum(sides, rest, k, px + step * dx, py + step * dy)
        if not here < start:
            break
        px, py = px + step * dx, py + step * dy
        if turn + 1 == steps or here > (1 - _NO_MORE) * start:
            break
        here, gx, gy, a, b, c = star_energy(sides, rest, k, px, py)
    return px, py


@kernel
def star_sum(sides: Any, rest: Any, k: int, px: float, py: float) -> float:
    """Return the energy of the faces of a vertex at p alone: see ``star_energy``."""
    total = 0.0
    for q in range(np.uint64(k)):
        along, shorter, lower, area = rest[q, 0], rest[q, 1], rest[q, 2], rest[q, 3]
        ux, uy = shorter * (sides[q, 2] - sides[q, 0]), shorter * (sides[q, 3] - sides[q, 1])
        wx, wy = px - sides[q, 0], py - sides[q, 1]
        D = lower * (ux * wy - uy * wx)
        if not (D > 0 and area > 0):
            return np.inf
        rx, ry = lower * (wx - along * ux), lower * (wy - along * uy)
        inverse = 1 / D
        total += area * (ux * ux + uy * uy + rx * rx + ry * ry) * (1 + inverse * inverse)
    return total


@kernel
def star_energy(sides: Any, rest: Any, k: int, px: float, py: float) -> Any:
    r"""Return the energy of the faces of a vertex at p, its gradient and second derivatives.

    Of a face it is :math:`A Q (1 + 1/D^2)`, with the sum of squares Q and the determinant D of its
    Jacobian: Q is quadratic in p, D linear. It is infinite where a face is folded.
    """
    total = gx = gy = hxx = hxy = hyy = 0.0
    for q in range(k):
        along, shorter, lower, area = rest[q, 0], rest[q, 1], rest[q, 2], rest[q, 3]
        if not area > 0:
            return np.inf, 0.0, 0.0, 1.0, 0.0, 1.0
        ux, uy = shorter * (sides[q, 2] - sides[q, 0]), shorter * (sides[q, 3] - sides[q, 1])
        wx, wy = px - sides[q, 0], py - sides[q, 1]
        D = lower * (ux * wy - uy * wx)
        if not D > 0:
            return np.inf, 0.0, 0.0, 1.0, 0.0, 1.0
        rx, ry = lower * (wx - along * ux), lower * (wy - along * uy)
        Q = ux * ux + uy * uy + rx * rx + ry * ry
        qx, qy, dx, dy = 2 * lower * rx, 2 * lower * ry, -lower * uy, lower * ux
        reciprocal = 1 / D
        inverse = reciprocal * reciprocal
        mixed = 2 * inverse * reciprocal
        first, second = Q * mixed, 6 * Q * inverse * inverse
        bend = 2 * (1 + inverse) * lower * lower
        total += area * Q * (1 + inverse)
        gx += area * (qx * (1 + inverse) - first * dx)
        gy += area * (qy * (1 + inverse) - first * dy)
        hxx += area * (bend - 2 * mixed * qx * dx + second * dx * dx)
        hxy += area * (second * dx * dy - mixed * (qx * dy + qy * dx))
        hyy += area * (bend - 2 * mixed * qy * dy + second * dy * dy)
    return total, gx, gy, hxx, hxy, hyy
