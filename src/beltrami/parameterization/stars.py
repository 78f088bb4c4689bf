"""Stars: the faces around each vertex, and where a vertex lies best among its neighbours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from beltrami._arrays import Booleans, Floats, Integers
from beltrami._jit import kernel
from beltrami.mesh.geometry import well_scaled
from beltrami.mesh.mesh import Mesh

_HALVINGS = 40  # of a step, before it is given up
_NO_MORE = 1e-3  # decrease of the energy in a step at which a vertex stays
_LIFT = 1e-3  # least curvature, over the largest ones


@dataclass(frozen=True, eq=False)
class Stars:
    """The corners of each vertex that may move, as lists, to go through them one at a time.

    Attributes
    ----------
    positions : (n, d), unit
        The vertices on the surface, in such a unit of length.
    faces : (m, 3) int
        Their faces.
    first : (n,) int, after : (3 m,) int
        A corner of each vertex, and the next corner of the same one, or -1.
    movable : int array
        The vertices that may move, none of them on the boundary.
    """

    positions: Floats
    unit: float
    faces: Integers
    first: Integers
    after: Integers
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
            _sweep(
                self.positions, moved, self.faces, self.first, self.after, movable,
                scale / self.unit,
            )  # fmt: skip
        return moved


def stars(mesh: Mesh, free: Booleans | None = None) -> Stars:
    """Prepare the inner vertices of a mesh, or those of them that are free; O(n)."""
    positions, unit = well_scaled(mesh.vertices)
    inner = ~mesh.topology.on_boundary
    lists = corner_lists(mesh.faces, mesh.n_vertices)
    movable = np.flatnonzero(inner if free is None else inner & free)
    return Stars(positions, unit, mesh.faces, lists[0], lists[1], movable)


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
def _sweep(
    positions: Any, x: Any, faces: Any, first: Any, after: Any, movable: Any, scale: float
) -> None:
    room = 64
    sides, rest = np.empty((room, 4)), np.empty((room, 3))
    for t in range(movable.size):
        v = movable[t]
        k, c = 0, first[v]
        while c >= 0:
            a, b = faces[c // 3, (c % 3 + 1) % 3], faces[c // 3, (c % 3 + 2) % 3]
            if k == room:
                room *= 2
                wider, longer = np.empty((room, 4)), np.empty((room, 3))
                wider[:k], longer[:k] = sides[:k], rest[:k]
                sides, rest = wider, longer
            for d in range(2):
                sides[k, d] = scale * (x[a, d] - x[v, d])
                sides[k, 2 + d] = scale * (x[b, d] - x[v, d])
            at_rest(positions, v, a, b, rest[k])
            k, c = k + 1, after[c]
        px, py = best_place(sides, rest, k, 0.0, 0.0, 1)
        x[v, 0] += px / scale
        x[v, 1] += py / scale


@kernel
def at_rest(x: Any, v: int, a: int, b: int, rest: Any) -> None:
    """Write the length of a side on the surface, and where v stands over it: along, and height."""
    aa = ap = hh = 0.0
    for c in range(x.shape[1]):
        side, p = x[b, c] - x[a, c], x[v, c] - x[a, c]
        aa, ap = aa + side * side, ap + side * p
    share = ap / aa if aa > 0 else 0.0
    for c in range(x.shape[1]):
        hh += (x[v, c] - x[a, c] - share * (x[b, c] - x[a, c])) ** 2
    rest[0], rest[1], rest[2] = np.sqrt(aa), share * np.sqrt(aa), np.sqrt(hh)


@kernel
def best_place(sides: Any, rest: Any, k: int, px: float, py: float, steps: int) -> Any:
    """Go down from a point by so many steps of Newton, as far as the energy falls."""
    here, gx, gy, a, b, c = star_energy(sides, rest, k, px, py)
    for _ in range(steps):
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
        there = star_energy(sides, rest, k, px + dx, py + dy)
        for _ in range(_HALVINGS):
            if there[0] <= start + 1e-4 * step * slope:
                break
            step /= 2
            there = star_energy(sides, rest, k, px + step * dx, py + step * dy)
        if not there[0] < start:
            break
        px, py = px + step * dx, py + step * dy
        here, gx, gy, a, b, c = there
        if here > (1 - _NO_MORE) * start:
            break
    return px, py


@kernel
def star_energy(sides: Any, rest: Any, k: int, px: float, py: float) -> Any:
    r"""Return the energy of the faces of a vertex at p, its gradient and second derivatives.

    Of a face it is :math:`A Q (1 + 1/D^2)`, with the sum of squares Q and the determinant D of its
    Jacobian: Q is quadratic in p, D linear. It is infinite where a face is folded.
    """
    total = gx = gy = hxx = hxy = hyy = 0.0
    for q in range(k):
        length, along, height = rest[q, 0], rest[q, 1], rest[q, 2]
        if not length * height > 0:
            return np.inf, 0.0, 0.0, 1.0, 0.0, 1.0
        ux, uy = (sides[q, 2] - sides[q, 0]) / length, (sides[q, 3] - sides[q, 1]) / length
        wx, wy = px - sides[q, 0], py - sides[q, 1]
        D = (ux * wy - uy * wx) / height
        if not D > 0:
            return np.inf, 0.0, 0.0, 1.0, 0.0, 1.0
        rx, ry = (wx - along * ux) / height, (wy - along * uy) / height
        Q, area = ux * ux + uy * uy + rx * rx + ry * ry, length * height / 2
        qx, qy, dx, dy = 2 * rx / height, 2 * ry / height, -uy / height, ux / height
        inverse = 1 / D / D
        first, second, mixed = 2 * Q * inverse / D, 6 * Q * inverse * inverse, 2 * inverse / D
        bend = 2 * (1 + inverse) / (height * height)
        total += area * Q * (1 + inverse)
        gx += area * (qx * (1 + inverse) - first * dx)
        gy += area * (qy * (1 + inverse) - first * dy)
        hxx += area * (bend - 2 * mixed * qx * dx + second * dx * dx)
        hxy += area * (second * dx * dy - mixed * (qx * dy + qy * dx))
        hyy += area * (bend - 2 * mixed * qy * dy + second * dy * dy)
    return total, gx, gy, hxx, hxy, hyy
