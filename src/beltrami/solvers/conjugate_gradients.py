"""Conjugate gradients (M. Hestenes, E. Stiefel 1952), for symmetric positive definite matrices."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csc_array

from beltrami._arrays import Floats
from beltrami._kinds import checked
from beltrami._progress import Progress
from beltrami.errors import BeltramiError, NotPositiveDefiniteError, SingularMatrixError
from beltrami.solvers.iteration import IterativeSolution, Products, Trace, iterate
from beltrami.solvers.matrix import as_matrix
from beltrami.solvers.preconditioners import InPlace, Preconditioner, energy
from beltrami.solvers.symmetry import rows_against_definite, rows_against_symmetric
from beltrami.solvers.vectors import descend, dot, turn

_REMEDY = "minres(A, b) takes symmetric matrices of any signs"
_ROUNDING = 1e-13  # of <Ap, p>, beside the sum of the absolute values of its terms


@checked
def conjugate_gradients(
    A: Any,
    b: ArrayLike,
    *,
    preconditioner: str | Preconditioner = "jacobi",
    tolerance: float = 1e-10,
    most_iterations: int | None = None,
    start: ArrayLike | None = None,
    kernel: ArrayLike | str | None = "constants",
    progress: Progress | None = None,
) -> IterativeSolution:
    r"""Solve A x = b by conjugate gradients, without a factorisation.

    The k-th :math:`x_k` minimises :math:`\langle A(x - x^*), x - x^* \rangle` over a space of
    dimension k. An implicit step of heat, :math:`(B + \delta L) F_{k+1} = B F_k` (equation 3.7 made
    symmetric, E54), is such a system; so is a shift :math:`L - \lambda B` of inverse iteration with
    λ < 0, but not with λ inside the spectrum (E68): ``minres`` is for that.

    Chapter items: P34, P41, P55.

    Parameters
    ----------
    A
        (n, n) scipy sparse matrix or array, symmetric and positive definite, or semi-definite with
        the kernel that is told below.
    b
        (n,) or (n, c). Up to four columns share each pass over the matrix.
    preconditioner
        ``"jacobi"``: the diagonal; ``"multigrid"``: smoothed aggregation by pyamg (extra
        ``fast``), the number of iterations of which hardly grows with n; ``"none"``; or a function
        r -> z for (n,) that is linear, symmetric and positive definite, as ``Factor.solve`` of a
        similar matrix.
    tolerance
        Of :math:`|b - Ax| / |b|`, computed from the solution when the recursive one has arrived.
    most_iterations
        Of each column. Default: the least of 10 n + 20 and 20000.
    start
        What to start from, of the shape of b. Default: zero.
    kernel
        What A maps to zero. ``"constants"``: the constants on each component, if the rows of A add
        to zero, as those of a stiffness do; vectors (n,) or (n, k); or None. The solution is
        orthogonal to it: of mean zero for the constants.
    progress
        Called with (columns done, columns in all).

    Raises
    ------
    NotPositiveDefiniteError
        If A, or the preconditioner, is found not to be positive definite: by its entries
        (``error.rows``), or by a direction p with <Ap, p> < 0. It is not always found.
    SingularMatrixError
        If b has a part in the kernel, so that there is no solution, or if the iteration meets a
        kernel that was not told.
    ConvergenceError
        If the tolerance is not reached, or rounding forbids it; ``error.residuals`` is the
        history.
    DimensionError, NonFiniteError, MissingExtraError, UnknownNameError, BeltramiError
        If A, b or an option is not valid.

    Notes
    -----
    Each iteration is one product with A. With Jacobi's preconditioner their number grows like the
    root of the condition, on a mesh like √n for Poisson's equation. A factorisation is faster
    where it fits in memory and serves several steps (``factorize``).

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> pair = laplacian(icosphere(3))
    >>> z = pair.domain.vertices[:, 2]
    >>> found = conjugate_gradients(pair.stiffness, pair.mass @ z)  # -Δu = z
    >>> found, round(float(abs(found.solution - z / 2).max()), 3)
    (<IterativeSolution: conjugate gradients, preconditioner jacobi, 19 iterations, residual ...>,
     0.0)
    """
    matrix = as_matrix(A)
    _require_definite_entries(matrix)
    return iterate(
        "conjugate gradients", _descents, matrix, b, preconditioner,
        tolerance, most_iterations, start, kernel, progress,
    )  # fmt: skip


def _descents(
    matrix: csc_array, r: Floats, x: Floats, trace: Trace, precondition: InPlace
) -> Products:
    """Go down along directions that are conjugate to each other."""
    p, q, z = np.zeros_like(r), np.empty_like(r), np.empty_like(r)
    before = math.inf
    while True:
        precondition(r, z)
        slope = energy(r, z)
        turn(p, z, slope / before)
        before = slope
        yield p, q
        curvature = dot(p, q)
        if not curvature > 0:
            _refuse(matrix, p, curvature)
        size = math.sqrt(descend(x, r, p, q, slope / curvature))
        if trace.arrived(size):
            return


def _refuse(matrix: csc_array, p: Floats, curvature: float) -> None:
    """Raise the error of a direction in which A does not grow."""
    scale = float(np.abs(p) @ (abs(matrix) @ np.abs(p)))
    if curvature >= -_ROUNDING * scale:
        raise SingularMatrixError(
            "conjugate gradients met a direction that the matrix maps to zero: it is singular. "
            "Tell its kernel, or add a mass"
        )
    raise NotPositiveDefiniteError(
        (),
        "the matrix is not positive definite: conjugate gradients met a direction p with "
        f"<Ap, p> = {curvature / scale:.1e} of the sum of its absolute terms",
        _REMEDY,
    )


def _require_definite_entries(matrix: csc_array) -> None:
    """Check what the entries alone can tell; rows of zeros only are left to the kernel."""
    require_symmetric(matrix, "conjugate gradients need")
    diagonal = matrix.diagonal()
    if (diagonal > 0).all():
        wrong = rows_against_definite(matrix)
    else:
        wrong = np.flatnonzero((diagonal < 0) | ((diagonal == 0) & (np.diff(matrix.indptr) > 0)))
    if len(wrong):
        raise NotPositiveDefiniteError(wrong, remedy=_REMEDY)


def require_symmetric(matrix: csc_array, who: str) -> None:
    """Raise BeltramiError, with the entries, if a matrix is not symmetric to rounding."""
    pair = rows_against_symmetric(matrix).tolist()
    if pair:
        raise BeltramiError(
            f"{who} a symmetric matrix: entries {pair} and {pair[::-1]} differ. factorize takes it"
        )
