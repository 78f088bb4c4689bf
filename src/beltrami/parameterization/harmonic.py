"""Harmonic coordinates: each inner vertex the weighted mean of its neighbours (l. 669)."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csc_array, csr_array

from beltrami._arrays import Floats, Integers, as_function, as_indices
from beltrami._jit import kernel
from beltrami.errors import (
    DimensionError,
    MeshError,
    NotPositiveDefiniteError,
    SingularMatrixError,
)
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.operators.weights import Weigher, edge_weights
from beltrami.solvers.cholesky import factorize_cholesky
from beltrami.solvers.elimination import Elimination
from beltrami.solvers.factorize import SMALL, factorize
from beltrami.solvers.ordering import as_positions, order

_PIVOT = 1e-12  # of a matrix with a diagonal of ones: smaller ones are looked at more closely
_RESIDUAL = 1e-13


def harmonic(
    mesh: Mesh,
    held: ArrayLike,
    values: ArrayLike,
    weights: str | Weigher = "mean_value",
) -> Floats:
    r"""Return the function with :math:`L\psi = 0` inside and :math:`\psi = \psi^0` where held.

    .. math:: \psi(i) = \frac{1}{\sum_j w_{ij}} \sum_j w_{ij} \psi(j), \quad i \text{ not held}

    Remark 5 says it of all i, but on the boundary nothing of the kind holds (E88). The columns of
    ``values`` share one factorisation. Symmetric weights go to Cholesky where that is possible,
    those of the mean value to LU.

    Chapter items: U39, P72, R5.

    Parameters
    ----------
    mesh
        The mesh.
    held
        (b,) vertices, or a mask: usually the boundary.
    values
        (b,) or (b, c) values there.
    weights
        As in ``edge_weights``. Symmetric or not; negative ones may fold a map.

    Raises
    ------
    MeshError
        If a held vertex does not exist, comes twice, or none is held in some component.
    DimensionError, NonFiniteError
        If ``values`` has not b rows, or is not finite.
    SingularMatrixError
        If negative weights make the system singular.

    Examples
    --------
    >>> from beltrami.mesh.shapes import grid
    >>> mesh = grid(4, 4)
    >>> loop = mesh.boundary_loops[0]
    >>> uv = harmonic(mesh, loop, mesh.vertices[loop, :2])  # linear functions are kept
    >>> bool(abs(uv - mesh.vertices[:, :2]).max() < 1e-14)
    True
    """
    require_mesh(mesh, "a harmonic map")
    at = as_indices(held, mesh.n_vertices, "held vertices")
    given = as_function(values, len(at), "the held values")
    if len(np.unique(at)) != len(at):
        raise MeshError("vertices are held twice", vertices=at[np.bincount(at)[at] > 1])
    W = edge_weights(mesh, weights)
    try:
        return solve_harmonic(W, at, given, mesh.vertices, symmetric=is_symmetric(weights))
    except SingularMatrixError:
        _require_held(mesh, at)
        raise


def _require_held(mesh: Mesh, held: Integers) -> None:
    """Raise MeshError, with a vertex of each component in which nothing is held."""
    label = np.full(mesh.n_vertices, -1)
    label[mesh.faces.ravel()] = np.repeat(mesh.components(), 3)
    names, first = np.unique(label, return_index=True)
    without = ~np.isin(names, label[held])
    if without.any():
        raise MeshError(
            "nothing is held in some components, so that any constant would do",
            vertices=first[without],
            remedy="Hold a vertex in each: of these components the first vertices are named.",
        ) from None


def is_symmetric(weights: str | Weigher) -> bool:
    """Whether edges of these weights weigh the same from both ends."""
    return weights != "mean_value"


def solve_harmonic(
    W: csr_array,
    held: Integers,
    values: Floats,
    positions: Floats,
    *,
    symmetric: bool = False,
    plan: Elimination | None = None,
) -> Floats:
    """Solve for the vertices that are not held; ``positions`` order the elimination.

    The system is scaled to a unit diagonal from both sides, so that weights of any unit do; a
    symmetric W stays symmetric. Where it is known to be, it need not be turned into columns; a
    plan is an order for that pattern, and says that something is held in each component.
    """
    n = W.shape[0]
    if positions.shape[0] != n:
        raise DimensionError("one position for each vertex is needed")
    psi = np.zeros((n, *values.shape[1:]))
    psi[held] = values
    inner, number = _free(n, held)
    if not len(inner):
        return psi
    A, right, root = _system(W, psi.reshape(n, -1), inner, number, symmetric)
    y = _solution(A, right, positions[inner], plan)
    psi[inner] = (root[:, None] * y).reshape(psi[inner].shape)
    return psi


def plan_harmonic(W: csr_array, held: Integers, positions: Floats) -> Elimination | None:
    """Return an order of elimination for all symmetric weights on these edges; None if all held."""
    inner, number = _free(W.shape[0], held)
    if not len(inner):
        return None
    A, _, _ = _system(W, np.zeros((W.shape[0], 1)), inner, number, True)
    return order(csc_array(A), as_positions(positions[inner], len(inner)), "auto")


def _free(n: int, held: Integers) -> tuple[Integers, Integers]:
    """Return the vertices that are not held, and the number among them of each vertex, or -1."""
    free = np.ones(n, np.bool_)
    free[held] = False
    return np.flatnonzero(free), np.where(free, np.cumsum(free) - 1, -1)


def _system(
    W: csr_array, psi: Floats, inner: Integers, number: Integers, symmetric: bool
) -> tuple[csr_array | csc_array, Floats, Floats]:
    """Return the scaled matrix, the right-hand sides and the scale, for the inner vertices."""
    n, size = W.shape[0], len(inner)
    sums = np.bincount(np.repeat(np.arange(n), np.diff(W.indptr)), W.data, n)
    if (sums[inner] == 0).any() or not np.isfinite(sums).all():
        raise MeshError(
            "the weights around some vertices add to nothing", vertices=inner[sums[inner] == 0]
        )
    root = np.sqrt(np.abs(1 / sums[inner]))
    indptr, indices = np.zeros(size + 1, np.int32), np.empty(W.nnz + size, np.int32)
    data, right = np.empty(W.nnz + size), np.zeros((size, psi.shape[1]))
    count = _fill_system(
        W.indptr, W.indices, W.data, number, root, np.sign(sums), psi, indptr, indices, data, right
    )
    form = csc_array if symmetric and (sums[inner] > 0).all() else csr_array
    A = form((data[:count], indices[:count], indptr), shape=(size, size))
    A.has_canonical_format = True  # known: scipy need not look
    return A, right, root


def _solution(
    A: csr_array | csc_array, right: Floats, positions: Floats, plan: Elimination | None
) -> Floats:
    """Solve; where A is symmetric, definite and far from singular, the residual is all to check."""
    if isinstance(A, csc_array) and (plan is not None or A.shape[0] >= SMALL):
        with suppress(NotPositiveDefiniteError, SingularMatrixError):
            own = plan or order(A, as_positions(positions, len(right)), "auto")
            factor = factorize_cholesky(A, own)
            y = factor.solve(right)
            size = 2 * np.abs(y).max() + np.abs(right).max()  # no row of A adds to more than 2
            regular = plan is not None or factor.pivots.min() > _PIVOT
            if regular and np.abs(right - A @ y).max() <= _RESIDUAL * size:
                return y
    return factorize(A, positions).solve(right)


@kernel
def _fill_system(
    starts: Any, columns: Any, weights: Any, number: Any, root: Any, signs: Any, psi: Any,
    indptr: Any, indices: Any, data: Any, right: Any,
) -> int:  # fmt: skip
    """Write rows of the inner vertices, diagonals among them in order; return how many entries."""
    at = 0
    for v in range(number.size):
        i = number[v]
        if i < 0:
            continue
        placed = False
        for q in range(starts[v], starts[v + 1]):
            j = number[columns[q]]
            if j < 0:
                for c in range(psi.shape[1]):
                    right[i, c] += weights[q] * root[i] * psi[columns[q], c]
                continue
            if not placed and j > i:
                indices[at], data[at], placed = i, signs[v], True
                at += 1
            indices[at], data[at] = j, -weights[q] * (root[i] * root[j])
            at += 1
        if not placed:
            indices[at], data[at] = i, signs[v]
            at += 1
        indptr[i + 1] = at
    return at
