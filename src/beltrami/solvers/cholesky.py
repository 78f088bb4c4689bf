"""Our own sparse Cholesky factorisation, P D A D P' = L L', for symmetric positive definite A.

D is the nearest scaling by powers of two to a unit diagonal, which is exact and makes pivots
comparable; P orders by nested dissection; L is made of dense panels (``elimination``).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray
from scipy.sparse import csc_array

from beltrami._arrays import Floats, Integers
from beltrami.errors import NotPositiveDefiniteError, SingularMatrixError
from beltrami.solvers.blas import blas
from beltrami.solvers.elimination import Elimination
from beltrami.solvers.fronts import ROOM, factorize_fronts
from beltrami.solvers.many import (
    ONE,
    TWO,
    enter_many,
    leave_many,
    lines_for,
    solve_many,
    solve_many_transposed,
)
from beltrami.solvers.one import solve_one, solve_one_transposed

_BLOCK = 64  # right-hand sides that are solved for at a time
_WHOLE = 8  # of them are a line of the cache
_ROUNDING = {"float64": 1e-12, "float32": 1e-4}  # pivots smaller than this may be zero in truth


@dataclass(frozen=True, eq=False)
class Cholesky:
    """The factor L, with the order and the scaling; for indefinite A also with signs, L S L'.

    Attributes
    ----------
    elimination
        The shape of L, and the order.
    values
        The panels, in float64 or float32.
    scale
        (n,) powers of two, in the order of the matrix.
    signs
        (n,) of the pivots, in the order of elimination; None if all are positive.
    """

    elimination: Elimination
    values: NDArray[Any]
    scale: Floats
    signs: Floats | None = None

    @property
    def fill(self) -> int:
        """Number of entries of L, zeros inside its panels included."""
        return self.elimination.entries

    @property
    def memory(self) -> int:
        """Bytes of L and of its pattern."""
        shape = self.elimination
        pattern = (shape.order, shape.place, shape.starts, shape.row_starts, shape.rows)
        return self.values.nbytes + sum(array.nbytes for array in (*pattern, shape.panels))

    @cached_property
    def pivots(self) -> Floats:
        """(n,) sizes of the pivots: the diagonal of L squared, in the order of elimination."""
        shape = self.elimination
        columns = np.diff(shape.starts)
        height = columns + np.diff(shape.row_starts)
        block = np.repeat(np.arange(len(columns)), columns)
        inside = np.arange(len(shape.order)) - shape.starts[block]
        diagonal = self.values[shape.panels[block] + inside * (height[block] + 1)]
        return np.asarray(diagonal, dtype=np.float64) ** 2

    def logdet(self) -> float:
        """Return log abs det A."""
        return float(np.log(self.pivots).sum() - 2 * np.log(self.scale).sum())

    @property
    def inertia(self) -> tuple[int, int]:
        """Numbers of positive and of negative pivots, which are those of eigenvalues."""
        negative = 0 if self.signs is None else int((self.signs < 0).sum())
        return len(self.scale) - negative, negative

    def solve(self, b: Floats) -> Floats:
        """Return x with A x = b, for (n,) or (n, c)."""
        if b.ndim == 1 or b.shape[1] == 1:
            return self._solve_one(b.ravel()).reshape(b.shape)
        right, c = np.ascontiguousarray(b), b.shape[1]
        if self.signs is None and self.values.itemsize == 8 and c and c % _WHOLE == 0:
            return self._solve_in_place(right)
        x = np.empty(b.shape)
        blocks = -(-c // _BLOCK)
        width = -(-c // max(blocks, 1))
        room = lines_for(len(x), width, self.values.dtype)
        for j in range(0, c, max(width, 1)):
            self._solve_many(right, j, min(width, c - j), room, x)
        return x

    @property
    def _panels(self) -> tuple[NDArray[Any], Integers, Integers, NDArray[np.int32], Integers]:
        shape = self.elimination
        return self.values, shape.starts, shape.row_starts, shape.rows, shape.panels

    def _solve_one(self, b: Floats) -> Floats:
        shape = self.elimination
        x = (self.scale * b)[shape.order].astype(self.values.dtype, copy=False)
        work = np.empty(shape.widest + shape.tallest, x.dtype)
        solve_one(*self._panels, x, work)
        if self.signs is not None:
            x *= self.signs
        solve_one_transposed(*self._panels, x, work)
        return x[shape.place] * self.scale

    def _solve_many(self, b: Floats, j: int, count: int, x: NDArray[Any], result: Floats) -> None:
        """Solve for columns j to j + count of b, into those of the result; x is the room."""
        shape = self.elimination
        enter_many(b, j, count, shape.order, self.scale, x)
        self.substitute(x)
        leave_many(x, count, shape.place, self.scale, j, result)

    def _solve_in_place(self, b: Floats) -> Floats:
        """Solve inside the result: whole lines need not stand in the order of elimination.

        Fresh memory takes as long as the arithmetic, so that no more of it is taken than this.
        """
        shape = self.elimination
        x, same = lines_for(len(b), b.shape[1], b.dtype), shape.order[:0]
        offsets = np.empty(shape.widest + shape.tallest, np.int64)
        enter_many(b, 0, b.shape[1], same, self.scale, x)
        solve_many(*self._panels, shape.order, x, offsets)
        solve_many_transposed(*self._panels, shape.order, x, offsets)
        leave_many(x, b.shape[1], same, self.scale, 0, x)
        return x

    def substitute(self, x: NDArray[Any]) -> None:
        """Solve L S L' x = b in place, in the order of elimination; x is of ``lines_for``."""
        shape = self.elimination
        offsets, same = np.empty(shape.widest + shape.tallest, np.int64), shape.order[:0]
        solve_many(*self._panels, same, x, offsets)
        if self.signs is not None:
            x *= self.signs[:, None]
        solve_many_transposed(*self._panels, same, x, offsets)


