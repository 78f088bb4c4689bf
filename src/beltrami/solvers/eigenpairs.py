"""eigenpairs: the eigenvectors of a sparse symmetric pair (L, B) that are nearest to a number."""

from __future__ import annotations

import itertools
import time
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats
from beltrami.solvers.completing import complete, crowded
from beltrami.solvers.computation import Computation
from beltrami.solvers.finding import find
from beltrami.solvers.pencil import make_pencil
from beltrami.solvers.sign_rule import fix_signs
from beltrami.solvers.work import Work


@dataclass(frozen=True, eq=False)
class Eigenpairs:
    """Values (k,) ascending, vectors (n, k), residuals (k,), and how they were found."""

    values: Floats
    vectors: Floats
    residuals: Floats
    computation: Computation


def eigenpairs(
    L: csr_array,
    B: csr_array,
    k: int,
    near: float = 0.0,
    tol: float = 1e-6,
    *,
    coordinates: Floats | None = None,
    certify: bool = False,
    seed: int = 0,
) -> Eigenpairs:
    r"""Return the k eigenpairs of :math:`Lx = \lambda Bx` nearest to ``near``.

    Parameters
    ----------
    L, B
        (n, n) symmetric csr_arrays; B is positive definite.
    k
        1 <= k <= n.
    near
        For a positive semi-definite L and near <= 0 these are the k smallest.
    tol
        Largest :math:`\|Lx - \lambda Bx\| / \|\lambda Bx\|`, or its rounding where that is larger.
    coordinates
        (n, d) positions of the unknowns, to order the elimination by.
    certify
        Count the eigenvalues by inertia, and search for those that are missing. It is done
        unasked where one eigenvalue has been found as often as a block has columns.
    seed
        Of the first block, which is random.

    Raises
    ------
    ConvergenceError
        If the tolerance is not reached, or eigenvalues stay missing.
    SingularMatrixError
        If L - σB cannot be factorised for any σ beside ``near``.

    Notes
    -----
    Block shift-invert Lanczos in float32, polished by residuals in float64 that tell by themselves
    how good they are; in float64 throughout for near > 0 or tol < 1e-9; LAPACK for n <= 500.
    """
    clock = [("", time.perf_counter())]
    pencil = make_pencil(L, B, k, coordinates)
    clock.append(("prepare", time.perf_counter()))
    work = Work(
        pencil, near / pencil.unit, k, tol, seed, np.zeros(0), np.zeros((pencil.n, 0)), np.zeros(0)
    )
    find(work, certify, clock)
    certify = certify and work.method != "slices"  # which are counted already
    if certify or (work.method == "lanczos" and crowded(work)):
        complete(work)
        clock.append(("certify", time.perf_counter()))
    result = _select(work, L)
    fix_signs(result[1])
    clock.append(("finish", time.perf_counter()))
    seconds = tuple((b[0], b[1] - a[1]) for a, b in itertools.pairwise(clock))
    computation = Computation(
        work.method, work.precision, work.shift * pencil.unit, work.basis, work.solves,
        work.history, work.counted * pencil.unit, seconds,
    )  # fmt: skip
    return Eigenpairs(*result, computation)


def _select(work: Work, L: csr_array) -> tuple[Floats, Floats, Floats]:
    """Return the k nearest, the kernel among them, as pairs of (L, B)."""
    pencil, kernel = work.pencil, work.pencil.kernel
    zeros = np.zeros(kernel.shape[1])
    values = np.concatenate([zeros, work.values])
    chosen = np.sort(np.argsort(np.abs(values - work.near), kind="stable")[: work.k])
    chosen = chosen[np.argsort(values[chosen], kind="stable")]
    vectors = pencil.physical(kernel, work.vectors, chosen)
    null = np.flatnonzero(chosen < len(zeros))
    constants = vectors[:, null]
    vectors[:, null] = np.where(constants > 0, constants.max(axis=0, initial=0.0), 0.0)
    norms = np.concatenate([zeros, work.residuals])[chosen]
    image = np.linalg.norm(L @ vectors[:, null], axis=0)
    size = np.linalg.norm(abs(L) @ np.abs(vectors[:, null]), axis=0)
    norms[null] = image / np.where(size > 0, size, 1.0)
    return pencil.unit * values[chosen], vectors, norms
