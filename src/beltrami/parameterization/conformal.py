"""Conformal maps with a free boundary: least squares, and an eigenvector (section 3.3.8)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, eye_array, kron

from beltrami._arrays import Floats, Integers
from beltrami.errors import ConvergenceError
from beltrami.mesh.edge_matrix import laplacian_matrix
from beltrami.mesh.mesh import Mesh
from beltrami.operators.weights import weigh_edges
from beltrami.parameterization.distortion import measured
from beltrami.solvers.factorize import factorize

_SHIFT = 1e-8  # by which eigenvalues are moved: the constants, at 0, leave the matrix singular
_BLOCK = 3  # eigenvectors that are iterated together, so that near ones do not slow it down
_SETTLED = 1e-10  # change of the eigenvalue, beside the next one
_ROUNDING = 1e-14  # change that rounding makes
_ROUNDS = 200


def conformal_energy(mesh: Mesh) -> csr_array:
    r"""Return the matrix M of :math:`E_C(\psi) = E_D(\psi) - A(\psi) = \frac{1}{2} u^T M u`.

    The Dirichlet energy of both coordinates less the area of the image, with its sign: on each
    face :math:`(\sigma_1 - \sigma_2)^2 / 2` times its area where the face is not turned over, so
    it is 0 for conformal maps alone. M is semi-definite whatever the angles, also where cotangent
    weights are negative.

    Parameters
    ----------
    mesh
        An oriented manifold of n vertices, with a boundary.

    Returns
    -------
    (2n, 2n) symmetric, for :math:`u = (x_0, y_0, x_1, y_1, \dots)`. No unit. Cost: O(m).
    """
    n = mesh.n_vertices
    L = laplacian_matrix(mesh.edges, weigh_edges(mesh, "cotangent"), n)
    i = np.concatenate(mesh.boundary_loops)
    j = np.concatenate([np.roll(loop, -1) for loop in mesh.boundary_loops])
    half = np.full(len(i), 0.5)
    rows = np.concatenate([2 * i, 2 * j + 1, 2 * j, 2 * i + 1])
    columns = np.concatenate([2 * j + 1, 2 * i, 2 * i + 1, 2 * j])
    area = csr_array(
        (np.concatenate([half, half, -half, -half]), (rows, columns)), shape=(2 * n, 2 * n)
    )
    return csr_array(kron(L, eye_array(2), format="csr") - area)


def least_squares_conformal(mesh: Mesh, held: Integers | None = None) -> Floats:
    r"""Return the map with the least conformal energy that holds two vertices in place.

    B. Lévy, S. Petitjean, N. Ray, J. Maillot, Least squares conformal maps for automatic texture
    atlas generation, 2002. One solve with 2n - 4 unknowns. What is held decides where the
    distortion goes; boundaries may overlap and faces fold.

    Parameters
    ----------
    mesh
        A disk of n vertices.
    held
        The two vertices; by default two that halve the boundary.

    Returns
    -------
    (n, 2) positions; the area of the image is that of the surface.
    """
    ends = _opposite(mesh) if held is None else held
    x = mesh.vertices[ends]
    z = np.zeros((mesh.n_vertices, 2))
    z[ends[1], 0] = np.linalg.norm(x[1] - x[0]) or 1.0
    M = conformal_energy(mesh)
    free = np.ones(2 * mesh.n_vertices, np.bool_)
    free[[2 * ends[0], 2 * ends[0] + 1, 2 * ends[1], 2 * ends[1] + 1]] = False
    inner = np.flatnonzero(free)
    rows = M[inner]
    right = -(rows @ z.ravel())
    factor = factorize(rows[:, inner], mesh.vertices[inner // 2])
    flat = z.ravel()
    flat[inner] = factor.solve(right)
    return _scaled(mesh, z)


def spectral_conformal(mesh: Mesh) -> Floats:
    r"""Return the map of least conformal energy among those of unit variance on the boundary.

    :math:`M u = \lambda B u` with the lengths along the boundary in B: the eigenvector after the
    constants. No vertex is held, so none is special (P. Mullen, Y. Tong, P. Alliez, M. Desbrun,
    Spectral conformal parameterization, 2008). It repairs theorem 22, whose two eigenvectors are
    no conformal pair: here both coordinates are one vector.

    Chapter items: P75, P76.

    Parameters
    ----------
    mesh
        A disk.

    Returns
    -------
    (n, 2) positions; the area of the image is that of the surface.

    Raises
    ------
    ConvergenceError
        If the iteration does not settle.

    Notes
    -----
    M commutes with a turn of the plane, so eigenvectors are complex: a block of three is iterated
    with one factorisation of 2n unknowns.
    """
    n = mesh.n_vertices
    M, b = conformal_energy(mesh), _boundary_mass(mesh)
    positions = np.repeat(mesh.vertices, 2, axis=0)
    diagonal = np.arange(2 * n)
    shift = csr_array((_SHIFT * np.repeat(b, 2), (diagonal, diagonal)), shape=(2 * n, 2 * n))
    factor = factorize(M + shift, positions)
    count = min(_BLOCK, int(np.count_nonzero(b)) - 1)
    start = np.random.default_rng(0).normal(size=(n, 2 * count))
    z = start[:, :count] + 1j * start[:, count:]
    before = np.inf
    history = []
    for _ in range(_ROUNDS):
        z = _complex(factor.solve(_real(b[:, None] * z)))
        z = z - b @ z  # B has the trace 1: this is the constant part
        z = z @ np.linalg.inv(np.linalg.qr(np.sqrt(b)[:, None] * z, mode="r"))
        values, vectors = np.linalg.eigh(z.conj().T @ _complex(M @ _real(z)))
        z = z @ vectors
        history.append(abs(before - values[0]))
        if history[-1] <= _SETTLED * abs(values[1]) + _ROUNDING:
            return _scaled(mesh, np.stack([z[:, 0].real, z[:, 0].imag], axis=1))
        before = values[0]
    raise ConvergenceError("the eigenvector of the conformal energy does not settle", history)


def _opposite(mesh: Mesh) -> Integers:
    """Return the first vertex of the boundary and the one half of its length away."""
    loop = mesh.boundary_loops[0]
    x = mesh.vertices[loop]
    way = np.cumsum(np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1))
    middle = int(np.abs(way[:-1] - way[-1] / 2).argmin()) + 1
    return loop[[0, middle]]


def _boundary_mass(mesh: Mesh) -> Floats:
    """Return half of the lengths of the boundary edges at each vertex, of all lengths."""
    i, j = mesh.topology.boundary_edges.T
    lengths = np.linalg.norm(mesh.vertices[i] - mesh.vertices[j], axis=1)
    ends = np.concatenate([i, j])
    mass = np.bincount(ends, np.concatenate([lengths, lengths]), mesh.n_vertices)
    return np.asarray(mass / mass.sum())


def _scaled(mesh: Mesh, z: Floats) -> Floats:
    """Let the faces of the image have the area of the surface."""
    return np.asarray(z / (measured(mesh, z).scale or 1.0))


def _real(z: NDArray[Any]) -> Floats:
    """Return the columns z as (x_0, y_0, x_1, ...)."""
    return np.ascontiguousarray(z.T).view(np.float64).T


def _complex(u: Floats) -> NDArray[np.complex128]:
    return np.ascontiguousarray(u.T).view(np.complex128).T
