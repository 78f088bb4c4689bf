"""Find eigenpairs: the method that fits, and its precision."""

from __future__ import annotations

import time

import numpy as np

from beltrami.errors import ConvergenceError, SingularMatrixError
from beltrami.solvers.completing import complete
from beltrami.solvers.dense_pairs import dense_pairs
from beltrami.solvers.inverse import Inverse, definite_inverse, signed_inverse
from beltrami.solvers.nearest_pairs import Settings, largest_basis, search, settings_for
from beltrami.solvers.polish import polish
from beltrami.solvers.residuals import residuals
from beltrami.solvers.slices import SLICE, TIGHT, extend_by_slices
from beltrami.solvers.work import Work

SMALL = 500  # unknowns up to which LAPACK is as fast
SLICED = 1500  # eigenpairs beyond which the spectrum is cut into slices
LARGE = 6000  # unknowns up to which LAPACK does that as well
SINGLE = 1e-9  # tolerances below it need float64 throughout
_BEARABLE = 2500  # unknowns up to which it takes over where Lanczos does not arrive
_ZERO = 1e-10  # what a semi-definite pencil may round to, below zero
_GUARDS = 8  # pairs that the dense method keeps beyond those wanted, to count before them
_LOST = "the eigenpairs could not be computed: the pair is singular to working precision"


def find(work: Work, certify: bool, clock: list[tuple[str, float]]) -> None:
    """Compute what is not in the kernel: dense, from below, or around a shift inside.

    To certify a kernel takes the first eigenvalue beyond it.
    """
    pencil, kernel = work.pencil, work.pencil.kernel.shape[1]
    from_below = work.near <= 0
    least = int(certify and not pencil.kernel_goes_on(work.k))
    wanted = max(work.k - kernel, least) if from_below else work.k
    wanted = min(wanted, pencil.n - kernel)
    if wanted <= 0:
        return
    if from_below and wanted > SLICED and pencil.n > LARGE:
        _by_slices(work, clock)
        return
    if pencil.n <= SMALL or largest_basis(wanted) + kernel > pencil.n:
        _dense(work, wanted, clock)
        return
    work.method = "lanczos"
    try:
        if from_below and _from_below(work, wanted, clock):
            return
        work.definite = False
        inverse = signed_inverse(pencil, min(work.near, pencil.bound), 1e-3 / work.k)
        _patiently(work, inverse, min(work.k, pencil.n - kernel), clock)
    except (ConvergenceError, SingularMatrixError):
        if pencil.n > _BEARABLE:
            raise
        _dense(work, wanted, clock)


def _dense(work: Work, wanted: int, clock: list[tuple[str, float]]) -> None:
    """Compute all by LAPACK, and keep what is wanted."""
    pencil = work.pencil
    work.method = "dense"
    work.values, work.vectors = dense_pairs(pencil, wanted + _GUARDS, work.near)
    everything = slice(0, len(work.values))
    found = residuals(pencil, work.vectors, everything, work.values, np.float64)
    work.residuals, work.precision, work.history = found.norms, "float64", ()
    work.definite = bool(work.values[0] >= -_ZERO) and work.near <= 0
    clock.append(("dense", time.perf_counter()))


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
            if inverse.dtype == np.float64:
                _patiently(work, inverse, wanted, clock)
            else:
                _lanczos(work, inverse, wanted, settings_for(wanted, work.tol), clock)
        except (np.linalg.LinAlgError, ConvergenceError):
            if inverse.dtype == np.float64:
                raise
            continue
        if work.values[0] >= -_ZERO:
            return True
    return False


def _patiently(work: Work, inverse: Inverse, wanted: int, clock: list[tuple[str, float]]) -> None:
    """Search; if that fails, with larger blocks and more guards: multiplicities may be high."""
    settings = settings_for(wanted, work.tol)
    try:
        _lanczos(work, inverse, wanted, settings, clock)
    except (np.linalg.LinAlgError, ConvergenceError):
        patient = settings._replace(
            block=32, guards=settings.guards + 32, tolerance=settings.tolerance / 100
        )
        try:
            _lanczos(work, inverse, wanted, patient, clock)
        except np.linalg.LinAlgError as cause:
            raise ConvergenceError(_LOST) from cause


def _lanczos(
    work: Work,
    inverse: Inverse,
    wanted: int,
    settings: Settings,
    clock: list[tuple[str, float]],
) -> None:
    """Search, and polish what was found."""
    clock.append(("factorize", time.perf_counter()))
    pencil, kernel = work.pencil, work.pencil.kernel
    found = search(pencil, inverse, kernel, wanted, settings, work.seed)
    clock.append(("search", time.perf_counter()))
    polished = polish(pencil, found.inverse, found.vectors, found.values, kernel, wanted, work.tol)
    clock.append(("polish", time.perf_counter()))
    work.vectors, work.values, work.residuals = polished[:3]
    work.history = polished.history
    work.precision, work.shift = str(found.inverse.dtype), found.inverse.shift
    work.basis, work.block = max(work.basis, found.basis), settings.block
    work.solves += found.solves + polished.solves
