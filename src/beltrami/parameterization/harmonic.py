"""Harmonic coordinates: each inner vertex the weighted mean of its neighbours (l. 669)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Floats, Integers, as_function, as_indices
from beltrami.errors import DimensionError, MeshError
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.operators.weights import Weigher, edge_weights
from beltrami.solvers.factorize import factorize


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
    return solve_harmonic(edge_weights(mesh, weights), at, given, mesh.vertices)


def solve_harmonic(W: csr_array, held: Integers, values: Floats, positions: Floats) -> Floats:
    """Solve for the vertices that are not held; ``positions`` order the elimination.

    The system is scaled to a unit diagonal from both sides, so that weights of any unit do; a
    symmetric W stays symmetric.
    """
    n = W.shape[0]
    psi = np.zeros((n, *values.shape[1:]))
    psi[held] = values
    free = np.ones(n, np.bool_)
    free[held] = False
    if not free.any():
        return psi
    inner = np.flatnonzero(free)
    number = np.cumsum(free) - 1
    i = np.repeat(np.arange(n), np.diff(W.indptr))
    j, w = W.indices, W.data
    sums = np.bincount(i, w, n)
    if (sums[inner] == 0).any() or not np.isfinite(sums).all():
        raise MeshError(
            "the weights around some vertices add to nothing", vertices=inner[sums[inner] == 0]
        )
    r = np.sqrt(np.abs(1 / np.where(free, sums, 1)))
    known = free[i] & ~free[j]
    unknown = free[i] & free[j]
    right = csr_array((w[known] * r[i[known]], (number[i[known]], j[known])), shape=(len(inner), n))
    entries = -w[unknown] * (r[i[unknown]] * r[j[unknown]])
    rows, columns = number[i[unknown]], number[j[unknown]]
    size = len(inner)
    diagonal = np.arange(size)
    A = csr_array(
        (
            np.concatenate([entries, np.sign(sums[inner])]),
            (np.concatenate([rows, diagonal]), np.concatenate([columns, diagonal])),
        ),
        shape=(size, size),
    )
    if positions.shape[0] != n:
        raise DimensionError("one position for each vertex is needed")
    y = factorize(A, positions[inner]).solve(right @ psi)
    psi[inner] = (y.T * r[inner]).T
    return psi
