"""Positions to coefficients of a block and back, and coefficients to whole numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._arrays import Booleans, Floats, Integers
from beltrami._jit import plain_kernel
from beltrami.compression.block_basis import BlockBasis

DEAD_ZONE = 0.6  # of a step: smaller coefficients become 0
_ROUNDING = 1e-9  # of the length of x: more than that of sums


def analyse(
    x: Floats, vertices: Integers, basis: BlockBasis, least: float, most: int, enough: int
) -> tuple[Floats, Floats]:
    """Return (vectors (n, k), coefficients (k, d)) of a block; those left out are below ``least``.

    At most ``most`` of them, whatever is left out. How many are needed is found in the
    tridiagonal eigenvectors, of which only those are turned back. Of these as many are made as
    ``enough`` says, or twice or four times as many, until the last quarter of them is not needed;
    what lies beyond is taken for small.
    """
    local = np.ascontiguousarray(x[vertices])
    block = basis.reduced(vertices)
    least -= _ROUNDING * float(np.sqrt((local**2).sum()))
    most = min(most, len(vertices))
    made = min(enough, most)
    while True:
        Y = block.tridiagonal_vectors(made)
        count = length_of(block.sizes(Y, local) > least)
        if made == most or 4 * count <= 3 * made:
            break
        made = min(2 * made, most)
    U = block.turned(np.ascontiguousarray(Y[:, : max(count, 1)]))
    c = np.zeros((U.shape[1], x.shape[1]))
    project(U, local, c)
    return U, c


@plain_kernel
def project(U: Any, x: Any, c: Any) -> None:
    """Add Uᵀ x to c."""
    n, m = U.shape
    for q in range(x.shape[1]):
        for i in range(n):
            row, f = U[i], x[i, q]
            for j in range(m):
                c[j, q] += f * row[j]


@plain_kernel
def add_up(U: Any, c: Any, vertices: Any, x: Any) -> None:
    """Write U c at the vertices; rows of c beyond the columns of U are not looked at."""
    n, m = U.shape
    for i in range(n):
        for q in range(x.shape[1]):
            s = 0.0
            for j in range(m):
                s += U[i, j] * c[j, q]
            x[vertices[i], q] = s


def rounded(c: Floats) -> Integers:
    """Round coefficients (k, d) of a block, given in steps: small ones to 0, but for the mean.

    Chapter items: P67.

    Examples
    --------
    >>> rounded(np.array([[0.5], [0.5], [-0.61], [1.4], [1.6]])).ravel().tolist()
    [1, 0, -1, 1, 2]
    """
    numbers = np.floor(c + 0.5)
    numbers[1:][abs(c[1:]) < DEAD_ZONE] = 0.0
    return numbers.astype(np.int64)


def length_of(numbers: Integers | Booleans) -> int:
    """Return how many rows there are up to the last one that is not 0."""
    rows = np.flatnonzero(numbers.any(axis=1))
    return int(rows[-1]) + 1 if len(rows) else 0
