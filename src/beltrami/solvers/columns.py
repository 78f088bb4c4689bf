"""A growing set of long columns, kept in panels, and the products that an eigensolver needs."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

ROWS = 8192  # of a product at a time: what is between two multiplications stays in the cache
FEW = 2048  # likewise, of hundreds of columns
_DUST = 1e-25
_WIDTH = 128  # columns of a panel: to grow copies nothing


def without_dust(S: NDArray[Any], dtype: DTypeLike) -> NDArray[Any]:
    """Return S in a precision, without numbers so small that processors are slow with them."""
    return np.where(np.abs(S) < _DUST, 0.0, S).astype(dtype)


def subtract_product(W: NDArray[Any], Q: NDArray[Any], C: NDArray[Any]) -> None:
    """Take Q C away from W in place."""
    for r in range(0, len(W), ROWS):
        W[r : r + ROWS] -= Q[r : r + ROWS] @ C


class Columns:
    """(n, count) columns Q; rows are contiguous within a panel."""

    def __init__(self, n: int, dtype: DTypeLike) -> None:
        self.n, self.dtype, self.count = n, np.dtype(dtype), 0
        self._panels: list[NDArray[Any]] = []

    def append(self, block: NDArray[Any]) -> None:
        """Add the columns of a block (n, b) at the end."""
        self.count += block.shape[1]
        while self.count > len(self._panels) * _WIDTH:
            self._panels.append(np.empty((self.n, _WIDTH), self.dtype))
        self.put(self.count - block.shape[1], block)

    def put(self, start: int, block: NDArray[Any]) -> None:
        """Overwrite the columns from ``start`` on."""
        for panel, first, last, offset in self._pieces(start, start + block.shape[1]):
            panel[:, first:last] = block[:, offset : offset + last - first]

    def transposed_times(self, Z: NDArray[Any], start: int, stop: int) -> NDArray[Any]:
        """Return Q'Z for the columns from ``start`` to ``stop``."""
        C = np.zeros((stop - start, Z.shape[1]), self.dtype)
        for panel, first, last, offset in self._pieces(start, stop):
            part = C[offset : offset + last - first]
            for r in range(0, self.n, ROWS):
                part += panel[r : r + ROWS, first:last].T @ Z[r : r + ROWS]
        return C

    def subtract(self, W: NDArray[Any], C: NDArray[Any], start: int = 0) -> None:
        """Take Q C away from W in place, for as many columns as C has rows."""
        for panel, first, last, offset in self._pieces(start, start + len(C)):
            part = C[offset : offset + last - first]
            subtract_product(W, panel[:, first:last], part)

    def times(self, S: NDArray[Any], dtype: DTypeLike) -> NDArray[Any]:
        """Return Q S for the first columns, as many as S has rows."""
        X = np.empty((self.n, S.shape[1]), dtype)
        for r, part in self._products(S):
            X[r : r + len(part)] = part
        return X

    def contract(self, S: NDArray[Any]) -> None:
        """Replace Q by Q S, in place: S has no more columns than rows."""
        for r, part in self._products(S):
            for panel, first, last, offset in self._pieces(0, S.shape[1]):
                panel[r : r + len(part), first:last] = part[:, offset : offset + last - first]
        self.count = S.shape[1]
        del self._panels[-(-self.count // _WIDTH) :]

    def _products(self, S: NDArray[Any]) -> Iterator[tuple[int, NDArray[Any]]]:
        factor = without_dust(S, self.dtype)
        for r in range(0, self.n, ROWS):
            yield (
                r,
                sum(
                    panel[r : r + ROWS, first:last] @ factor[offset : offset + last - first]
                    for panel, first, last, offset in self._pieces(0, len(S))
                ),
            )

    def _pieces(self, start: int, stop: int) -> Iterator[tuple[NDArray[Any], int, int, int]]:
        """Cut columns at the panels: panel, first and last column in it, offset from start."""
        column = start
        while column < stop:
            panel, first = divmod(column, _WIDTH)
            last = min(_WIDTH, first + stop - column)
            yield self._panels[panel], first, last, column - start
            column += last - first
