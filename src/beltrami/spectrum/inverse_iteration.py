"""inverse_iteration: the eigenpair of (L, B) next to a shift (equation 3.9)."""

from __future__ import annotations

import math
import numbers
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Booleans, Floats, as_function, as_indices, whole
from beltrami._kinds import checked
from beltrami.errors import BeltramiError, DimensionError, MeshError
from beltrami.mesh.mesh import Mesh
from beltrami.operators.domain import require_laplacian
from beltrami.operators.pair import Laplacian
from beltrami.solvers.inverse_iteration import InverseIteration, iterate
from beltrami.solvers.shifted import shifted_solver


@checked
def inverse_iteration(
    laplacian: Laplacian,
    shift: float,
    start: ArrayLike | None = None,
    *,
    solver: str = "auto",
    tolerance: float = 1e-10,
    max_iterations: int = 200,
    max_inner_iterations: int = 10_000,
    hold: ArrayLike = (),
    seed: int = 0,
) -> InverseIteration:
    r"""Find the eigenpair nearest to a shift, :math:`w_{k+1} = (L - \sigma B)^{-1} B v_k`.

    Then :math:`v_{k+1} = w_{k+1} / |w_{k+1}|_B` (equation 3.9: powers of the *inverse* of the
    shifted matrix, E64). With the degree mass :math:`D^{1/2} v_k` are the iterates of the chapter,
    for :math:`\tilde L`. If λ is the eigenvalue nearest to σ and λ⁺ the next one, the line of
    v_k tends to the eigenvector like :math:`\rho^k`, and its Rayleigh quotient like
    :math:`\rho^{2k}`, where :math:`\rho = |\lambda - \sigma| / |\lambda^+ - \sigma|` (theorem 10;
    the line, since signs alternate where σ > λ, E65). This ρ is not a condition number (E67).

    Where λ is multiple the limit is the normalised B-orthogonal projection of the start on the
    eigenspace (nearly so with ``"minres"``). What the start has no part of comes in by rounding
    only, if at all.

    Chapter items: Q3.9, T10, P53, P54, P55.

    Parameters
    ----------
    laplacian
        The pair (L, B), of weights of any signs.
    shift
        σ, in the unit of the eigenvalues. Not an eigenvalue itself, so not 0 if nothing is held.
    start
        (n,) first vector v_0; by default random, from the seed.
    solver
        ``"lu"``: SuperLU, as the chapter has it. ``"ldl"``: LDL, much faster on large meshes,
        refused where it would need exchanges of rows. ``"auto"``: what ``factorize`` chooses. One
        factorisation serves all iterations. ``"minres"``: without one; the residual of each solve
        follows the last change of the vector. Conjugate gradients, which the chapter names, are
        for definite matrices (E68).
    tolerance
        On the distance of the line from its limit in the norm of B, as the last changes tell it.
    max_iterations, max_inner_iterations
        Of the vector; and of MINRES in each of them.
    hold
        Vertices (indices or a mask) where the eigenvector is 0: a boundary condition of Dirichlet.
    seed
        Of the random start.

    Raises
    ------
    SingularMatrixError
        If the shift is an eigenvalue to working precision.
    ConvergenceError
        If iterations run out, as they do where two eigenvalues are at the same distance; or if
        MINRES does not get to the residual that it must.
    MeshError
        If the start is zero, or all vertices are held.
    DimensionError, NonFiniteError, UnknownNameError, BeltramiError
        If the start, the solver or a number is not valid.

    Notes
    -----
    Cost: a factorisation, about n^1.5 on a surface, and a solve of about n log n for each
    iteration; a few more solves tell the next eigenvalue. The method is in J. Wilkinson, The
    Algebraic Eigenvalue Problem (1965); that inexact solves keep its rate if they follow the
    residual, in G. Golub and Q. Ye (BIT 40, 2000).

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> found = inverse_iteration(laplacian(icosphere(2)), 1.9)
    >>> round(found.eigenvalue, 3), round(found.rate, 2), round(found.predicted_rate, 4)
    (2.0, 0.05, 0.0526)
    """
    sigma = _finite("shift", shift)
    require_laplacian(laplacian, "inverse iteration")
    v = _start(laplacian, start, seed)
    limit = _finite("tolerance", tolerance)
    if not 0 < limit < 1:
        raise BeltramiError(f"the tolerance is between 0 and 1, not {limit:g}")
    free = _free(laplacian, hold)
    domain = laplacian.domain
    L, B = (csr_array(M[free][:, free]) for M in (laplacian.stiffness, laplacian.mass))
    prepared = shifted_solver(
        L,
        B,
        sigma,
        solver,
        coordinates=domain.vertices[free] if isinstance(domain, Mesh) else None,
        max_inner_iterations=_count("max_inner_iterations", max_inner_iterations),
    )
    most = _count("max_iterations", max_iterations)
    found = iterate(L, B, sigma, v[free], prepared, tolerance=limit, max_iterations=most)
    whole = np.zeros(laplacian.n)
    whole[free] = found.eigenvector
    return replace(found, eigenvector=whole)


def _free(laplacian: Laplacian, hold: ArrayLike) -> Booleans:
    """Return the mask of vertices that are not held."""
    free = np.ones(laplacian.n, np.bool_)
    free[as_indices(hold, laplacian.n, "vertices to hold")] = False
    if not free.any():
        raise MeshError("all vertices are held", remedy="Leave some free.")
    return free


def _start(laplacian: Laplacian, start: ArrayLike | None, seed: int) -> Floats:
    """Return the first vector."""
    if start is None:
        return np.random.default_rng(whole("seed", seed, 0)).standard_normal(laplacian.n)
    v = as_function(start, laplacian.n, "the start")
    if v.ndim != 1:
        raise DimensionError(f"the start is one vector ({laplacian.n},), not {v.shape}")
    return v


def _finite(name: str, value: float) -> float:
    if not isinstance(value, numbers.Real) or not math.isfinite(value):
        raise BeltramiError(f"{name} is a finite number, not {value!r}")
    return float(value)


def _count(name: str, value: int) -> int:
    if not isinstance(value, numbers.Integral) or value < 1:
        raise BeltramiError(f"{name} is an integer from 1 on, not {value!r}")
    return int(value)
