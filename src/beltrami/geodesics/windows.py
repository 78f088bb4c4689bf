"""Windows: intervals of edges that see one source along straight lines, carried face by face."""

from __future__ import annotations

import heapq
from typing import Any

import numpy as np

from beltrami._jit import kernel

_SLACK = 1 - 1e-12  # a way is shorter if it is so by more than rounding
_THIN = 1e-13  # of an edge: narrower windows see nothing that their neighbours do not

# A window on the half-edge h, about to enter its face, is (key, h, b0, b1, x, y, sigma): in the
# plane of the face, with the start of h in the origin and its end on the x-axis, the image of the
# source is (x, -y), y >= 0; it sees [b0, b1]; sigma is the length of the path to it, and key the
# shortest way to the interval. A vertex v that sends out rays is (distance, -1 - v, 0 ...).


@kernel
def carry_windows(
    faces: Any,
    twin: Any,
    sides: Any,
    dots: Any,
    double: Any,
    starts: Any,
    around: Any,
    turning: Any,
    sources: Any,
    distance: Any,
) -> int:
    """Lower the distances of the vertices to the exact ones; return the number of windows.

    Parameters
    ----------
    faces, twin, sides, dots, double
        The triangulation: vertices (m, 3), twins (3m,), lengths of the sides and dot products at
        the corners (m, 3), twice the areas (m,).
    starts, around
        The faces around each vertex, as the arrays of a CSR matrix.
    turning
        (n,) whether paths may turn at a vertex.
    sources
        Vertices at distance 0.
    distance
        (n,) lengths of some path to each vertex; lowered in place.
    """
    queue = [(0.0, -1 - int(sources[0]), 0.0, 0.0, 0.0, 0.0, 0.0)]
    for s in sources[1:]:
        queue.append((0.0, -1 - int(s), 0.0, 0.0, 0.0, 0.0, 0.0))
    for v in range(turning.size):
        if turning[v] and distance[v] > 0 and distance[v] < np.inf:
            queue.append((distance[v], -1 - v, 0.0, 0.0, 0.0, 0.0, 0.0))
    heapq.heapify(queue)
    sent = np.full(turning.size, np.inf)
    count = 0
    while len(queue):
        key, h, b0, b1, x, y, sigma = heapq.heappop(queue)
        if h < 0:
            v = -1 - h
            if key <= distance[v] and key < sent[v]:
                sent[v] = key
                send_rays(
                    v, faces, twin, sides, dots, double, starts, around, turning, distance, queue
                )
        elif not is_useless(h, b0, b1, x, y, sigma, faces, twin, sides, dots, double, distance):
            count += 1
            carry(
                h, b0, b1, x, y, sigma, faces, twin, sides, dots, double, turning, distance, queue
            )
    return count


@kernel
def send_rays(
    v: Any, faces: Any, twin: Any, sides: Any, dots: Any, double: Any,
    starts: Any, around: Any, turning: Any, distance: Any, queue: Any,
) -> None:  # fmt: skip
    """Go from a vertex along its edges, and through the whole opposite side of each face."""
    here = distance[v]
    for q in range(starts[v], starts[v + 1]):
        f = np.int64(around[q])
        c = 0
        while faces[f, c] != v:
            c += 1
        for k in range(1, 3):
            reach(faces[f, (c + k) % 3], here + sides[f, (c + 3 - k) % 3], turning, distance, queue)
        length = sides[f, c]
        x, y = dots[f, (c + 1) % 3] / length, double[f] / length
        hand_over(
            3 * f + c, 0.0, length, x, y, here, faces, twin, sides, dots, double, distance, queue
        )


@kernel
def reach(v: Any, way: float, turning: Any, distance: Any, queue: Any) -> None:
    """Note a way to a vertex; if it is the shortest, and paths may turn there, send out rays."""
    if way < distance[v]:
        distance[v] = way
        if turning[v]:
            heapq.heappush(queue, (way, -1 - int(v), 0.0, 0.0, 0.0, 0.0, 0.0))


