"""fourier_basis: eigenpairs of a pair (L, B), the smallest or those near a number (3.3.2)."""

from __future__ import annotations

import math
import operator
from dataclasses import replace
from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Booleans, Floats, as_indices
from beltrami._kinds import checked
from beltrami.errors import BeltramiError, MeshError
from beltrami.mesh.mesh import Mesh
from beltrami.operators.domain import require_laplacian
from beltrami.operators.pair import Laplacian
from beltrami.solvers.eigenpairs import Eigenpairs, eigenpairs
from beltrami.spectrum.basis import FourierBasis

_ROUNDING = 1e-11  # of an eigenvalue, beside the largest of L_ii / B_ii


@checked
def fourier_basis(
    laplacian: Laplacian,
    k: SupportsIndex,
    near: float = 0.0,
    tol: float = 1e-6,
    seed: int = 0,
    *,
    hold: ArrayLike = (),
    certify: bool = False,
) -> FourierBasis:
    r"""Return k eigenpairs, :math:`L\varphi = \lambda B\varphi` with :math:`\Phi^TB\Phi = Id`.

    The vectors oscillate more the larger the eigenvalue is: :math:`\lambda = \langle L\varphi,
    \varphi\rangle`. With the degree mass they are :math:`D^{-1/2}u` for the eigenvectors u of the
    normalised Laplacian (theorem 8).

    Chapter items: T8, U27, P50, P51, P53, P54.

    Parameters
    ----------
    laplacian
        The pair (L, B), of any mesh, cloud or graph; every mass will do.
    k
        How many, at most n less the vertices held.
    near
        Where: the k eigenvalues nearest to this number. The default gives the smallest ones. It
        has the unit of the eigenvalues, length⁻² with area masses.
    tol
        Largest residual :math:`\|L\varphi - \lambda B\varphi\| / \|\lambda B\varphi\|`, computed
        in float64. Eigenvalues are then correct to about tol². What cannot be computed better,
        because of rounding, is taken as it is; ``FourierBasis.residuals`` tells.
    seed
        Of the random vectors that the search begins with.
    hold
        Vertices (indices or a mask) at which the functions are zero (Dirichlet); what is left of
        the boundary is free (Neumann).
    certify
        Prove that none is missing, by counting with Sylvester's law of inertia; the result is in
        ``FourierBasis.computation.counted_within``. It is done unasked where an eigenvalue is
        found so often that copies might have been missed.

    Returns
    -------
    The eigenvalues ascending; none is below zero where the pair is positive semi-definite. Vectors
    that belong to zero are known beforehand, one for each component without held vertices: constant
    there, zero elsewhere, and exact. (Where rounding leaves nothing of an eigenvalue it is zero,
    too, and comes behind those.) The sign: of the entries that are the largest (to 1e-6) the first
    is positive. The same input, seed and number of threads give the same bits; across machines only
    subspaces are comparable, because vectors with equal eigenvalues can be turned among themselves.

    Raises
    ------
    MeshError
        If a vertex has no mass; ``error.vertices``.
    ConvergenceError
        If the tolerance is not reached, or eigenpairs stay missing.
    BeltramiError
        If k, near or tol are not valid numbers.

    Notes
    -----
    Block Lanczos for :math:`(L - \sigma B)^{-1}B` in float32, with partial reorthogonalisation,
    and then inverse iteration by residuals in float64 (equation 3.9 with as many vectors as are
    wanted; one factorisation serves all steps). All in float64 for near > 0 or tol < 1e-9; LAPACK
    for n <= 500. Cost on a surface: 5 or 6 solves for each eigenpair and about 20 n k² operations;
    memory: at most 8 n k + 4 n (2.6 k + 500) bytes, whatever the convergence, by restarts that
    keep the Ritz vectors. Beyond 1500 eigenpairs the spectrum is cut into slices of 400, in
    float64, each counted by inertia; then the time grows like k. Grimes, Lewis and Simon 1994, "A
    shifted block Lanczos algorithm for solving sparse symmetric generalized eigenproblems".

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> basis = fourier_basis(laplacian(icosphere(2)), 4)
    >>> basis.eigenvalues.round(1).tolist(), bool(basis.orthogonality < 1e-9)
    ([0.0, 2.0, 2.0, 2.0], True)
    """
    require_laplacian(laplacian, "eigenpairs")
    held = as_indices(hold, laplacian.n, "held vertices")
    free = np.ones(laplacian.n, np.bool_)
    free[held] = False
    count = _checked(k, near, tol, int(free.sum()))
    L, B = laplacian.stiffness, laplacian.mass
    _require_mass(B, free)
    if len(held):
        L, B = csr_array(L[free][:, free]), csr_array(B[free][:, free])
    found = eigenpairs(
        L, B, count, float(near), float(tol),
        coordinates=_positions(laplacian, free), certify=certify, seed=seed,
    )  # fmt: skip
    if (found.values < 0).any() and laplacian.properties.positive_semidefinite:
        found = _not_negative(found, L, B)
    return FourierBasis(
        found.values,
        _everywhere(found, free),
        laplacian.mass,
        found.residuals,
        found.computation,
    )


def _checked(k: SupportsIndex, near: float, tol: float, most: int) -> int:
    try:
        count = operator.index(k)
    except TypeError:
        raise BeltramiError(f"k must be a whole number, not {k!r}") from None
    if not 1 <= count <= most:
        raise BeltramiError(f"k must be from 1 to {most}, the vertices that are free, not {count}")
    if not math.isfinite(near):
        raise BeltramiError(f"near must be a finite number, not {near}")
    if not (math.isfinite(tol) and tol > 0):
        raise BeltramiError(f"tol must be finite and > 0, not {tol}")
    return count


def _not_negative(found: Eigenpairs, L: csr_array, B: csr_array) -> Eigenpairs:
    """Make eigenvalues zero that rounding left below it: a needle has far larger ones beside them.

    They come behind the kernel that is known, and their residuals are those of a kernel.
    """
    scale = float((L.diagonal() / B.diagonal()).max())
    below = (found.values < 0) & (found.values > -_ROUNDING * scale)
    image = np.linalg.norm(L @ found.vectors, axis=0)
    size = np.linalg.norm(abs(L) @ np.abs(found.vectors), axis=0)
    values = np.where(below, 0.0, found.values)
    residuals = np.where(below, image / np.where(size > 0, size, 1.0), found.residuals)
    order = np.lexsort((below, values))
    vectors = np.ascontiguousarray(found.vectors[:, order])
    return replace(found, values=values[order], vectors=vectors, residuals=residuals[order])


def _require_mass(B: csr_array, free: Booleans) -> None:
    without = np.flatnonzero(free & ~(B.diagonal() > 0))
    if len(without):
        raise MeshError(
            "eigenvectors need a positive mass everywhere, and vertices have none",
            vertices=without,
            remedy='Leave them out, hold them, or use mass="unit".',
        )


def _everywhere(found: Eigenpairs, free: Booleans) -> Floats:
    """Return the vectors on all vertices, zero on those that are held."""
    if free.all():
        return found.vectors
    vectors = np.zeros((len(free), found.vectors.shape[1]))
    vectors[free] = found.vectors
    return vectors


def _positions(laplacian: Laplacian, free: Booleans) -> Floats | None:
    domain = laplacian.domain
    return domain.vertices[free] if isinstance(domain, Mesh) else None
