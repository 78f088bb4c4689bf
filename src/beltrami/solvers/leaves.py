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
    column = _eliminate(inner, outer, place, below)
    parent, columns, top = np.full(m, -1), np.ones(m, np.int64), np.arange(m)
    for k in range(m):
        later, parent[k] = inner[column[k]], m
        while later:
            parent[k] = min(parent[k], place[lowest_bit(later)])
            later &= later - np.uint64(1)
    tree = np.full((m + 1, 2), -1)  # first child and next sibling; m is the parent of the roots
    degree = np.empty(m, np.int64)
    for k in range(m):
        degree[k] = below[column[k]]
    _merge(parent, degree, columns, top, tree)
    return _write(order, low, column, parent, columns, top, tree, ends, parents)


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
def _eliminate(inner: Any, outer: Any, place: Any, below: Any) -> Any:
    """Eliminate where the degree is least: ``place``, and ``below`` the degree at that time.

    ``inner`` and ``outer`` become the rows of each column. Returns the unknowns by their place.
    """
    one, m = np.uint64(1), inner.size
    degree, column = np.empty(m, np.int64), np.empty(m, np.int64)
    for i in range(m):
        degree[i] = count_bits(inner[i]) + count_bits(outer[i])
        place[i] = -1
    for turn in range(m):
        least, i = 1 << 40, 0
        for j in range(m):
            if degree[j] < least:
                least, i = degree[j], j
        place[i], below[i], degree[i], column[turn] = turn, least, 1 << 40, i
        rows, beyond = inner[i], outer[i]
        rest = rows
        while rest:
            j = lowest_bit(rest)
            rest &= rest - one
            inner[j] = (inner[j] | rows) & ~((one << np.uint64(i)) | (one << np.uint64(j)))
            outer[j] |= beyond
            degree[j] = count_bits(inner[j]) + count_bits(outer[j])
    return column


@kernel
def _merge(parent: Any, below: Any, columns: Any, top: Any, tree: Any) -> None:
    """Join columns to blocks: ``top`` becomes the last column of the block of each.

    A block joins its parent where that stores few zeros; ``below`` is the degree of each column.
    The number of ``columns``, the parent and the ``tree`` of a block stand at its last column.
    """
    m = parent.size
    for p in range(m):
        while True:
            fewest, best, before_best = _ZEROS + 1, -1, -1
            before, c = -1, tree[p, 0]
            while c >= 0:
                zeros = columns[c] * (columns[p] + below[p] - below[c])
                if zeros < fewest:
                    fewest, best, before_best = zeros, c, before
                before, c = c, tree[c, 1]
            if best < 0:
                break
            if before_best < 0:
                tree[p, 0] = tree[best, 1]
            else:
                tree[before_best, 1] = tree[best, 1]
            columns[p] += columns[best]
            top[best] = p
            c = tree[best, 0]
            while c >= 0:
                after = tree[c, 1]
                parent[c], tree[c, 1], tree[p, 0] = p, tree[p, 0], c
                c = after
        tree[p, 1], tree[parent[p], 0] = tree[parent[p], 0], p
    for c in range(m - 1, -1, -1):
        top[c] = top[top[c]]


@kernel
def _write(
    order: Any,
    low: int,
    column: Any,
    parent: Any,
    columns: Any,
    top: Any,
    tree: Any,
    ends: Any,
    parents: Any,
) -> Any:
    """Write the blocks one after the other, each after its children; return their number."""
    m = column.size
    number, begin, path = (
        np.empty(m + 1, np.int64),
        np.empty(m, np.int64),
        np.empty(m + 1, np.int64),
    )
    path[0], depth = m, 1
    count = end = 0
    while depth:
        block = path[depth - 1]
        child = tree[block, 0]
        if child >= 0:
            tree[block, 0] = tree[child, 1]
            path[depth] = child
            depth += 1
            continue
        depth -= 1
        number[block] = count
        if block < m:
            begin[block] = end
            end += columns[block]
            ends[count], parents[count] = end, parent[block]
            count += 1
    number[m] = -1
    for k in range(count):
        parents[k] = number[parents[k]]
    old = np.empty(m, order.dtype)
    for k in range(m):
        old[k] = order[low + k]
    for k in range(m):
        to = begin[top[k]]
        order[low + to] = old[column[k]]
        begin[top[k]] += 1
    return count
