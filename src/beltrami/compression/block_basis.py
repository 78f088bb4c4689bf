"""The basis of a block: eigenvectors of the Laplacian of its edges, the same bits everywhere.

The weight of an edge is 1 and a little, which depends on its place alone: so symmetric meshes,
whose eigenvalues repeat, have one basis too, and not any turn of it (E61, E87).
"""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel
from beltrami.compression.neighbourhood import Neighbourhood
from beltrami.compression.tridiagonal import tridiagonalise, turn_back
from beltrami.compression.tridiagonal_pairs import lowest_eigenvalues, tridiagonal_vectors

_LITTLE = 2.0**-18


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
        n = len(vertices)
        U = np.zeros((n, count))
        if count:
            A = np.zeros((n, n))
            self._place[vertices] = np.arange(n)
            fill_laplacian(vertices, self._near, self._place, A)
            self._place[vertices] = -1
            _eigenvectors(A, U)
        return U

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
def _eigenvectors(A: Any, U: Any) -> None:
    """Write the first eigenvectors of A: a constant, and the others with a rule for the sign."""
    n, m = U.shape
    d, e, scales = np.zeros(n), np.zeros(n), np.zeros(n)
    reflectors, values = np.zeros((n, n)), np.zeros(m)
    tridiagonalise(A, d, e, reflectors, scales)
    width = lowest_eigenvalues(d, e, values)
    tridiagonal_vectors(d, e, values, width, U)
    turn_back(reflectors, scales, U)
    least = 0.5 / np.sqrt(n)
    for j in range(m):
        i = 0
        while i < n - 1 and abs(U[i, j]) < least:
            i += 1
        sign = -1.0 if U[i, j] < 0.0 else 1.0
        for i in range(n):
            U[i, j] = sign * U[i, j] if j else 1.0 / np.sqrt(n)
