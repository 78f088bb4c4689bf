"""Prove that a list of eigenpairs is complete, or complete it."""

from __future__ import annotations

import numpy as np

from beltrami.errors import ConvergenceError
from beltrami.solvers.inertia import census
from beltrami.solvers.inverse import definite_inverse, signed_inverse
from beltrami.solvers.nearest_pairs import search, settings_for
from beltrami.solvers.polish import polish
from beltrami.solvers.work import Work

_EQUAL = 1e-6  # relative difference of eigenvalues that may be one of high multiplicity
_SEARCHES = 6  # for eigenpairs that a count has shown to be missing


def crowded(work: Work) -> bool:
    """Whether a multiplicity may be higher than a block can find: as many equal values as columns.

    A Krylov space of b vectors holds b copies of an eigenvalue; more come by rounding only.
    """
    values, b = work.values, work.block
    return bool((values[b - 1 :] - values[: len(values) - b + 1] <= _EQUAL * values[b - 1 :]).any())


def complete(work: Work) -> None:
    """Count the eigenvalues; search for missing ones, orthogonally to those that are known."""
    pencil = work.pencil
    if pencil.kernel_goes_on(work.k):
        return
    if len(work.values) + pencil.kernel.shape[1] == pencil.n:
        work.counted = np.inf
        return
    for attempt in range(_SEARCHES + 1):
        values = np.concatenate([np.zeros(pencil.kernel.shape[1]), work.values])
        doubts = np.concatenate([np.zeros(pencil.kernel.shape[1]), work.residuals * work.values])
        count = census(pencil, values, np.abs(doubts) + 1e-12, work.near, work.k, work.definite)
        missing = count.there - count.found
        if missing == 0:
            work.counted = count.radius
            return
        if missing < 0 or work.method != "lanczos" or attempt == _SEARCHES:
            break
        _search_again(work, missing, attempt + 1)
    raise ConvergenceError(
        f"{count.there} eigenvalues are within {count.radius * pencil.unit:.6g} of "
        f"{work.near * pencil.unit:.6g}, and {count.found} were found"
    )


def _search_again(work: Work, missing: int, attempt: int) -> None:
    """Find eigenpairs orthogonal to the known ones, and put them among those."""
    pencil = work.pencil
    settings = settings_for(missing, work.tol)
    inverse = (
        definite_inverse(pencil, work.shift, work.precision) if work.definite else None
    ) or signed_inverse(pencil, work.near, 1e-3 / work.k)
    known = np.hstack([pencil.kernel, work.vectors])
    found = search(pencil, inverse, known, missing, settings, work.seed + attempt)
    values = np.concatenate([work.values, found.values])
    order = np.argsort(values, kind="stable")
    X = np.ascontiguousarray(np.hstack([work.vectors, found.vectors])[:, order])
    wanted = min(work.k, len(values))
    again = polish(pencil, found.inverse, X, values[order], pencil.kernel, wanted, work.tol)
    work.vectors, work.values, work.residuals = again.vectors, again.values, again.residuals
    work.solves += found.solves + again.solves