@kernel
def carry(
    h: Any, b0: float, b1: float, x: float, y: float, sigma: float,
    faces: Any, twin: Any, sides: Any, dots: Any, double: Any,
    turning: Any, distance: Any, queue: Any,
) -> None:  # fmt: skip
    """Carry a window through its face: to the apex, and to the two other sides."""
    f, c = h // 3, h % 3
    c1, c2 = (c + 1) % 3, (c + 2) % 3
    length, left, right = sides[f, c], sides[f, c2], sides[f, c1]
    apex, height = dots[f, c1] / length, double[f] / length
    cut = x + (apex - x) * y / (y + height)  # where the line to the apex crosses the edge
    bend = min(max(cut, b0), b1)  # a path that is real in any case
    way = sigma + np.hypot(bend - x, y) + np.hypot(apex - bend, height)
    reach(faces[f, c], way, turning, distance, queue)
    if b0 < cut:  # the side from the start to the apex; its half-edge runs back
        u, v = apex / left, height / left
        s0 = meet(b0, x, y, u, v, left)
        s1 = left if cut <= b1 else meet(b1, x, y, u, v, left)
        along, off = x * u - y * v, max(x * v + y * u, 0.0)
        hand_over(
            3 * f + c2, left - s1, left - s0, left - along, off, sigma,
            faces, twin, sides, dots, double, distance, queue,
        )  # fmt: skip
    if cut < b1:  # the side from the end to the apex, the mirror image
        u, v = (length - apex) / right, height / right
        s0 = meet(length - b1, length - x, y, u, v, right)
        s1 = right if cut >= b0 else meet(length - b0, length - x, y, u, v, right)
        along, off = (length - x) * u - y * v, max((length - x) * v + y * u, 0.0)
        hand_over(
            3 * f + c1, s0, s1, along, off, sigma,
            faces, twin, sides, dots, double, distance, queue,
        )  # fmt: skip


@kernel
def meet(b: float, x: float, y: float, u: float, v: float, length: float) -> float:
    """Where the ray from (x, -y) through (b, 0) meets the side from the origin along (u, v)."""
    below = u * y + v * (x - b)
    if b <= 0 or y <= 0:
        return 0.0
    if below <= 0:
        return length
    return min(y * b / below, length)


@kernel
def hand_over(
    s: Any, b0: float, b1: float, x: float, y: float, sigma: float,
    faces: Any, twin: Any, sides: Any, dots: Any, double: Any, distance: Any, queue: Any,
) -> None:  # fmt: skip
    """Give what the side s of a face lets through, in its own coordinates, to the face across."""
    h = np.int64(twin[s])
    length = sides[s // 3, s % 3]
    if h < 0 or b1 - b0 <= _THIN * length:
        return
    if faces[h // 3, (h % 3 + 1) % 3] != faces[s // 3, (s % 3 + 1) % 3]:  # oriented alike
        b0, b1, x = length - b1, length - b0, length - x
    if is_useless(h, b0, b1, x, y, sigma, faces, twin, sides, dots, double, distance):
        return
    near = min(max(x, b0), b1)
    key = sigma + np.hypot(near - x, y)
    heapq.heappush(queue, (key, h, b0, b1, x, y, sigma))


@kernel
def is_useless(
    h: Any, b0: float, b1: float, x: float, y: float, sigma: float,
    faces: Any, twin: Any, sides: Any, dots: Any, double: Any, distance: Any,
) -> bool:  # fmt: skip
    """Whether all that a window sees is nearer through a vertex of the face that it comes from.

    Through an end of the edge, if that is so for the far end of the interval; through the third
    vertex W, if it is so for the end of the interval on the side of W where the rays come in,
    because they all cross the line from W to there.
    """
    f, c = h // 3, h % 3
    length = sides[f, c]
    to_b0, to_b1 = sigma + np.hypot(b0 - x, y), sigma + np.hypot(b1 - x, y)
    if distance[faces[f, (c + 1) % 3]] + b1 < to_b1 * _SLACK:
        return True
    if distance[faces[f, (c + 2) % 3]] + (length - b0) < to_b0 * _SLACK:
        return True
    t = np.int64(twin[h])
    g, d = t // 3, t % 3
    alike = faces[g, (d + 1) % 3] != faces[f, (c + 1) % 3]
    third = dots[g, (d + 2) % 3 if alike else (d + 1) % 3] / length
    depth = double[g] / length
    middle = (b0 + b1) / 2
    turn = (middle - x) * (y - depth) - y * (third - x)
    end = b1 if turn > 0 else b0
    straight = to_b1 if turn > 0 else to_b0
    return bool(
        turn != 0 and distance[faces[g, d]] + np.hypot(end - third, depth) < straight * _SLACK
    )
