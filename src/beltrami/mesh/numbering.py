"""Edges numbered: sides that lie in the buckets of their smaller vertices are paired there."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel
from beltrami.mesh.lanes import LANES, below, bits_in, first_bit, will_write

AHEAD = 48  # sides: how early the memory of their results is asked for
BEHIND = AHEAD + LANES + 2  # words that are read, and not used, behind the last side

# A side is one integer: its larger vertex times 2³², plus its half-edge. In the bucket of a vertex
# those that run upwards, from the smaller to the larger vertex, lie before the others. Buckets are
# of three kinds. On an oriented manifold each upward side has one downward side with the same
# larger vertex, but at the boundary; there are three of each on average, and they are compared
# eight at a time. Few sides of any kind are compared with all of them. The rest are sorted.


@kernel
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
    boundary = crowded = disoriented = np.int64(0)
    while low < n:
        end, middle = begin + np.uint64(sizes[low]), np.uint64(starts[low, 0])
        free_edges = (free + begin - p - p) >> one  # that may be written before the bucket is read
        bucket = (low, begin, middle, end, p, free_edges)
        size = middle - begin
        if size + size == end - begin and _number_pairs(bucket, sides, ends, face_edges, twins):
            p += size
        else:
            edges, single, many, alike = _number_few(bucket, sides, ends, face_edges, twins)
            if edges < 0:
                edges, single, many, alike = _number_sorted(
                    bucket, sides, free, ends, face_edges, twins
                )
            if edges < 0:
                return -1, 0, 0, 0
            p += np.uint64(edges)
            boundary += single
            crowded += many
            disoriented += alike
        begin = end
        low += one
    return np.int64(p), boundary, crowded, disoriented


@kernel
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


@kernel
def _among(address: Any, bound: Any) -> Any:
    """Compare two times eight words with a bound."""
    lanes, word = np.uint64(LANES), np.uint64(8)
    return below(address, bound) | (below(address + lanes * word, bound) << lanes)


@kernel
def _number_few(bucket: Any, sides: Any, ends: Any, face_edges: Any, twins: Any) -> Any:
    """Compare each side with all, in a bucket of any kind; -1 if there are too many of them."""
    low, begin, middle, end, p, free_edges = bucket
    one, half, code = np.uint64(1), np.uint64(32), np.uint64(0xFFFFFFFF)
    size = end - begin
    if size > np.uint64(2 * LANES):
        return -1, 0, 0, 0
    four = np.uint64(4)
    at_edges, at_twins = np.uint64(face_edges.ctypes.data), np.uint64(twins.ctypes.data)
    address = np.uint64(sides.ctypes.data) + np.uint64(8) * begin
    inside, upwards = (one << size) - one, (one << (middle - begin)) - one
    firsts, bit = np.uint64(0), one  # the first side of each edge
    q, soon = begin, begin + np.uint64(AHEAD)
    while q < end:
        later = four * (sides[soon] & code)
        will_write(at_edges + later)
        will_write(at_twins + later)
        soon += one
        bound = sides[q] & ~code
        same = (_among(address, bound + code + one) ^ _among(address, bound)) & inside
        firsts |= bit * np.uint64(same & (bit - one) == np.uint64(0))
        bit += bit
        q += one
    edges = bits_in(firsts)
    if edges > free_edges:
        return -1, 0, 0, 0
    boundary = crowded = disoriented = np.int64(0)
    q, bit = begin, one
    while q < end:
        bound, here = sides[q] & ~code, sides[q] & code
        less = _among(address, bound) & inside
        same = (_among(address, bound + code + one) & inside) ^ less
        edge, faces = p + bits_in(less & firsts), bits_in(same)
        face_edges[here] = edge
        twins[here] = -1 if faces == one else -2
        if faces == one + one:
            twins[here] = sides[begin + first_bit(same ^ bit)] & code
        if firsts & bit:
            ends[edge + edge], ends[edge + edge + one] = low, bound >> half
            boundary += np.int64(faces == one)
            crowded += np.int64(faces > one + one)
            disoriented += np.int64(faces == one + one and bits_in(same & upwards) != one)
        bit += bit
        q += one
    return np.int64(edges), boundary, crowded, disoriented


@kernel
def _number_sorted(
    bucket: Any, sides: Any, free: Any, ends: Any, face_edges: Any, twins: Any
) -> Any:
    """Sort the sides of any bucket: then neighbours are the sides of one edge.

    Here a side is its larger vertex times 2³² plus twice its half-edge, plus 1 if it runs up.
    """
    low, begin, middle, end, p, _ = bucket
    before = p
    one, half, code = np.uint64(1), np.uint64(32), np.uint64(0xFFFFFFFF)
    q = begin
    while q < end:
        sides[q] += (sides[q] & code) + np.uint64(q < middle)
        q += one
    _sort(sides, begin, end)
    boundary = crowded = disoriented = np.int64(0)
    q = begin
    while q < end:
        high, first = sides[q] >> half, sides[q] & code
        face_edges[first >> one] = p
        start = q
        q += one
        if q < end and sides[q] >> half == high:
            second = sides[q] & code
            face_edges[second >> one] = p
            twins[first >> one] = second >> one
            twins[second >> one] = first >> one
            q += one
            if q < end and sides[q] >> half == high:
                crowded += 1
                while q < end and sides[q] >> half == high:
                    face_edges[(sides[q] & code) >> one] = p
                    q += one
                for s in range(start, q):
                    twins[(sides[s] & code) >> one] = -2
            else:
                disoriented += np.int64((first ^ second ^ one) & one)
        else:
            boundary += 1
            twins[first >> one] = -1
        if p + p + one >= free + q:
            return -1, 0, 0, 0
        ends[p + p] = low
        ends[p + p + one] = high
        p += one
    return np.int64(p - before), boundary, crowded, disoriented


@kernel
def _sort(words: Any, begin: Any, end: Any) -> None:
    """Sort a slice in place (Shell's method): few words as a rule, but perhaps many."""
    gap, one, three = np.uint64(1), np.uint64(1), np.uint64(3)
    while gap * three + begin < end:
        gap = gap * three + one
    while gap:
        q = begin + gap
        while q < end:
            word, r = words[q], q
            while r >= begin + gap and words[r - gap] > word:
                words[r] = words[r - gap]
                r -= gap
            words[r] = word
            q += one
        gap //= three
