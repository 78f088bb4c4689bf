"""Cells of faces: hanging together, and each one a disk (l. 657)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from beltrami._arrays import Booleans, Floats, Integers
from beltrami._jit import kernel
from beltrami.mesh.connectivity import component_labels
from beltrami.mesh.fans import group_corners
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology


@dataclass(frozen=True, eq=False)
class Neighbours:
    """Pairs of faces with a common edge of a manifold.

    Attributes
    ----------
    pairs : (q, 2) int
        The faces.
    steps : (q,) float
        The way from the middle of one face through the middle of the edge to that of the other.
    edges : (q,) float
        The length of the edge.
    areas : (m,) float
        The areas of the faces.
    """

    pairs: Integers
    steps: Floats
    edges: Floats
    areas: Floats

    @classmethod
    def of(cls, mesh: Mesh) -> Neighbours:
        """Collect the inner edges, each once."""
        half, _, _ = shared = mesh.topology.face_pairs
        pairs = shared.faces
        corners = np.stack([(half + 1) % 3, (half + 2) % 3], axis=1)
        ends = mesh.vertices[mesh.faces[half[:, None] // 3, corners]]
        middle = ends.mean(axis=1)
        centres = mesh.vertices[mesh.faces].mean(axis=1)[pairs]
        steps = np.linalg.norm(centres - middle[:, None], axis=2).sum(axis=1)
        lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        return cls(pairs, steps, lengths, mesh.face_areas)

    def within(self, labels: Integers) -> Booleans:
        """Say which pairs lie in one cell."""
        return np.asarray(labels[self.pairs[:, 0]] == labels[self.pairs[:, 1]])

    def graph(self, kept: Booleans) -> csr_array:
        """Return the symmetric matrix of the steps between the pairs that are kept."""
        f, g = self.pairs[kept].T
        steps = np.maximum(self.steps[kept], np.finfo(np.float64).tiny)
        m = len(self.areas)
        entries = (np.tile(steps, 2), (np.concatenate([f, g]), np.concatenate([g, f])))
        return csr_array(entries, shape=(m, m))


def hanging_together(labels: Integers, near: Neighbours) -> Integers:
    """Return labels of cells that hang together by edges: lonely faces go to a neighbour.

    Of each cell the piece with the most area remains. The others go, those at the border first,
    to the cell with which they have the longest common border; a component that would be left
    without a cell keeps its largest piece. Each round places a piece at least, so there are not
    more rounds than pieces.
    """
    m = len(labels)
    piece = component_labels(near.pairs[near.within(labels)], m)
    count = int(piece.max()) + 1
    area = np.bincount(piece, near.areas, count).astype(np.float64)
    owner = np.empty(count, np.int64)
    owner[piece] = labels
    kept = np.zeros(count, np.bool_)
    kept[largest_of_each(owner, area)] = True
    whole = np.empty(count, np.int64)
    whole[piece] = component_labels(near.pairs, m)
    for component in np.setdiff1d(whole, whole[kept]):
        own = np.flatnonzero(whole == component)
        kept[own[area[own].argmax()]] = True
    cell = np.where(kept, np.arange(count), -1)
    between = np.sort(piece[near.pairs], axis=1)
    while (cell < 0).any():
        ways = np.concatenate([between, between[:, ::-1]])
        border = np.tile(near.edges, 2)
        open_ways = (cell[ways[:, 0]] < 0) & (cell[ways[:, 1]] >= 0)
        keys, turn = np.unique(
            np.stack([ways[open_ways, 0], cell[ways[open_ways, 1]]], axis=1),
            axis=0,
            return_inverse=True,
        )
        common = np.bincount(turn.ravel(), border[open_ways], len(keys)).astype(np.float64)
        longest = largest_of_each(keys[:, 0], common)
        cell[keys[longest, 0]] = keys[longest, 1]
    return cell[piece]


def largest_of_each(groups: Integers, values: Floats) -> Integers:
    """Return the place of the largest value of each group, the first of equal ones."""
    order = np.lexsort([np.arange(len(groups)), -values, groups])
    first = np.ones(len(order), np.bool_)
    first[1:] = groups[order][1:] != groups[order][:-1]
    return np.asarray(order[first])


def are_disks(topology: Topology, labels: Integers) -> Booleans:
    """Say of each cell of a manifold whether its faces are a disk, if they hang together.

    The Euler characteristic of the faces of a cell, glued along their common edges, is that of a
    disk and of nothing else that is connected and oriented and has a boundary: 1. And the cell
    touches itself in no vertex, so that it is a disk as a part of the surface, too.
    """
    count = int(labels.max(initial=-1)) + 1
    twins = topology.twins
    other = labels[np.where(twins >= 0, twins, 0) // 3]
    outer = (twins < 0) | (other != labels[:, None])
    root = group_corners(topology.faces, np.where(outer, np.int32(-1), twins), topology.n_vertices)
    fans = np.unique(root.root)
    V = np.bincount(labels[fans // 3], minlength=count)
    F = np.bincount(labels, minlength=count)
    border = np.bincount(labels, outer.sum(axis=1), count).astype(np.int64)
    chi = V - (3 * F + border) // 2 + F
    keys = np.unique(topology.faces.astype(np.int64) * count + labels[:, None])
    apart = np.bincount(keys % count, minlength=count) == V
    return np.asarray((chi == 1) & (border > 0) & apart)


def halved(labels: Integers, near: Neighbours, chosen: Booleans) -> Integers:
    """Cut the chosen cells, which hang together, in two that hang together.

    Each face goes with the nearer one of two faces that are far from each other, along the way
    through the faces. Cells of one face stay. The halves with the second face get new labels.
    """
    count = len(chosen)
    own = chosen[labels]
    graph = near.graph(near.within(labels) & own[near.pairs[:, 0]])
    sizes = np.bincount(labels, minlength=count)
    cells = np.flatnonzero(chosen & (sizes > 1))
    _, start = np.unique(labels, return_index=True)
    present = np.unique(labels)
    first = start[np.searchsorted(present, cells)]
    inside = np.isin(labels, cells)
    for _ in range(2):
        distance = dijkstra(graph, directed=True, indices=first, min_only=True)
        second = first
        first = np.flatnonzero(inside)[largest_of_each(labels[inside], distance[inside])]
    _, _, source = dijkstra(
        graph,
        directed=True,
        indices=np.concatenate([second, first]),
        min_only=True,
        return_predecessors=True,
    )
    fresh = np.full(count, -1)
    fresh[cells] = count + np.arange(len(cells))
    moved = inside & np.isin(source, first)
    return np.where(moved, fresh[labels], labels)


def into_disks(labels: Integers, topology: Topology, near: Neighbours) -> tuple[Integers, int]:
    """Halve the cells that are no disks until all are; return the labels and how many were cut.

    Both halves of a cell are smaller, and a face is a disk: this ends.
    """
    cut = 0
    while True:
        bad = ~are_disks(topology, labels)
        bad[np.bincount(labels, minlength=len(bad)) == 0] = False
        if not bad.any():
            return labels, cut
        cut += int(bad.sum())
        labels = halved(labels, near, bad)


def smoothed(labels: Integers, mesh: Mesh) -> Integers:
    """Return labels with shorter borders: a face moves to a cell with which it has more border.

    Each move makes the whole border shorter, so this ends. A face that moves has one neighbour of
    its own cell at most, but not none: cells go on hanging together, and none vanishes.
    """
    x = mesh.vertices[mesh.faces]
    lengths = np.linalg.norm(np.roll(x, -1, axis=1) - np.roll(x, -2, axis=1), axis=2)
    labels = labels.copy()
    _move_faces(labels, mesh.topology.twins, lengths)
    return labels


@kernel
def _move_faces(labels: Any, twins: Any, lengths: Any) -> None:
    """Go through the faces until none moves."""
    moved = True
    while moved:
        moved = False
        for f in range(labels.size):
            own = 0.0
            around = 0.0
            for c in range(3):
                around += lengths[f, c]
                if twins[f, c] >= 0 and labels[twins[f, c] // 3] == labels[f]:
                    own += lengths[f, c]
            if own == 0.0:
                continue
            best, most = labels[f], own
            for c in range(3):
                if twins[f, c] < 0:
                    continue
                other = labels[twins[f, c] // 3]
                if other == labels[f]:
                    continue
                common = 0.0
                for d in range(3):
                    if twins[f, d] >= 0 and labels[twins[f, d] // 3] == other:
                        common += lengths[f, d]
                if common > most + 1e-9 * around:
                    best, most = other, common
            if best != labels[f]:
                labels[f] = best
                moved = True


def merged(labels: Integers, mesh: Mesh, near: Neighbours, count: int) -> Integers:
    """Join cells that are disks to larger disks, while there are more than ``count``.

    Those come first whose union has the shortest border: small ones with much in common. Two
    disks with no more in common than one path make a disk, and what they have in common is a path
    if it has one vertex more than edges and any edge.
    """
    while True:
        labels = np.unique(labels, return_inverse=True)[1].ravel()
        cells = int(labels.max()) + 1
        if cells <= count:
            return labels
        pairs, common = _joinable(labels, mesh.faces, near, cells)
        borders = _borders(labels, mesh, cells)
        pairs = pairs[np.argsort(borders[pairs].sum(axis=1) - 2 * common, kind="stable")]
        taken = np.zeros(cells, np.bool_)
        target = np.arange(cells)
        left = cells
        for a, b in pairs.tolist():
            if left > count and not taken[a] and not taken[b]:
                taken[[a, b]] = True
                target[b] = a
                left -= 1
        if left == cells:
            return labels
        labels = target[labels]


def _borders(labels: Integers, mesh: Mesh, cells: int) -> Floats:
    """Return the length of the border of each cell."""
    twins = mesh.topology.twins
    outer = (twins < 0) | (labels[np.where(twins >= 0, twins, 0) // 3] != labels[:, None])
    lengths = mesh.edge_lengths[mesh.topology.face_edges]
    return np.asarray(np.bincount(labels, (lengths * outer).sum(axis=1), cells))


def _joinable(
    labels: Integers, faces: Integers, near: Neighbours, cells: int
) -> tuple[Integers, Floats]:
    """Return the pairs of disks that make a disk together, and the length they have in common."""
    across = np.sort(labels[near.pairs], axis=1)
    apart = across[:, 0] < across[:, 1]
    keys, turn, edges = np.unique(
        across[apart, 0] * cells + across[apart, 1], return_inverse=True, return_counts=True
    )
    lengths = np.bincount(turn.ravel(), near.edges[apart], len(keys))
    ends = np.unique(faces.astype(np.int64) * cells + labels[:, None])
    vertex, cell = ends // cells, ends % cells
    common = []
    step = 1  # the cells around a vertex are neighbours in the sorted list
    while True:
        same = np.flatnonzero(vertex[step:] == vertex[:-step])
        if not len(same):
            break
        common.append(cell[same] * cells + cell[same + step])
        step += 1
    met, vertices = np.unique(np.concatenate([*common, keys[:0]]), return_counts=True)
    good = vertices[np.searchsorted(met, keys)] == edges + 1
    return np.stack([keys[good] // cells, keys[good] % cells], axis=1), lengths[good]
