"""Minimal residuals (C. Paige, M. Saunders 1975), for symmetric matrices of any signs."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csc_array

from beltrami._arrays import Floats
from beltrami._kinds import checked
from beltrami._progress import Progress
from beltrami.errors import SingularMatrixError
from beltrami.solvers.conjugate_gradients import require_symmetric
from beltrami.solvers.iteration import IterativeSolution, Products, Trace, iterate
from beltrami.solvers.matrix import as_matrix
from beltrami.solvers.preconditioners import InPlace, Preconditioner, energy
from beltrami.solvers.vectors import blend, dot, recur


@checked
def minres(
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
    r"""Solve A x = b by minimal residuals; A may be indefinite, as :math:`L - \lambda B` is.

    The k-th :math:`x_k` minimises the residual in the norm of the preconditioner over a space of
    dimension k. Inverse iteration with λ inside the spectrum (equation 3.9) needs it, because
    conjugate gradients may divide by zero there (E68).

    Chapter items: P55.

    Parameters
    ----------
    A
        (n, n) scipy sparse matrix or array, symmetric.
    b, preconditioner, tolerance, most_iterations, start, kernel, progress
        As for ``conjugate_gradients``. The preconditioner must be positive definite, also where A
        is not: ``"jacobi"`` takes the absolute diagonal.

    Raises
    ------
    NotPositiveDefiniteError
        If the preconditioner is not positive definite.
    SingularMatrixError
        If b has a part in the kernel, or the iteration meets a kernel that was not told.
    ConvergenceError
        If the tolerance is not reached, or rounding forbids it; ``error.residuals`` is the
        history.
    DimensionError, NonFiniteError, MissingExtraError, UnknownNameError, BeltramiError
        If A, b or an option is not valid.

    Notes
    -----
    Each iteration is one product with A. The nearer λ is to an eigenvalue, the more there are
    (E67); the factors of ``factorize(A, backend="ldl")`` do not mind.

    Examples
    --------
    >>> import scipy.sparse
    >>> A = scipy.sparse.csr_array([[1.0, 0.0], [0.0, -1.0]])
    >>> minres(A, [1.0, 1.0]).solution.round(12).tolist()
    [1.0, -1.0]
    """
    matrix = as_matrix(A)
    require_symmetric(matrix, "minres needs")
    return iterate(
        "minres", _rotations, matrix, b, preconditioner,
        tolerance, most_iterations, start, kernel, progress,
    )  # fmt: skip


def _rotations(
    matrix: csc_array,  # noqa: ARG001
    r: Floats,
    x: Floats,
    trace: Trace,
    precondition: InPlace,
) -> Products:
    """Reduce A to three diagonals (Lanczos), and these to a triangle by one rotation a step.

    v, γ and δ are the vectors and the entries of Lanczos, w the directions in which x goes,
    (c, s) the rotations, and η the norm of the residual, with a sign.
    """
    v, v_before = r.copy(), np.zeros_like(r)
    w, w_before = np.zeros_like(r), np.zeros_like(r)
    p, q, z = np.empty_like(r), np.empty_like(r), np.empty_like(r)
    precondition(v, z)
    gamma = eta = math.sqrt(energy(v, z))
    gamma_before, c, c_before, s, s_before = 1.0, 1.0, 1.0, 0.0, 0.0
    while gamma > 0:
        np.divide(z, gamma, out=p)
        yield p, q
        delta = dot(q, p)
        recur(v_before, v, q, delta / gamma, gamma / gamma_before, 1.0)
        v, v_before = v_before, v
        precondition(v, z)
        gamma_next = math.sqrt(max(energy(v, z), 0.0))
        turned = c * delta - c_before * s * gamma
        pivot = math.hypot(turned, gamma_next)
        if not pivot > 0:
            raise SingularMatrixError(
                "minres met a direction that the matrix maps to zero: it is singular. Tell its "
                "kernel, or add a mass"
            )
        recur(w_before, w, p, s * delta + c_before * c * gamma, s_before * gamma, pivot)
        w, w_before = w_before, w
        c_before, c, s_before, s = c, turned / pivot, s, gamma_next / pivot
        blend(x, w, 1.0, c * eta)
        size = math.sqrt(blend(r, v, s * s, -c * eta / pivot))
        gamma_before, gamma, eta = gamma, gamma_next, -s * eta
        if trace.arrived(size):
            return
