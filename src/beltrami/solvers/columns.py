"""A growing set of long columns, kept in blocks, and the products that an eigensolver needs."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from beltrami.solvers.skinny import add_products, add_transposed_products, padded

ROWS = 4096  # of a product at a time
FEW = 2048  # likewise, of hundreds of columns: what is between two products stays in the cache
_DUST = 1e-25


def without_dust(S: NDArray[Any], dtype: DTypeLike) -> NDArray[Any]:
    """Return S in a precision, without numbers so small that processors are slow with them."""
    return np.where(np.abs(S) < _DUST, 0.0, S).astype(dtype)


def subtract_product(W: NDArray[Any], Q: NDArray[Any], C: NDArray[Any]) -> None:
    """Take Q C away from W in place."""
    for r in range(0, len(W), ROWS):
        W[r : r + ROWS] -= Q[r : r + ROWS] @ C


class Columns:
    """(n, count) columns Q, in the blocks (n, b) in which they came, which are not copied."""

    def __init__(self, n: int, dtype: DTypeLike) -> None:
        self.n, self.dtype, self.count = n, np.dtype(dtype), 0
        self._blocks: list[NDArray[Any]] = []

    def append(self, block: NDArray[Any]) -> None:
        """Add the columns of a block (n, b) at the end; it must not change any more."""
        self._blocks.append(np.ascontiguousarray(block, self.dtype))
        self.count += block.shape[1]

    def replace_last(self, block: NDArray[Any]) -> None:
        """Put a block in place of the one that came last."""
        self.count -= self._blocks.pop().shape[1]
        self.append(block)

    def transposed_times(self, Z: NDArray[Any], start: int, stop: int) -> NDArray[Any]:
        """Return Q'Z for the columns from ``start`` to ``stop``."""
        right = padded(Z)
        C = np.zeros((stop - start, right.shape[1]), self.dtype)
        if C.size:
            panels, widths, first = self._from(start, stop)
            add_transposed_products(panels, widths, first, ROWS, right, C, np.empty_like(C))
        return C[:, : Z.shape[1]]

    def subtract(self, W: NDArray[Any], C: NDArray[Any], start: int = 0) -> None:
        """Take Q C away from W in place, for as many columns as C has rows."""
        if not C.size:
            return
        panels, widths, first = self._from(start, start + len(C))
        result, factor = padded(W), padded(-C)
        add_products(result, panels, widths, first, factor)
        if result is not W:
            W[:] = result[:, : W.shape[1]]

    def times(self, S: NDArray[Any], dtype: DTypeLike) -> NDArray[Any]:
        """Return Q S for the first columns, as many as S has rows."""
        X = np.empty((self.n, S.shape[1]), dtype)
        for r, part in self._products(S):
            X[r : r + len(part)] = part
        return X

    def contract(self, S: NDArray[Any]) -> None:
        """Replace Q by Q S; S has no more columns than rows. No room for both is needed."""
        kept, covered = [], 0
        for block in self._blocks:
            kept.append((block, covered))
            covered += block.shape[1]
            if covered >= S.shape[1]:
                break
        for r, part in self._products(S):
            for block, start in kept:
                columns = part[:, start : start + block.shape[1]]
                block[r : r + len(part), : columns.shape[1]] = columns
        last, start = kept[-1]
        kept[-1] = (np.ascontiguousarray(last[:, : S.shape[1] - start]), start)
        self._blocks, self.count = [block for block, _ in kept], S.shape[1]

    def _products(self, S: NDArray[Any]) -> Iterator[tuple[int, NDArray[Any]]]:
        """Yield Q S, some rows at a time."""
        factor = without_dust(S, self.dtype)
        gathered, product = (
            np.empty((FEW, len(S)), self.dtype),
            np.empty((FEW, S.shape[1]), self.dtype),
        )
        for r in range(0, self.n, FEW):
            h, column = min(FEW, self.n - r), 0
            for block in self._blocks:
                if column >= len(S):
                    break
                width = min(block.shape[1], len(S) - column)
                gathered[:h, column : column + width] = block[r : r + h, :width]
                column += width
            yield r, np.matmul(gathered[:h], factor, out=product[:h])

    def _from(self, start: int, stop: int) -> tuple[NDArray[Any], NDArray[Any], int]:
        """Return addresses and widths of the blocks, and the column of the first to start at."""
        addresses: list[int] = []
        widths: list[int] = []
        column = first = 0
        for block in self._blocks:
            after = column + block.shape[1]
            if after > start and column < stop:
                first = first if addresses else start - column
                addresses.append(block.ctypes.data)
                widths.append(block.shape[1])
            column = after
        return np.array(addresses, np.int64), np.array(widths, np.int64), first
