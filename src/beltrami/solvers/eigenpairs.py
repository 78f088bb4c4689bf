"""eigenpairs: the eigenvectors of a sparse symmetric pair (L, B) that are nearest to a number."""

from __future__ import annotations

import itertools
import time
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats
from beltrami.errors import ConvergenceError
from beltrami.solvers.computation import Computation
from beltrami.solvers.dense_pairs import dense_pairs
from beltrami.solvers.inertia import census
from beltrami.solvers.inverse import Inverse, definite_inverse, signed_inverse
from beltrami.solvers.nearest_pairs import largest_basis, search, settings_for
from beltrami.solvers.pencil import Pencil, make_pencil
from beltrami.solvers.polish import polish
from beltrami.solvers.residuals import residuals
from beltrami.solvers.sign_rule import fix_signs

SMALL = 500  # unknowns up to which LAPACK is as fast
SINGLE = 1e-9  # tolerances below it need float64 throughout
_EQUAL = 1e-6  # relative difference of eigenvalues that may be one of high multiplicity
_ZERO = 1e-10  # what a semi-definite pencil may round to, below zero
_GUARDS = 8  # pairs that the dense method keeps beyond those wanted, to count before them
_SEARCHES = 6  # for eigenpairs that a count has shown to be missing


@dataclass(frozen=True, eq=False)
class Eigenpairs:
    """Values (k,) ascending, vectors (n, k), residuals (k,), and how they were found."""

    values: Floats
    vectors: Floats
    residuals: Floats
    computation: Computation


@dataclass(eq=False)
class _Work:
    """What grows during the computation; values and vectors of the pencil, without its kernel."""

    pencil: Pencil
    near: float
    k: int
    tol: float
    seed: int
    values: Floats
    vectors: Floats
    residuals: Floats
    definite: bool = True
    method: str = "kernel"
    precision: str = "float64"
    shift: float = 0.0
    basis: int = 0
    block: int = 0
    solves: int = 0
    history: tuple[float, ...] = ()
    counted: float = 0.0


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
    work = _Work(
        pencil, near / pencil.unit, k, tol, seed, np.zeros(0), np.zeros((pencil.n, 0)), np.zeros(0)
    )
    _find(work, certify, clock)
    if certify or (work.method == "lanczos" and _crowded(work)):
        _complete(work)
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


def _find(work: _Work, certify: bool, clock: list[tuple[str, float]]) -> None:
    """Compute what is not in the kernel: dense, from below, or around a shift inside.

    To certify a kernel takes the first eigenvalue beyond it.
    """
    pencil, kernel = work.pencil, work.pencil.kernel.shape[1]
    from_below = work.near <= 0
    wanted = min(max(work.k - kernel, int(certify)) if from_below else work.k, pencil.n - kernel)
    if wanted <= 0:
        return
    if pencil.n <= SMALL or largest_basis(wanted) + kernel > pencil.n:
        work.method = "dense"
        work.values, work.vectors = dense_pairs(pencil, wanted + _GUARDS, work.near)
        everything = slice(0, len(work.values))
        found = residuals(pencil, work.vectors, everything, work.values, np.float64)
        work.residuals = found.norms
        work.definite = bool(work.values[0] >= -_ZERO) and from_below
        clock.append(("dense", time.perf_counter()))
        return
    work.method = "lanczos"
    dtype = np.float64 if work.tol < SINGLE or not from_below else np.float32
    settings = settings_for(wanted, work.tol)
    inverse = definite_inverse(pencil, settings.shift, dtype) if from_below else None
    work.definite = inverse is not None
    if inverse is not None:
        _lanczos(work, inverse, wanted, clock)
        if work.values[0] >= -_ZERO:
            return
    work.definite = False
    wanted = min(work.k, pencil.n - kernel)
    near = min(work.near, pencil.bound)
    inverse = signed_inverse(pencil, near, 1e-3 / work.k)
    _lanczos(work, inverse, wanted, clock)


def _lanczos(work: _Work, inverse: Inverse, wanted: int, clock: list[tuple[str, float]]) -> None:
    """Search, and polish what was found."""
    clock.append(("factorize", time.perf_counter()))
    pencil, kernel = work.pencil, work.pencil.kernel
    settings = settings_for(wanted, work.tol)
    found = search(pencil, inverse, kernel, wanted, settings, work.seed)
    clock.append(("search", time.perf_counter()))
    polished = polish(pencil, found.inverse, found.vectors, found.values, kernel, wanted, work.tol)
    clock.append(("polish", time.perf_counter()))
    work.vectors, work.values, work.residuals = polished[:3]
    work.history = polished.history
    work.precision, work.shift = str(found.inverse.dtype), found.inverse.shift
    work.basis, work.block = max(work.basis, found.basis), settings.block
    work.solves += found.solves + polished.solves


def _crowded(work: _Work) -> bool:
    """Whether a multiplicity may be higher than a block can find: as many equal values as columns.

    A Krylov space of b vectors holds b copies of an eigenvalue; more come by rounding only.
    """
    values, b = work.values, work.block
    return bool((values[b - 1 :] - values[: len(values) - b + 1] <= _EQUAL * values[b - 1 :]).any())


def _complete(work: _Work) -> None:
    """Count the eigenvalues; search for missing ones, orthogonally to those that are known."""
    pencil = work.pencil
    if len(work.values) + pencil.kernel.shape[1] == pencil.n:
        work.counted = np.inf
        return
    for attempt in range(_SEARCHES):
        values = np.concatenate([np.zeros(pencil.kernel.shape[1]), work.values])
        doubts = np.concatenate([np.zeros(pencil.kernel.shape[1]), work.residuals * work.values])
        count = census(pencil, values, np.abs(doubts) + 1e-12, work.near, work.k, work.definite)
        missing = count.there - count.found
        if missing == 0:
            work.counted = count.radius
            return
        if missing < 0 or work.method != "lanczos":
            break
        _search_again(work, missing, attempt + 1)
    raise ConvergenceError(
        f"{count.there} eigenvalues are within {count.radius * pencil.unit:.6g} of "
        f"{work.near * pencil.unit:.6g}, and {count.found} were found"
    )


def _search_again(work: _Work, missing: int, attempt: int) -> None:
    """Find eigenpairs orthogonal to the known ones, and put them among those."""
    pencil = work.pencil
    settings = settings_for(missing, work.tol)
    inverse = (
        definite_inverse(pencil, work.shift, work.precision) if work.definite else None
    ) or signed_inverse(pencil, work.near, 1e-3 / work.k)
    known = np.hstack([pencil.kernel, work.vectors])
    found = search(pencil, inverse, known, missing, settings, work.seed + attempt)
    again = polish(pencil, found.inverse, found.vectors, found.values, known, missing, work.tol)
    order = np.argsort(np.concatenate([work.values, again.values]), kind="stable")
    work.values = np.concatenate([work.values, again.values])[order]
    work.residuals = np.concatenate([work.residuals, again.residuals])[order]
    work.vectors = np.hstack([work.vectors, again.vectors])[:, order]
    work.solves += found.solves + again.solves


def _select(work: _Work, L: csr_array) -> tuple[Floats, Floats, Floats]:
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
