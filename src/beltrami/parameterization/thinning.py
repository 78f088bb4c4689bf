"""Thinning: a disk with fewer vertices, and how those that went come back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Booleans, Floats, Integers
from beltrami._jit import kernel
from beltrami.mesh.cut import shortest_paths
from beltrami.mesh.geometry import well_scaled
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.stars import corner_lists

_SHARE = 0.2  # of the vertices that remain: so many may be near the boundary
_RINGS = 3  # of vertices around the boundary that stay, where these are no more
_GRADE = 0.25  # of the distance from such a boundary: edges longer than that are not made
_WIDEST = 12  # neighbours of a vertex that goes, at most
_PASSES = 16  # over all vertices, at most
_FEWEST = 0.02  # vertices that go in a pass, at least, for another one
_WORST = 0.02  # shape of a new face, at least: 1 for an equilateral one
_EQUILATERAL = 4 * np.sqrt(3)  # squares of its sides over its area
_CHANGE = 0.3  # of the area around a vertex that goes, at most


@dataclass(frozen=True, eq=False)
class Thinned:
    """A mesh of some of the vertices, and the rings of the others, as they were when they went.

    Attributes
    ----------
    mesh
        The coarser mesh; ``kept`` : (n',) int, the numbers of its vertices in the finer one.
    removed : (r,) int
        The vertices that went, in this order.
    starts : (r + 1,) int, rings : int32
        Their rings, counter-clockwise, one after the other.
    """

    mesh: Mesh
    kept: Integers
    removed: Integers
    starts: Integers
    rings: NDArray[np.int32]


def thinned(mesh: Mesh, count: int) -> Thinned:
    """Take away inner vertices until about so many are left, or none can go.

    A vertex goes into a neighbour, along an edge whose ends have two common neighbours: what was
    a disk remains one, with the same boundary, and no more edges across from it to itself. Of its
    neighbours it is the one with the best shape of the new faces, and none where these were
    slivers or of another area, as on the tip of a spike. In a pass no two neighbours go, so that
    the mesh thins out evenly. Around a short boundary, where maps are worst, none goes at all, and
    farther away edges become as long as their distance from it allows: its surroundings are
    stretched over the more of the image the nearer they are, and each doubling of the distance
    takes the same number of vertices. Cost: O(n), O(n log n) if the boundary is short.
    """
    faces = np.array(mesh.faces)
    n = mesh.n_vertices
    fixed = _near_boundary(mesh, _SHARE * count)
    removed, starts = np.empty(n, np.int64), np.zeros(n + 1, np.int64)
    rings = np.empty(_WIDEST * n, np.int32)
    alive = np.ones(len(faces), np.bool_)
    x, unit = well_scaled(mesh.vertices)
    gone = _thin(
        x, faces, mesh.topology.on_boundary, fixed, _longest(mesh, fixed) / unit, n - count, alive,
        removed, starts, rings,
    )  # fmt: skip
    kept = np.ones(n, np.bool_)
    kept[removed[:gone]] = False
    number = np.cumsum(kept) - 1
    coarse = Mesh(mesh.vertices[kept], number[faces[alive]])
    rings = rings[: starts[gone]].copy()
    return Thinned(coarse, np.flatnonzero(kept), removed[:gone], starts[: gone + 1], rings)


def _near_boundary(mesh: Mesh, most: float) -> Booleans:
    """Say which vertices are on the boundary, or so many rings from it as are not too many."""
    near = np.array(mesh.topology.on_boundary)
    for _ in range(_RINGS):
        wider = near.copy()
        wider[mesh.faces[near[mesh.faces].any(axis=1)]] = True
        if wider.sum() > most:
            break
        near = wider
    return near


def _longest(mesh: Mesh, fixed: Booleans) -> Floats:
    """Say how long the edges may be that are made where a vertex goes."""
    rim = mesh.topology.on_boundary
    if fixed.sum() == rim.sum():
        return np.full(len(rim), np.inf)
    return _GRADE * shortest_paths(mesh, np.flatnonzero(rim))[0]


@kernel
def _thin(
    x: Any, faces: Any, rim: Any, fixed: Any, longest: Any, most: int, alive: Any, removed: Any,
    starts: Any, rings: Any,
) -> int:  # fmt: skip
    """Write the vertices that go, and their rings; return how many. Faces are changed."""
    n = fixed.size
    first, after = corner_lists(faces, n)
    seen, ring = np.full(n, -1, np.int64), np.empty(_WIDEST, np.int64)
    blocked = np.full(n, -1, np.int64)
    gone = 0
    for turn in range(_PASSES):
        before = gone
        for v in range(n):
            if gone == most:
                return gone
            if fixed[v] or blocked[v] == turn:
                continue
            k = _ring(v, faces, first, after, ring)
            if k < 3:
                continue
            w = _target(x, v, ring, k, rim, longest[v], faces, first, after, seen)
            if w < 0:
                continue
            for q in range(k):
                rings[starts[gone] + q] = ring[q]
                blocked[ring[q]] = turn
            removed[gone], fixed[v] = v, True
            gone += 1
            starts[gone] = starts[gone - 1] + k
            _collapse(v, w, faces, first, after, alive)
        if gone - before < _FEWEST * (n - gone):
            break
    return gone


@kernel
def _ring(v: int, faces: Any, first: Any, after: Any, ring: Any) -> int:
    """Write the neighbours of an inner vertex, counter-clockwise; return how many, 0 if many."""
    k, c = 0, first[v]
    while c >= 0:
        if k == ring.size:
            return 0
        ring[k] = faces[c // 3, (c % 3 + 1) % 3]
        k, c = k + 1, after[c]
    if k < 3:
        return 0
    a = ring[0]
    for q in range(k):
        ring[q] = a
        c, b = first[v], -1
        while c >= 0:
            if faces[c // 3, (c % 3 + 1) % 3] == a:
                b = faces[c // 3, (c % 3 + 2) % 3]
            c = after[c]
        if b < 0:
            return 0
        a = b
    return k if a == ring[0] else 0


@kernel
def _target(
    x: Any, v: int, ring: Any, k: int, rim: Any, longest: float, faces: Any, first: Any, after: Any,
    seen: Any,
) -> int:  # fmt: skip
    """Return the neighbour that a vertex goes into, or -1."""
    around = 0.0
    for q in range(k):
        around += _area(x, v, ring[q], ring[(q + 1) % k])
    best, chosen = _WORST, -1
    for s in range(k):
        w = ring[s]
        worst, total = 1.0, 0.0
        for q in range(1, k - 1):
            a, b = ring[(s + q) % k], ring[(s + q + 1) % k]
            area, squares = _area(x, w, a, b), _squares(x, w, a, b)
            total += area
            worst = min(worst, _EQUILATERAL * area / squares) if squares > 0 else 0.0
            if q > 1 and ((rim[w] and rim[a]) or _far(x, w, a, longest)):
                worst = 0.0
        if not worst > best or not abs(total - around) <= _CHANGE * around:
            continue
        if _common(w, v, ring, k, faces, first, after, seen) == 2:
            best, chosen = worst, w
    return chosen


@kernel
def _common(
    w: int, v: int, ring: Any, k: int, faces: Any, first: Any, after: Any, seen: Any
) -> int:
    """Return how many vertices of the ring of v are neighbours of w."""
    for q in range(k):
        seen[ring[q]] = v
    found, c = 0, first[w]
    while c >= 0:
        for step in (1, 2):
            u = faces[c // 3, (c % 3 + step) % 3]
            if seen[u] == v:
                seen[u] = -1
                found += 1
        c = after[c]
    for q in range(k):
        seen[ring[q]] = -1
    return found


@kernel
def _collapse(v: int, w: int, faces: Any, first: Any, after: Any, alive: Any) -> None:
    """Take the faces of v away that have w, and give w the others."""
    c = first[v]
    while c >= 0:
        f, following = c // 3, after[c]
        if faces[f, 0] == w or faces[f, 1] == w or faces[f, 2] == w:
            alive[f] = False
            for k in range(3):
                if faces[f, k] != v:
                    _unlink(faces[f, k], 3 * f + k, first, after)
        else:
            faces[f, c % 3] = w
            after[c], first[w] = first[w], c
        c = following
    first[v] = -1


@kernel
def _unlink(v: int, corner: int, first: Any, after: Any) -> None:
    if first[v] == corner:
        first[v] = after[corner]
        return
    c = first[v]
    while after[c] != corner:
        c = after[c]
    after[c] = after[corner]


@kernel
def _far(x: Any, i: int, j: int, distance: float) -> Any:
    square = 0.0
    for c in range(x.shape[1]):
        square += (x[j, c] - x[i, c]) ** 2
    return square > distance * distance


@kernel
def _area(x: Any, i: int, j: int, k: int) -> float:
    uu = uv = vv = 0.0
    for c in range(x.shape[1]):
        u, v = x[j, c] - x[i, c], x[k, c] - x[i, c]
        uu, uv, vv = uu + u * u, uv + u * v, vv + v * v
    return np.sqrt(max(uu * vv - uv * uv, 0.0)) / 2


@kernel
def _squares(x: Any, i: int, j: int, k: int) -> float:
    total = 0.0
    for c in range(x.shape[1]):
        total += (x[j, c] - x[i, c]) ** 2 + (x[k, c] - x[j, c]) ** 2 + (x[i, c] - x[k, c]) ** 2
    return total
