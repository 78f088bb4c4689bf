"""The pattern of a sparse matrix with two unknowns at each vertex that is free to move."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from beltrami._arrays import Booleans, Floats, Integers
from beltrami._jit import kernel
from beltrami.mesh.edge_matrix import symmetric_matrix
from beltrami.mesh.mesh import Mesh


@dataclass(frozen=True, eq=False)
class BlockPattern:
    """Where the 2 x 2 blocks of vertices and edges stand among the entries of a csc_array.

    Attributes
    ----------
    number : (n,) int
        The number of each vertex among those that are free, or -1.
    indptr, indices : int32
        The pattern of the matrix.
    widths : (free,) int
        Entries of each of the two columns of a free vertex.
    vertex_slots : (free,) int, edge_slots : (p, 2) int
        The first entry of the block of a vertex; of the block of an edge in the column of its
        first end, and of its second; -1 if one of them is held. Entry (b, a) of a block is at
        slot + a width + b.
    """

    number: Integers
    indptr: NDArray[np.int32]
    indices: NDArray[np.int32]
    widths: Integers
    vertex_slots: Integers
    edge_slots: Integers

    @property
    def size(self) -> int:
        """Unknowns: two for each free vertex."""
        return len(self.indptr) - 1

    def matrix(self, data: Floats) -> csc_array:
        """Return the matrix with these entries."""
        made = csc_array((data, self.indices, self.indptr), shape=(self.size, self.size))
        made.has_canonical_format = True  # known: scipy need not look
        return made


def block_pattern(mesh: Mesh, free: Booleans) -> BlockPattern:
    """Return the pattern for the vertices that are free: those joined by an edge meet; O(n)."""
    number = np.where(free, np.cumsum(free) - 1, -1)
    count = int(free.sum())
    ends = number[mesh.edges]
    inner = np.flatnonzero((ends >= 0).all(axis=1))
    known = symmetric_matrix(ends[inner], inner.astype(np.float64) + 1, count, np.zeros(count))
    size = 4 * len(known.data)
    indptr, indices = np.zeros(2 * count + 1, np.int32), np.empty(size, np.int32)
    vertex_slots, edge_slots = np.zeros(count, np.int64), np.full((len(mesh.edges), 2), -1)
    _expand(known.indptr, known.indices, known.data, indptr, indices, vertex_slots, edge_slots)
    widths = 2 * np.diff(known.indptr).astype(np.int64)
    return BlockPattern(number, indptr, indices, widths, vertex_slots, edge_slots)


@kernel
def _expand(
    starts: Any, rows: Any, edges: Any, indptr: Any, indices: Any, vertices: Any, slots: Any
) -> None:
    """Double rows and columns; ``edges`` holds the edge of each entry from 1 on, 0 for vertices."""
    for i in range(starts.size - 1):
        first, count = 4 * starts[i], starts[i + 1] - starts[i]
        for a in range(2):
            indptr[2 * i + a + 1] = first + 2 * count * (a + 1)
            for q in range(count):
                for b in range(2):
                    indices[first + 2 * count * a + 2 * q + b] = 2 * rows[starts[i] + q] + b
        for q in range(count):
            edge = np.int64(edges[starts[i] + q]) - 1
            if edge < 0:
                vertices[i] = first + 2 * q
            else:
                slots[edge, 0 if i < rows[starts[i] + q] else 1] = first + 2 * q
