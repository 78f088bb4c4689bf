"""Flips of edges that know lengths only: the loop behind the intrinsic Delaunay triangulation.

A corner with the sides u and v is the complex number <u, v> + i |u ∧ v|, whose argument is its
angle. So two corners that meet in a vertex are joined by a product, and nothing is ever taken
from lengths, in which the area of a needle is lost.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel

ROUNDING = 1e-13  # of a sum of cotangents, beside 1 and its terms: less does not count as negative


@kernel
def is_delaunay(dots: Any, double: Any, h: Any, t: Any) -> bool:
    """Whether cot α + cot β >= 0 at the corners that face the half-edges h and t = twin of h."""
    a = dots[h // 3, h % 3] / double[h // 3]
    b = dots[t // 3, t % 3] / double[t // 3]
    return bool(a + b >= -ROUNDING * (1 + abs(a) + abs(b)))


@kernel
def flip_to_delaunay(
    faces: Any, twins: Any, sides: Any, dots: Any, double: Any, p: int, most: int
) -> int:
    """Flip edges until all that two faces share are Delaunay; everything changes in place.

    Parameters
    ----------
    faces, twins, sides
        (m, 3): vertices, half-edges across (negative: none), and the edge of each side.
    dots, double
        (m, 3) and (m,): the four numbers of each face.
    p
        Number of edges; a flipped edge keeps its number.
    most
        After so many flips give up.

    Returns
    -------
    Number of flips; -1 if more than ``most`` were asked for, and -2 if in the end rounding keeps
    an edge from being flipped.
    """
    twin = twins.reshape(-1)
    half_edge = np.full(p, -1, np.int64)  # one side of each edge that may be flipped
    waiting = np.zeros(p, np.bool_)
    stack = np.empty(p, np.int64)
    size = flips = refused = 0
    for h in range(twin.size):
        if twin[h] > h:
            e = sides[h // 3, h % 3]
            half_edge[e] = h
            if not is_delaunay(dots, double, h, np.int64(twin[h])):
                stack[size] = e
                waiting[e] = True
                size += 1
    while size:
        size -= 1
        e = stack[size]
        waiting[e] = False
        h = half_edge[e]
        t = np.int64(twin[h])
        if is_delaunay(dots, double, h, t):  # as is a side glued to another one of its face
            continue
        if not flip_numbers(dots, double, h, t):
            refused += 1
            continue
        if flips == most:
            return -1
        flips += 1
        flip_tables(faces, twin, sides, half_edge, h, t)
        f, g = h // 3, t // 3
        for s in (h, 3 * f + (h + 2) % 3, t, 3 * g + (t + 2) % 3):
            around = sides[s // 3, s % 3]
            if twin[s] >= 0 and not waiting[around]:
                stack[size] = around
                waiting[around] = True
                size += 1
    for h in range(twin.size if refused else 0):  # what was refused may have been flipped later
        if twin[h] > h and not is_delaunay(dots, double, h, np.int64(twin[h])):
            return -2
    return flips


@kernel
def flip_numbers(dots: Any, double: Any, h: Any, t: Any) -> bool:
    """Give the two faces of an edge PQ the numbers that they have after its flip to AB.

    Before, they are (A, P, Q) and (B, Q, P); after, (A, P, B) and (B, Q, A), each beginning at
    the corner that faced the edge. Nothing is changed, and False returned, if one were flat: an
    edge that is not Delaunay can be flipped, so this is rounding.
    """
    f, c = h // 3, h % 3
    g, d = t // 3, t % 3
    f_p, f_q = dots[f, (c + 1) % 3], dots[f, (c + 2) % 3]
    g_q, g_p = dots[g, (d + 1) % 3], dots[g, (d + 2) % 3]
    u, v = double[f], double[g]
    squared = f_p + f_q  # |PQ|²
    if not squared > 0:
        return False
    at_p = (f_p * v + g_p * u) / squared
    at_q = (f_q * v + g_q * u) / squared
    if not (at_p > 0 and at_q > 0):
        return False
    dots[f, c] = (f_p * (f_p - g_p) + u * (u + v)) / squared
    dots[f, (c + 1) % 3] = (f_p * g_p - u * v) / squared
    dots[f, (c + 2) % 3] = (g_p * (g_p - f_p) + v * (u + v)) / squared
    dots[g, d] = (g_q * (g_q - f_q) + v * (u + v)) / squared
    dots[g, (d + 1) % 3] = (f_q * g_q - u * v) / squared
    dots[g, (d + 2) % 3] = (f_q * (f_q - g_q) + u * (u + v)) / squared
    double[f], double[g] = at_p, at_q
    return True


@kernel
def flip_tables(faces: Any, twin: Any, sides: Any, half_edge: Any, h: Any, t: Any) -> None:
    """Flip the edge of the half-edges h and t in the tables of an oriented triangulation.

    The new edge has the sides after h and after t; what these were moves to h and t.
    """
    f, c, c1, c2 = h // 3, h % 3, (h + 1) % 3, (h + 2) % 3
    g, d, d1, d2 = t // 3, t % 3, (t + 1) % 3, (t + 2) % 3
    edge, q_a, p_b = sides[f, c], 3 * f + c1, 3 * g + d1
    beyond_pb, beyond_qa = twin[p_b], twin[q_a]
    if beyond_pb == q_a:  # the two sides that move are glued to each other
        beyond_pb, beyond_qa = t, h
    twin[h], twin[t] = beyond_pb, beyond_qa
    if beyond_pb >= 0:
        twin[beyond_pb] = h
    if beyond_qa >= 0:
        twin[beyond_qa] = t
    twin[q_a], twin[p_b] = p_b, q_a
    sides[f, c], sides[g, d] = sides[g, d1], sides[f, c1]
    sides[f, c1] = sides[g, d1] = edge
    half_edge[edge] = q_a
    if half_edge[sides[f, c]] == p_b or half_edge[sides[f, c]] == q_a:
        half_edge[sides[f, c]] = h
    if half_edge[sides[g, d]] == q_a or half_edge[sides[g, d]] == p_b:
        half_edge[sides[g, d]] = t
    a, b = faces[f, c], faces[g, d]
    faces[f, c2], faces[g, d2] = b, a
