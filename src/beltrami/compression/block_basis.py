"""The basis of a block: eigenvectors of the Laplacian of its edges, the same bits everywhere.

The weight of an edge is 1 and a little, which depends on its place alone: so symmetric meshes,
whose eigenvalues repeat, have one basis too, and not any turn of it (E61, E87).
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel
from beltrami.compression.neighbourhood import Neighbourhood
from beltrami.compression.tridiagonal import tridiagonalise, turn, turn_back
from beltrami.compression.tridiagonal_pairs import lowest_eigenvalues, tridiagonal_vectors

_LITTLE = 2.0**-18


@dataclass(frozen=True, eq=False)
class ReducedBlock:
    """The Laplacian of a block as a tridiagonal matrix, and the way back.

    Parameters
    ----------
    diagonal, beside
        (n,) of the matrix; the last entry of ``beside`` is not used.
    reflectors, scales
        (n, n), (n,) of the reflections.
    """

    diagonal: Floats
    beside: Floats
    reflectors: Floats
    scales: Floats

    def vectors(self, count: int) -> Floats:
        """Return the ``count`` first eigenvectors, (n, count); the same bits for any count."""
        return self.turned(self.tridiagonal_vectors(count))

    def tridiagonal_vectors(self, count: int) -> Floats:
        """Return the ``count`` first eigenvectors of the tridiagonal matrix, (n, count)."""
        Y, values = np.zeros((len(self.diagonal), count)), np.zeros(count)
        if count:
            width = lowest_eigenvalues(self.diagonal, self.beside, values)
            tridiagonal_vectors(self.diagonal, self.beside, values, width, Y)
        return Y

    def turned(self, Y: Floats) -> Floats:
        """Make eigenvectors of the block of its first ones; they are used up."""
        turn_back(self.reflectors, self.scales, Y)
        _choose_signs(Y)
        return Y

    def sizes(self, Y: Floats, x: Floats) -> Floats:
        """Return the sizes of the coefficients of x (n, d), but for their rounding, (count, d)."""
        turned = x.copy()
        turn(self.reflectors, self.scales, turned)
        found: Floats = np.abs(Y.T @ turned)
        return found


class BlockBasis:
    """The eigenvectors of one block after another, as many as are asked for.

    Chapter items: P58.

    Parameters
    ----------
    near
        Who is next to whom: all that the basis depends on.

    Examples
    --------
    >>> from beltrami.compression.neighbourhood import look_around
    >>> near = look_around(np.array([[0, 1, 2], [2, 1, 3]]), 4)
    >>> U = BlockBasis(near).vectors(np.arange(4), 3)
    >>> np.allclose(U.T @ U, np.eye(3)), U[:, 0].tolist()
    (True, [0.5, 0.5, 0.5, 0.5])
    """

    def __init__(self, near: Neighbourhood) -> None:
        self._near = near
        self._place = np.full(len(near.starts) - 1, -1, np.int64)
        self._hash = hashlib.sha256()

    def vectors(self, vertices: Any, count: int) -> Floats:
        """Return the ``count`` first eigenvectors, (len(vertices), count).

        The first is constant, so that moving a mesh moves all its approximations (E78). 2 n³
        operations, and 2 n² for each vector.
        """
        return self.reduced(vertices).vectors(count) if count else np.zeros((len(vertices), 0))

    def reduced(self, vertices: Any) -> ReducedBlock:
        """Return what all eigenvectors of a block are made of."""
        n = len(vertices)
        A, reflectors = np.zeros((n, n)), np.zeros((n, n))
        d, e, scales = np.zeros(n), np.zeros(n), np.zeros(n)
        self._place[vertices] = np.arange(n)
        fill_laplacian(vertices, self._near, self._place, A)
        self._place[vertices] = -1
        tridiagonalise(A, d, e, reflectors, scales)
        return ReducedBlock(d, e, reflectors, scales)

    def note(self, vectors: Floats) -> None:
        """Let the hash depend on these too."""
        self._hash.update(vectors.astype("<f8", order="C").tobytes())

    def digest(self) -> bytes:
        """Return 8 bytes of the SHA-256 of all vectors that were noted."""
        return self._hash.digest()[:8]


@kernel
def fill_laplacian(vertices: Any, near: Any, place: Any, A: Any) -> None:
    """Write L - 11ᵀ/n of the edges within a block: constants get the eigenvalue -1, alone."""
    n = vertices.size
    for i in range(n):
        total = 0.0
        for k in range(near.starts[vertices[i]], near.starts[vertices[i] + 1]):
            j = place[near.around[k]]
            if j >= 0:
                a, b = min(i, j), max(i, j)
                weight = 1.0 + _LITTLE * ((a * 40503 + b * 30011) & 63)
                A[i, j] -= weight
                total += weight
        A[i, i] += total
    for i in range(n):
        for j in range(n):
            A[i, j] -= 1.0 / n


@kernel
def _choose_signs(U: Any) -> None:
    """Make the first vector constant, and give the others a sign by a rule."""
    n, m = U.shape
    least = 0.5 / np.sqrt(n)
    for j in range(m):
        i = 0
        while i < n - 1 and abs(U[i, j]) < least:
            i += 1
        sign = -1.0 if U[i, j] < 0.0 else 1.0
        for i in range(n):
            U[i, j] = sign * U[i, j] if j else 1.0 / np.sqrt(n)
