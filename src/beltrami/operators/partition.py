"""partition_rows: a pair (L, B) cut into blocks of rows, for solvers on many machines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array
from scipy.sparse.csgraph import reverse_cuthill_mckee

from beltrami._arrays import (
    Floats,
    Integers,
    as_function,
    read_only,
    read_only_matrix,
    rectangular,
    whole,
)
from beltrami._kinds import checked
from beltrami.errors import DimensionError, MeshError
from beltrami.mesh.mesh import Mesh
from beltrami.operators.domain import require_laplacian
from beltrami.operators.pair import Laplacian
from beltrami.solvers.bisection import project_on_longest_direction
from beltrami.solvers.ordering import as_positions


@dataclass(frozen=True, eq=False, repr=False)
class RowBlock:
    """The rows of a pair (L, B) that one process owns.

    Unknowns are renumbered so that the rows of a process follow one another, as PETSc, Trilinos
    and hypre have it: process p owns the numbers ``start`` to ``start + len(owned)``.

    Attributes
    ----------
    start
        The new number of the first row.
    n
        How many unknowns there are in all.
    owned : (r,) int
        The vertices of the rows, in the order of the new numbers.
    ghosts : (g,) int
        The new numbers, ascending, of the unknowns of other processes that these rows touch.
    ghost_vertices : (g,) int
        The vertices of the ghosts.
    stiffness, mass : (r, r + g) csr_array
        The rows. Columns count locally: those of the owned unknowns come first, then the ghosts.
    """

    start: int
    n: int
    owned: Integers
    ghosts: Integers
    ghost_vertices: Integers
    stiffness: csr_array
    mass: csr_array

    def __post_init__(self) -> None:
        for array in (self.owned, self.ghosts, self.ghost_vertices):
            read_only(array)
        read_only_matrix(self.stiffness)
        read_only_matrix(self.mass)

    def __repr__(self) -> str:
        end = self.start + len(self.owned)
        return f"<RowBlock: rows {self.start} to {end} of {self.n}, {len(self.ghosts)} ghosts>"

    @property
    def columns(self) -> Integers:
        """(r + g,) the new number of each local column."""
        return np.concatenate([np.arange(self.start, self.start + len(self.owned)), self.ghosts])


def partition_rows(laplacian: Laplacian, parts: ArrayLike) -> tuple[RowBlock, ...]:
    r"""Cut a pair (L, B) into blocks of rows, one for each process of a distributed solver.

    Parameters
    ----------
    laplacian
        The pair.
    parts
        How many blocks, of sizes that differ by one at most; or (n,) the block of each vertex,
        from 0 on, each with at least one.

    Returns
    -------
    tuple of RowBlock
        With what they own and the ghosts that they need; together they are the pair, renumbered.

    Raises
    ------
    DimensionError
        If it is no Laplacian, or the blocks are not given for each vertex.
    MeshError
        If there are more blocks than vertices, or a block is empty.

    Notes
    -----
    A mesh is cut by its positions, again and again across the longest direction of a part; what
    has no positions along the order of Cuthill and McKee. On a surface a block of r rows has of
    the order of :math:`\sqrt r` ghosts. Cost: O(n log parts).

    Examples
    --------
    >>> from beltrami.mesh.shapes import grid
    >>> from beltrami.operators.laplacian import laplacian
    >>> blocks = partition_rows(laplacian(grid(2, 2)), 2)
    >>> blocks
    (<RowBlock: rows 0 to 4 of 9, 4 ghosts>, <RowBlock: rows 4 to 9 of 9, 4 ghosts>)
    >>> blocks[0].owned.tolist(), blocks[0].ghost_vertices.tolist(), blocks[0].stiffness.shape
    ([0, 1, 3, 6], [2, 4, 5, 7], (4, 8))
    """
    pair = require_laplacian(laplacian, "a partition")
    labels = _labels(pair, parts)
    order = np.argsort(labels, kind="stable").astype(np.int64)  # from new numbers to vertices
    number = np.empty_like(order)
    number[order] = np.arange(pair.n)
    ends = np.cumsum(np.bincount(labels))
    starts = np.concatenate([[0], ends[:-1]])
    return tuple(
        _block(pair, order, number, int(start), int(end))
        for start, end in zip(starts, ends, strict=True)
    )


def _labels(pair: Laplacian, parts: ArrayLike) -> Integers:
    """Return the block of each vertex."""
    given = rectangular(parts)
    if given.ndim == 0:
        return _cut(pair, whole("the number of blocks", parts, 1, pair.n))
    if given.shape != (pair.n,) or given.dtype.kind not in "iu":
        raise MeshError(f"the blocks of {pair.n} vertices are as many whole numbers")
    labels = given.astype(np.int64)
    outside = (labels < 0) | (labels >= pair.n)  # a block for each vertex at most
    if outside.any() or (np.bincount(labels) == 0).any():
        raise MeshError("blocks count from 0, and each has a vertex at least")
    return labels


def _cut(pair: Laplacian, parts: int) -> Integers:
    """Cut the vertices into parts of equal sizes that are near together."""
    n = pair.n
    if not isinstance(pair.domain, Mesh):
        labels = np.empty(n, np.int64)
        labels[reverse_cuthill_mckee(pair.stiffness, symmetric_mode=True)] = (
            np.arange(n) * parts // n
        )
        return labels
    x, order = as_positions(pair.domain.vertices, n), np.arange(n)
    labels, key = np.zeros(n, np.int64), np.empty(n)
    waiting = [(0, n, 0, parts)]
    while waiting:
        low, high, first, count = waiting.pop()
        if count == 1:
            labels[order[low:high]] = first
            continue
        left = count // 2
        middle = low + (high - low) * left // count
        project_on_longest_direction(x, order, low, high, key)
        piece = order[low:high]
        order[low:high] = piece[np.argpartition(key[piece], middle - low)]
        waiting += [(low, middle, first, left), (middle, high, first + left, count - left)]
    return labels


def _block(pair: Laplacian, order: Integers, number: Integers, start: int, end: int) -> RowBlock:
    """Take the rows of one process, and number their columns locally."""
    owned = order[start:end]
    rows = [csr_array(matrix[owned]) for matrix in (pair.stiffness, pair.mass)]
    touched = np.unique(np.concatenate([number[matrix.indices] for matrix in rows]))
    ghosts = touched[(touched < start) | (touched >= end)]

    def place(numbers: Integers) -> Integers:
        within = (numbers >= start) & (numbers < end)
        beyond = len(owned) + np.searchsorted(ghosts, numbers)
        return np.where(within, numbers - start, beyond)

    shape = (len(owned), len(owned) + len(ghosts))
    local = [csr_array((m.data, place(number[m.indices]), m.indptr), shape) for m in rows]
    return RowBlock(start, pair.n, owned.copy(), ghosts, order[ghosts], local[0], local[1])


@checked
def gather_rows(blocks: Sequence[RowBlock], values: Sequence[ArrayLike]) -> Floats:
    """Return a function on all vertices from the values that the processes own.

    Parameters
    ----------
    blocks
        As ``partition_rows`` returns them: all of them.
    values
        For each block (r,) or (r, c), in the order of its rows.

    Raises
    ------
    MeshError
        If a block is missing.
    DimensionError, NonFiniteError
        If there are not values for each block and each of its rows, or some are not finite.
    """
    if not len(blocks) or sum(len(block.owned) for block in blocks) != blocks[0].n:
        raise MeshError("a function is put together from all blocks, and some are missing")
    if len(values) != len(blocks):
        raise DimensionError(f"{len(blocks)} blocks need as many arrays, not {len(values)}")
    parts = [
        as_function(part, len(block.owned), "the values of a block")
        for block, part in zip(blocks, values, strict=True)
    ]
    if any(part.shape[1:] != parts[0].shape[1:] for part in parts):
        raise DimensionError("the values of the blocks have different numbers of columns")
    result = np.empty((blocks[0].n, *parts[0].shape[1:]))
    for block, part in zip(blocks, parts, strict=True):
        result[block.owned] = part
    return result
