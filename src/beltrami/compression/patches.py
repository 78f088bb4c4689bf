"""Predictions by small systems: where a vertex is if the surface around it is as flat as can be.

The unknown vertices near v are those that make Laplacians, or parallelograms, of the patch small;
the system is eliminated from the outside to v. Arithmetic is +, -, *, / of double precision in a
fixed order, which every machine rounds alike.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import plain_kernel
from beltrami.compression.tables import whole

_ROOM = 160  # vertices of a patch
_UNKNOWNS = 64
_VALENCE = 60  # vertices of more neighbours have no Laplacian here


class Patch(NamedTuple):
    """Scratch: the vertices of a patch, and its system.

    Attributes
    ----------
    vertices : (_ROOM,) int64
        v first, then ring by ring.
    ends : (8,) int64
        Where each ring ends; last of all, the number of the patch.
    place : (n, 2) int32
        The number of the patch that saw each vertex last, and its place there.
    column : (_ROOM,) int64
        The unknown of each place, -1 where the position is known.
    matrix, right : (_UNKNOWNS, _UNKNOWNS), (_UNKNOWNS, 3)
        The lower half of the system and its right-hand sides.
    terms, weights : (_VALENCE + 4,)
        The places and weights of one equation.
    """

    vertices: NDArray[np.int64]
    ends: NDArray[np.int64]
    place: NDArray[np.int32]
    column: NDArray[np.int64]
    matrix: NDArray[np.float64]
    right: NDArray[np.float64]
    terms: NDArray[np.int64]
    weights: NDArray[np.float64]


def new_patch(n: int) -> Patch:
    """Make the scratch for meshes of n vertices."""
    return Patch(
        np.zeros(_ROOM, np.int64),
        np.zeros(8, np.int64),
        np.zeros((n, 2), np.int32),
        np.zeros(_ROOM, np.int64),
        np.zeros((_UNKNOWNS, _UNKNOWNS)),
        np.zeros((_UNKNOWNS, 3)),
        np.zeros(_VALENCE + 4, np.int64),
        np.zeros(_VALENCE + 4),
    )


@plain_kernel
def gather(v: int, rings: int, near: Any, known: Any, patch: Any) -> int:
    """Collect v and the rings around it, and number what is unknown; return how many they are."""
    number = patch.ends[7] + 1
    patch.ends[7] = number
    vertices, place = patch.vertices, patch.place
    vertices[0] = v
    place[v, 0], place[v, 1] = number, 0
    start, end, unknowns = 0, 1, 1
    patch.column[0] = 0
    patch.ends[0] = 1
    for r in range(rings):
        size = end
        for i in range(start, end):
            w = vertices[i]
            for j in range(near.starts[w], near.starts[w + 1]):
                u = whole(near.around[j])
                if place[u, 0] == number or size == _ROOM:
                    continue
                if not known[u] and unknowns == _UNKNOWNS:
                    continue
                place[u, 0], place[u, 1] = number, size
                vertices[size] = u
                patch.column[size] = -1 if known[u] else unknowns
                unknowns += 0 if known[u] else 1
                size += 1
        start, end = end, size
        patch.ends[r + 1] = end
    return unknowns


@plain_kernel
def _add(k: int, factor: float, patch: Any, x: Any) -> None:
    """Add the square of one equation of k terms, times a factor, to the system."""
    terms, weights, column = patch.terms, patch.weights, patch.column
    c0 = c1 = c2 = 0.0
    for a in range(k):
        if column[terms[a]] < 0:
            u = patch.vertices[terms[a]]
            c0 += weights[a] * x[u, 0]
            c1 += weights[a] * x[u, 1]
            c2 += weights[a] * x[u, 2]
    for a in range(k):
        i = column[terms[a]]
        if i < 0:
            continue
        f = factor * weights[a]
        patch.right[i, 0] -= f * c0
        patch.right[i, 1] -= f * c1
        patch.right[i, 2] -= f * c2
        for b in range(k):
            j = column[terms[b]]
            if 0 <= j <= i:
                patch.matrix[i, j] += f * weights[b]


@plain_kernel
def _add_laplacians(rings: int, factor: float, near: Any, patch: Any, x: Any) -> None:
    """Each vertex whose neighbours are all in the patch should be their mean."""
    number = patch.ends[7]
    for i in range(patch.ends[rings - 1]):
        w = patch.vertices[i]
        first, last = near.starts[w], near.starts[w + 1]
        if last - first >= _VALENCE:
            continue
        patch.terms[0], patch.weights[0] = i, 1.0
        k = 1
        some = patch.column[i] >= 0
        for j in range(first, last):
            u = near.around[j]
            if patch.place[u, 0] != number:
                k = 0
                break
            patch.terms[k] = patch.place[u, 1]
            patch.weights[k] = -1.0 / (last - first)
            some |= patch.column[patch.place[u, 1]] >= 0
            k += 1
        if k > 1 and some:
            _add(k, factor, patch, x)


@plain_kernel
def _add_parallelograms(rings: int, factor: float, near: Any, patch: Any, x: Any) -> None:
    """Each two neighbouring faces of the patch should be a parallelogram."""
    number, place, corners = patch.ends[7], patch.place, near.corners
    patch.weights[0] = patch.weights[1] = 1.0
    patch.weights[2] = patch.weights[3] = -1.0
    for i in range(patch.ends[rings]):
        w = patch.vertices[i]
        for t in range(near.corner_starts[w], near.corner_starts[w + 1]):
            c = whole(near.corner_list[t])
            o = whole(near.opposite[c])
            if o < c:
                continue
            d = corners[o]
            a, b = corners[c - c % 3 + (c + 1) % 3], corners[c - c % 3 + (c + 2) % 3]
            if place[d, 0] != number or place[a, 0] != number or place[b, 0] != number:
                continue
            patch.terms[0], patch.terms[1] = i, place[d, 1]
            patch.terms[2], patch.terms[3] = place[a, 1], place[b, 1]
            _add(4, factor, patch, x)


@plain_kernel
def _add_edges(rings: int, factor: float, near: Any, patch: Any, x: Any) -> None:
    """Every edge should be a little short, so that the system is never singular."""
    number = patch.ends[7]
    for i in range(patch.ends[rings]):
        a = patch.column[i]
        if a < 0:
            continue
        w = patch.vertices[i]
        for j in range(near.starts[w], near.starts[w + 1]):
            u = near.around[j]
            if patch.place[u, 0] != number:
                continue
            b = patch.column[patch.place[u, 1]]
            patch.matrix[a, a] += factor
            if b < 0:
                for q in range(3):
                    patch.right[a, q] += factor * x[u, q]
            elif b <= a:
                patch.matrix[a, b] -= factor


@plain_kernel
def _eliminate(unknowns: int, patch: Any) -> None:
    """Eliminate the unknowns from the last to the second."""
    matrix, right = patch.matrix, patch.right
    for p in range(unknowns - 1, 0, -1):
        d = matrix[p, p]
        if d <= 1e-14:
            continue
        for a in range(p):
            f = matrix[p, a] / d
            if f != 0.0:
                for b in range(a + 1):
                    matrix[a, b] -= f * matrix[p, b]
                for q in range(3):
                    right[a, q] -= f * right[p, q]


@plain_kernel
def solve(
    v: int, rings: int, laplacian: float, parallelogram: float, edge: float,
    near: Any, known: Any, patch: Any, x: Any, out: Any,
) -> None:  # fmt: skip
    """Predict the position of v: minimise a sum of squares over what is unknown around it.

    ``out`` (3,) is left as it is where the system says nothing about v.
    """
    unknowns = gather(v, rings, near, known, patch)
    patch.matrix[:unknowns, :unknowns] = 0.0
    patch.right[:unknowns] = 0.0
    if laplacian > 0:
        _add_laplacians(rings, laplacian, near, patch, x)
    if parallelogram > 0:
        _add_parallelograms(rings, parallelogram, near, patch, x)
    _add_edges(rings, edge, near, patch, x)
    _eliminate(unknowns, patch)
    if patch.matrix[0, 0] > 1e-14:
        for q in range(3):
            out[q] = patch.right[0, q] / patch.matrix[0, 0]
