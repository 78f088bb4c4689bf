"""The order inside a small set: minimum degree, and blocks of columns with nearly the same rows.

A set of at most 64 unknowns fits into the bits of one number, so that an elimination is a few
operations on bits. Neighbours outside of the set, which are eliminated later, count as well.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel

MOST = 64  # unknowns of a leaf
_HALO = 64  # neighbours outside that count; more do not
_ZEROS = 48  # entries that may be stored in vain to have one block less


@kernel
def order_leaf(
    indptr: Any, indices: Any, order: Any, low: int, high: int, slot: Any, ends: Any, parents: Any
) -> Any:
    """Reorder order[low:high], at most 64 unknowns; return into how many blocks.

    Block k ends before column ``ends[k]`` of the leaf; its parent is block ``parents[k]`` of the
    leaf, later than it, or -1. ``slot`` (n,) is -1 before and after; ``ends``, ``parents`` (64,).
    """
    m = high - low
    inner, outer = np.zeros(m, np.uint64), np.zeros(m, np.uint64)
    _join(indptr, indices, order, low, high, slot, inner, outer)
    place, below = np.empty(m, np.int64), np.empty(m, np.int64)
    _eliminate(inner, outer, place, below)
    column = np.empty(m, np.int64)  # eliminated k-th
    for i in range(m):
        column[place[i]] = i
    parent = np.full(m, -1, np.int64)  # all by their turn from here on
    for k in range(m):
        later = inner[column[k]]
        first = m
        while later:
            first = min(first, place[lowest_bit(later)])
            later &= later - np.uint64(1)
        if first < m:
            parent[k] = first
    top = _merge(parent, below[column])
    return _write(order, low, column, parent, top, ends, parents)


@kernel
def count_bits(x: Any) -> Any:
    """Return how many bits of a number of 64 bits are set."""
    two, four = np.uint64(0x3333333333333333), np.uint64(0x0F0F0F0F0F0F0F0F)
    x -= (x >> np.uint64(1)) & np.uint64(0x5555555555555555)
    x = (x & two) + ((x >> np.uint64(2)) & two)
    x = (x + (x >> np.uint64(4))) & four
    return np.int64((x * np.uint64(0x0101010101010101)) >> np.uint64(56))


@kernel
def lowest_bit(x: Any) -> Any:
    """Return the place of the lowest bit that is set."""
    return count_bits((x ^ (x - np.uint64(1))) >> np.uint64(1))


@kernel
def _join(
    indptr: Any, indices: Any, order: Any, low: int, high: int, slot: Any, inner: Any, outer: Any
) -> None:
    """Set the bits of the neighbours of each unknown, inside of the leaf and outside."""
    one = np.uint64(1)
    for t in range(low, high):
        slot[order[t]] = t - low
    beyond = 0
    for t in range(low, high):
        v, i = order[t], t - low
        for q in range(indptr[v], indptr[v + one]):
            w = np.uint64(indices[q])
            if slot[w] < 0 and beyond < _HALO:
                slot[w] = MOST + beyond
                beyond += 1
            at = slot[w]
            if at >= MOST:
                outer[i] |= one << np.uint64(at - MOST)
            elif at >= 0 and at != i:
                inner[i] |= one << np.uint64(at)
    for t in range(low, high):
        v = order[t]
        slot[v] = -1
        for q in range(indptr[v], indptr[v + one]):
            slot[np.uint64(indices[q])] = -1


@kernel
def _eliminate(inner: Any, outer: Any, place: Any, below: Any) -> None:
    """Eliminate where the degree is least: ``place``, and ``below`` the degree at that time.

    ``inner`` and ``outer`` become the rows of each column.
    """
    one, m = np.uint64(1), inner.size
    degree = np.empty(m, np.int64)
    for i in range(m):
        degree[i] = count_bits(inner[i]) + count_bits(outer[i])
        place[i] = -1
    for turn in range(m):
        least, i = 1 << 40, 0
        for j in range(m):
            if degree[j] < least:
                least, i = degree[j], j
        place[i], below[i], degree[i] = turn, least, 1 << 40
        rows, beyond = inner[i], outer[i]
        rest = rows
        while rest:
            j = lowest_bit(rest)
            rest &= rest - one
            inner[j] = (inner[j] | rows) & ~((one << np.uint64(i)) | (one << np.uint64(j)))
            outer[j] |= beyond
            degree[j] = count_bits(inner[j]) + count_bits(outer[j])


@kernel
def _merge(parent: Any, below: Any) -> Any:
    """Join columns to blocks: return the last column of the block of each.

    A block joins its parent where that stores few zeros; ``below`` is the degree of each column.
    """
    m = parent.size
    top, columns = np.arange(m), np.ones(m, np.int64)
    for p in range(m):
        while True:
            fewest, best = _ZEROS + 1, -1
            for c in range(p):
                if top[c] == c and parent[c] == p:
                    zeros = columns[c] * (columns[p] + below[p] - below[c])
                    if zeros < fewest:
                        fewest, best = zeros, c
            if best < 0:
                break
            columns[p] += columns[best]
            for c in range(best + 1):
                if top[c] == best:
                    top[c] = p
                if top[c] == c and parent[c] == best:
                    parent[c] = p
            parent[best] = -2  # no block any more
    return top


@kernel
def _write(
    order: Any, low: int, column: Any, parent: Any, top: Any, ends: Any, parents: Any
) -> Any:
    """Write the blocks one after the other, each after its children; return their number."""
    m = column.size
    old, number = np.empty(m, order.dtype), np.full(m, -1, np.int64)
    for k in range(m):
        old[k] = order[low + column[k]]
    waiting, path = np.full(m, -1, np.int64), 0
    count = end = 0
    for root in range(m):
        if top[root] != root or parent[root] != -1:
            continue
        waiting[0], path = root, 1
        while path:
            block = waiting[path - 1]
            child = block - 1  # the next of its children, from the last on, that is not written
            while child >= 0 and not (
                top[child] == child and parent[child] == block and number[child] < 0
            ):
                child -= 1
            if child >= 0:
                waiting[path] = child
                path += 1
                continue
            for k in range(block + 1):
                if top[k] == block:
                    order[low + end] = old[k]
                    end += 1
            ends[count], number[block] = end, count
            count += 1
            path -= 1
    for k in range(m):
        if number[k] >= 0:
            parents[number[k]] = number[parent[k]] if parent[k] >= 0 else -1
    return count
