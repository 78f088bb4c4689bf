"""Edges numbered: sides that lie in the buckets of their smaller vertices are paired there."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import part_of_kernels
from beltrami.mesh.lanes import LANES, below, bits_in, first_bit, will_write

AHEAD = 48  # sides: how early the memory of their results is asked for
BEHIND = AHEAD + LANES + 2  # words behind the last side, which are read and not used, or scratch
NO_ROOM = np.uint64(2**64 - 1)

# A side is one integer: its larger vertex times 2³², plus its half-edge. In the bucket of a vertex
# those that run upwards, from the smaller to the larger vertex, lie before the others. On an
# oriented manifold each upward side has one downward side with the same larger vertex, but at the
# boundary; there are three of each on average, and they are compared eight at a time. Buckets of
# another kind are sorted: few sides are compared with all of them to tell their places.


@part_of_kernels
def number_edges(
    sides: Any, starts: Any, sizes: Any, room: Any, ends: Any, face_edges: Any, twins: Any
) -> Any:
    """Give the edges their numbers; ``starts[v, 0]`` is where the upward sides of v end.

    ``sides`` begins ``room`` words after ``ends``, in the same memory. Returns (edges, boundary
    edges, edges of more than two faces, edges that both faces run through alike), or -1 for the
    first if the ends of an edge would come to lie on sides not yet read.
    """
    one, free = np.uint64(1), np.uint64(room)
    n = np.uint64(sizes.size)
    low = p = begin = np.uint64(0)
    boundary = crowded = disoriented = np.uint64(0)
    while low < n:
        end, middle = begin + np.uint64(sizes[low]), np.uint64(starts[low, 0])
        free_edges = (free + begin - p - p) >> one  # that may be written before the bucket is read
        bucket = (low, begin, middle, end, p, free_edges)
        size = middle - begin
        if size + size == end - begin and _number_pairs(bucket, sides, ends, face_edges, twins):
            p += size
        else:
            first = _sort(bucket, sides, face_edges, twins)
            p, single, many, alike = _number_sorted(
                bucket, first, sides, free, ends, face_edges, twins
            )
            if p == NO_ROOM:
                return -1, 0, 0, 0
            boundary += single
            crowded += many
            disoriented += alike
        begin = end
        low += one
    return np.int64(p), np.int64(boundary), np.int64(crowded), np.int64(disoriented)


@part_of_kernels
def _number_pairs(bucket: Any, sides: Any, ends: Any, face_edges: Any, twins: Any) -> Any:
    """Pair the sides of a bucket; say whether each upward one has one downward one."""
    low, begin, middle, _, p, free_edges = bucket
    size = middle - begin
    if size > np.uint64(LANES) or size > free_edges:
        return False
    one, half, code = np.uint64(1), np.uint64(32), np.uint64(0xFFFFFFFF)
    word, four = np.uint64(8), np.uint64(4)
    at_sides = np.uint64(sides.ctypes.data)
    at_edges, at_twins = np.uint64(face_edges.ctypes.data), np.uint64(twins.ctypes.data)
    upwards, downwards = at_sides + word * begin, at_sides + word * middle
    inside = (one << size) - one
    seen = np.uint64(0)
    q, soon = begin, begin + np.uint64(AHEAD)
    while q < middle:
        for _ in range(2):
            later = four * (sides[soon] & code)
            will_write(at_edges + later)
            will_write(at_twins + later)
            soon += one
        high, here = sides[q] >> half, sides[q] & code
        bound = high << half
        same = (below(downwards, bound + code + one) ^ below(downwards, bound)) & inside
        if same == np.uint64(0) or same & (same - one):
            return False
        seen |= same
        there = sides[middle + first_bit(same)] & code
        edge = p + bits_in(below(upwards, bound) & inside)
        face_edges[here], twins[here] = edge, there
        face_edges[there], twins[there] = edge, here
        ends[edge + edge], ends[edge + edge + one] = low, high
        q += one
    return seen == inside  # then no two upward sides are the same


@part_of_kernels
def _sort(bucket: Any, sides: Any, face_edges: Any, twins: Any) -> Any:
    """Sort the sides of any bucket: then neighbours are the sides of one edge.

    Returns where they begin: behind all others, if they are few. They are written as their larger
    vertex times 2³² plus twice their half-edge, plus 1 if they run up.
    """
    _, begin, middle, end, _, _ = bucket
    one, word, code = np.uint64(1), np.uint64(8), np.uint64(0xFFFFFFFF)
    lanes, four = np.uint64(LANES), np.uint64(4)
    few = end - begin <= lanes + lanes
    first = np.uint64(sides.size) - lanes - lanes if few else begin
    at_edges, at_twins = np.uint64(face_edges.ctypes.data), np.uint64(twins.ctypes.data)
    address = np.uint64(sides.ctypes.data) + word * begin
    inside = (one << (end - begin)) - one
    q, place, soon = begin, first, begin + np.uint64(AHEAD)
    while q < end:
        side = sides[q]
        if few:
            later = four * (sides[soon] & code)
            will_write(at_edges + later)
            will_write(at_twins + later)
            soon += one
            lower = below(address, side) | (below(address + word * lanes, side) << lanes)
            place = first + bits_in(lower & inside)
        sides[place] = side + (side & code) + np.uint64(q < middle)
        place += one
        q += one
    if not few:
        _sort_many(sides, begin, end)
    return first


@part_of_kernels
def _sort_many(words: Any, begin: Any, end: Any) -> None:
    """Sort a slice in place (Shell's method)."""
    gap = one = np.uint64(1)
    while gap + begin < end:
        gap += gap + one
    while gap:
        q = begin + gap
        while q < end:
            word, r = words[q], q
            while r >= begin + gap and words[r - gap] > word:
                words[r] = words[r - gap]
                r -= gap
            words[r] = word
            q += one
        gap >>= one


@part_of_kernels
def _number_sorted(
    bucket: Any, first: Any, sides: Any, free: Any, ends: Any, face_edges: Any, twins: Any
) -> Any:
    """Give numbers to the edges of a bucket whose sides are sorted, from the place ``first`` on.

    Returns the next number, or ``NO_ROOM``, and how many edges are of which kind.
    """
    low, begin, _, end, p, _ = bucket
    one, half, code = np.uint64(1), np.uint64(32), np.uint64(0xFFFFFFFF)
    boundary = crowded = disoriented = np.uint64(0)
    q, stop = first, first + end - begin
    while q < stop:
        high, side = sides[q] >> half, sides[q] & code
        here, r = side >> one, q + one
        while r < stop and sides[r] >> half == high:
            r += one
        if r - q == one + one:
            other = sides[q + one] & code
            there = other >> one
            face_edges[here], twins[here] = p, there
            face_edges[there], twins[there] = p, here
            disoriented += (side ^ other ^ one) & one
        elif r - q == one:
            face_edges[here], twins[here] = p, -1
            boundary += one
        else:
            crowded += one
            while q < r:
                here = (sides[q] & code) >> one
                face_edges[here], twins[here] = p, -2
                q += one
        q = r
        read = q if first == begin else end
        if p + p + one >= free + read:
            return NO_ROOM, boundary, crowded, disoriented
        ends[p + p], ends[p + p + one] = low, high
        p += one
    return p, boundary, crowded, disoriented
