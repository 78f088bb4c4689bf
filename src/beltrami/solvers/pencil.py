"""The pencil of an eigenproblem, made ready: scaled to a unit mass, in order of elimination."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel
from beltrami.solvers.elimination import Elimination
from beltrami.solvers.kernel_vectors import kernel_vectors
from beltrami.solvers.ordering import as_positions, order

Block = NDArray[Any]  # (n, c), float32 or float64
SPARE = 64  # vectors of the kernel that are known beyond those wanted
_WEYL = 3.63  # times k median(diag L) / sum(B): 4πk/area on a surface of equilateral triangles


@dataclass(frozen=True, eq=False)
class Pencil:
    r"""(L, B) as :math:`D^{-1}LD^{-1}/u` and :math:`D^{-1}BD^{-1}`, with D² the diagonal of B.

    Neither the unit of length nor the size of the masses is left: the eigenvalues wanted are
    about 1. A vector x of the pencil is :math:`\varphi = D^{-1} x`.

    Attributes
    ----------
    stiffness, mass
        (n, n) csr_array in the order of elimination; the diagonal of the mass is 1.
    plain
        Whether the mass is the identity.
    root
        (n,) D, in the order of elimination.
    unit
        u, the eigenvalue of (L, B) that is 1 here.
    kernel
        (n, c) orthonormal vectors that L maps to zero, exactly known; 64 more than are wanted at
        most.
    matrices
        The two in the order in which they came, to be factorised.
    elimination
        The order, and the shape of the factors.
    """

    stiffness: csr_array
    mass: csr_array
    plain: bool
    root: Floats
    unit: float
    kernel: Floats
    matrices: tuple[csr_array, csr_array]
    elimination: Elimination

    @property
    def n(self) -> int:
        """Number of unknowns."""
        return len(self.root)

    @cached_property
    def _mass_in_single(self) -> csr_array:
        return csr_array(self.mass.astype(np.float32))

    @property
    def bound(self) -> float:
        """Return a number that no eigenvalue exceeds (Gershgorin); infinite for a full mass."""
        return float(abs(self.stiffness).sum(axis=1).max()) if self.plain else np.inf

    def kernel_goes_on(self, k: int) -> bool:
        """Whether the kernel may have more vectors than are known: far more than k."""
        return self.kernel.shape[1] == k + SPARE

    def weighed(self, X: Block) -> Block:
        """Return B X, which is X itself where the mass is the identity."""
        if self.plain:
            return X
        mass = self._mass_in_single if X.dtype == np.float32 else self.mass
        return np.asarray(mass @ X)

    def shifted(self, shift: float) -> csc_array:
        """Return L - σB in the order in which they came, by columns."""
        L, B = self.matrices
        return csc_array(csr_array(L - shift * B).T)  # symmetric: its rows are its columns

    def physical(self, known: Floats, X: Floats, chosen: Integers) -> Floats:
        """Return chosen columns of [known, X] as vectors of (L, B), in its own order."""
        phi = np.empty((self.n, len(chosen)))
        _leave(known, X, chosen, self.root, self.elimination.order, phi)
        return phi


def make_pencil(
    L: csr_array, B: csr_array, k: int, coordinates: Floats | None, *, order_by: str = "auto"
) -> Pencil:
    """Scale and order a pair whose mass has a positive diagonal, for its k-th eigenvalue."""
    root = np.sqrt(B.diagonal())
    unit = weyl(L, B, k)
    scaled, mass = _scaled(L, root, unit), _scaled(B, root, 1.0)
    plain = bool((mass.indices == np.repeat(np.arange(len(root)), np.diff(mass.indptr))).all())
    if plain:
        mass.data[:] = 1  # to the last bit
    pattern = csc_array(csr_array(abs(scaled) + abs(mass)).T)
    positions = None if coordinates is None else as_positions(coordinates, len(root))
    shape = order(pattern, positions, order_by)
    known = kernel_vectors(scaled, mass, root, k + SPARE)[shape.order]
    return Pencil(
        _permuted(scaled, shape), _permuted(mass, shape), plain, root[shape.order], unit,
        np.ascontiguousarray(known), (scaled, mass), shape,
    )  # fmt: skip


def weyl(L: csr_array, B: csr_array, k: int) -> float:
    """Guess the k-th eigenvalue as if the pair were that of an even surface; 1 if L is zero.

    The median makes it blind to slivers. On other domains the guess is wrong, and mended when the
    first Ritz values are known.
    """
    diagonal = L.diagonal()
    typical = float(np.median(diagonal)) if len(diagonal) else 0.0
    if not typical > 0:
        typical = float(np.abs(diagonal).mean())
    guess = _WEYL * k * typical / float(B.sum())
    return guess if guess > 0 else 1.0


def _scaled(A: csr_array, root: Floats, unit: float) -> csr_array:
    """Return D⁻¹ A D⁻¹ / unit."""
    inverse = 1 / root
    rows = np.repeat(inverse, np.diff(A.indptr))
    return csr_array(
        (A.data * rows * inverse[A.indices] / unit, A.indices.copy(), A.indptr.copy()), A.shape
    )


def _permuted(A: csr_array, shape: Elimination) -> csr_array:
    """Bring rows and columns into the order of elimination."""
    indptr, indices, data = np.empty_like(A.indptr), np.empty_like(A.indices), np.empty_like(A.data)
    _permute(A.indptr, A.indices, A.data, shape.order, shape.place, indptr, indices, data)
    return csr_array((data, indices, indptr), A.shape)


@kernel
def _permute(
    indptr: Any, indices: Any, data: Any, order: Any, place: Any, starts: Any, columns: Any, to: Any
) -> None:
    """Copy row ``order[t]`` to row t, with its columns where they now are."""
    k = 0
    starts[0] = 0
    for t in range(order.size):
        for q in range(indptr[order[t]], indptr[order[t] + 1]):
            columns[k] = place[indices[q]]
            to[k] = data[q]
            k += 1
        starts[t + 1] = k


@kernel
def _leave(known: Any, X: Any, chosen: Any, root: Any, order: Any, phi: Any) -> None:
    """Row t of the chosen columns of [known, X], over D, is row ``order[t]``."""
    c = known.shape[1]
    for t in range(order.size):
        to, before, source, inverse = phi[order[t]], known[t], X[t], 1 / root[t]
        for j in range(to.size):
            to[j] = (source[chosen[j] - c] if chosen[j] >= c else before[chosen[j]]) * inverse