def factorize_cholesky(
    matrix: csc_array, elimination: Elimination, dtype: DTypeLike = np.float64
) -> Cholesky:
    """Factorise a symmetric matrix with a positive diagonal; only one triangle is read.

    Raises
    ------
    NotPositiveDefiniteError
        If a pivot is not positive; ``error.rows`` names its row.
    SingularMatrixError
        If that is rounding: a diagonal larger by a few units of it would be enough.

    Notes
    -----
    Cost on a surface mesh: about n^1.5 operations, n log n memory.
    """
    scale = np.exp2(-np.round(np.log2(matrix.diagonal()) / 2))
    values = np.zeros(elimination.panels[-1], np.dtype(dtype))
    column = _fill(matrix, elimination, scale, values)
    if column < 0:
        return Cholesky(elimination, values, scale)
    row = int(elimination.order[column])
    rounding = _ROUNDING[values.dtype.name]
    if _pivot(elimination, values, column) > -rounding:
        lifted = csc_array(matrix.copy())
        lifted.setdiag(matrix.diagonal() + rounding / scale**2)
        values[:] = 0
        if _fill(lifted, elimination, scale, values) < 0:
            raise singular(row)
    raise NotPositiveDefiniteError(row)


def singular(row: int) -> SingularMatrixError:
    """Return the error of a matrix whose row ``row`` has nearly no pivot."""
    return SingularMatrixError(
        f"the matrix is singular to working precision: nothing is left for the pivot of row {row}. "
        "A stiffness alone is singular, because it maps constants to zero. Add a mass, or fix a "
        "value",
        rows=[row],
    )


def _fill(matrix: csc_array, shape: Elimination, scale: Floats, values: NDArray[Any]) -> int:
    """Compute the panels; return -1, or the column that has no pivot."""
    return int(
        factorize_fronts(
            matrix.indptr.astype(np.int64), matrix.indices.astype(np.int32), matrix.data, scale,
            shape.order, shape.place, shape.starts, shape.children, shape.siblings,
            shape.row_starts, shape.rows, shape.panels,
            blas(values.dtype), values, np.empty(shape.stack, values.dtype),
            np.empty(len(shape.starts), np.int64), np.empty(len(shape.order), np.int64),
            np.empty(shape.tallest, np.uint64),
            np.empty(shape.widest + shape.tallest + 8, np.int64), np.zeros(ROOM, values.dtype),
            TWO if values.itemsize == 8 else ONE,
        )
    )  # fmt: skip


def _pivot(shape: Elimination, values: NDArray[Any], column: int) -> float:
    """Return what stands on the diagonal of a column."""
    block = int(np.searchsorted(shape.starts, column, side="right")) - 1
    inside = column - shape.starts[block]
    height = np.diff(shape.starts)[block] + np.diff(shape.row_starts)[block]
    return float(values[shape.panels[block] + inside * (height + 1)])
