"""Find eigenpairs: the method that fits, and its precision."""

from __future__ import annotations

import time

import numpy as np

from beltrami.errors import ConvergenceError
from beltrami.solvers.completing import complete
from beltrami.solvers.dense_pairs import dense_pairs
from beltrami.solvers.inverse import Inverse, definite_inverse, signed_inverse
from beltrami.solvers.nearest_pairs import largest_basis, search, settings_for
from beltrami.solvers.polish import polish
from beltrami.solvers.residuals import residuals
from beltrami.solvers.slices import SLICE, TIGHT, extend_by_slices
from beltrami.solvers.work import Work

SMALL = 500  # unknowns up to which LAPACK is as fast
SLICED = 1200  # eigenpairs beyond which the spectrum is cut into slices
LARGE = 6000  # unknowns up to which LAPACK does that as well
SINGLE = 1e-9  # tolerances below it need float64 throughout
_ZERO = 1e-10  # what a semi-definite pencil may round to, below zero
_GUARDS = 8  # pairs that the dense method keeps beyond those wanted, to count before them
_LOST = "the eigenpairs could not be computed: the pair is singular to working precision"


def find(work: Work, certify: bool, clock: list[tuple[str, float]]) -> None:
    """Compute what is not in the kernel: dense, from below, or around a shift inside.

    To certify a kernel takes the first eigenvalue beyond it.
    """
    pencil, kernel = work.pencil, work.pencil.kernel.shape[1]
    from_below = work.near <= 0
    wanted = min(max(work.k - kernel, int(certify)) if from_below else work.k, pencil.n - kernel)
    if wanted <= 0:
        return
    if from_below and wanted > SLICED and pencil.n > LARGE:
        _by_slices(work, clock)
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
    if from_below and _from_below(work, wanted, clock):
        return
    work.definite = False
    near = min(work.near, pencil.bound)
    inverse = signed_inverse(pencil, near, 1e-3 / work.k)
    try:
        _lanczos(work, inverse, min(work.k, pencil.n - kernel), clock)
    except np.linalg.LinAlgError as cause:
        raise ConvergenceError(_LOST) from cause


def _by_slices(work: Work, clock: list[tuple[str, float]]) -> None:
    """Search from below, count what is there, and go on from slice to slice."""
    whole, work.k = work.k, SLICE + work.pencil.kernel.shape[1]
    work.tol = min(work.tol, TIGHT)
    find(work, True, clock)
    if not work.definite:
        raise ConvergenceError("slices of the spectrum need a pair that is semi-definite")
    complete(work)
    work.k = whole
    extend_by_slices(work)
    work.method = "slices"
    clock.append(("slices", time.perf_counter()))


def _from_below(work: Work, wanted: int, clock: list[tuple[str, float]]) -> bool:
    """Search with a definite factor below zero; whether there is one.

    What cannot be done in float32, because the pencil is too near to a singular one, is done in
    float64.
    """
    pencil = work.pencil
    kinds = (np.float32, np.float64) if work.tol >= SINGLE else (np.float64,)
    for kind in kinds:
        inverse = definite_inverse(pencil, settings_for(wanted, work.tol).shift, kind)
        if inverse is None:
            return False
        try:
            _lanczos(work, inverse, wanted, clock)
        except (np.linalg.LinAlgError, ConvergenceError) as cause:
            if inverse.dtype == np.float64:
                raise ConvergenceError(_LOST) from cause
            continue
        if work.values[0] >= -_ZERO:
            return True
    return False


def _lanczos(work: Work, inverse: Inverse, wanted: int, clock: list[tuple[str, float]]) -> None:
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
