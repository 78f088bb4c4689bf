"""Thousands of eigenpairs, slice by slice of the spectrum (Grimes, Lewis and Simon 1994).

One Lanczos process for k eigenpairs takes n k² operations; slices of a fixed number take n k. How
many eigenvalues are in a slice is counted by inertia beforehand, so none can be missed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from beltrami._arrays import Floats
from beltrami.errors import ConvergenceError, SingularMatrixError
from beltrami.solvers.inertia import count_below
from beltrami.solvers.inverse import signed_inverse
from beltrami.solvers.nearest_pairs import search, settings_for
from beltrami.solvers.pencil import Pencil
from beltrami.solvers.polish import polish
from beltrami.solvers.work import Work

SLICE = 400  # eigenpairs of a slice, about
_NEIGHBOURS = 48  # eigenvectors below a slice that are not to be found again
TIGHT = 1e-11  # residual that makes the vectors of neighbouring slices orthogonal, too
_TRIES = 8


class _Slice(NamedTuple):
    """From where to where, and what number of eigenvalues are in it."""

    start: float
    stop: float
    number: int


def extend_by_slices(work: Work) -> None:
    """Find eigenpairs above those of ``work``, which are complete up to ``work.counted``."""
    kernel = work.pencil.kernel.shape[1]
    inside = int((work.values < work.counted).sum())
    values, norms = [work.values[:inside]], [work.residuals[:inside]]
    vectors = [np.ascontiguousarray(work.vectors[:, :inside])]
    total, edge = kernel + inside, work.counted
    while total < min(work.k, work.pencil.n):
        below = np.concatenate(values)[-_NEIGHBOURS:]
        part = _next_slice(work, below, edge, total)
        known = vectors[-1][:, -_NEIGHBOURS:]
        if part.number:
            found = _pairs_of(work, part, known)
            values.append(found[0])
            vectors.append(found[1])
            norms.append(found[2])
        total, edge = total + part.number, part.stop
    work.values, work.residuals = np.concatenate(values), np.concatenate(norms)
    work.vectors = np.hstack(vectors)
    work.counted = edge


def _next_slice(work: Work, below: Floats, edge: float, total: int) -> _Slice:
    """Choose where the next slice ends, by the density of the eigenvalues below it."""
    missing = min(SLICE, work.k - total + 4)
    density = (len(below) - 1) / max(below[-1] - below[0], 1e-3 * below[-1])
    width = missing / density
    for _ in range(_TRIES):
        try:
            count = count_below(work.pencil, edge + width) - total
        except SingularMatrixError:
            width *= 1.001
            continue
        if count > 2 * SLICE:
            width *= SLICE / count
        elif count < missing / 4 and total + count < work.pencil.n:
            width *= 2
        else:
            break
    else:
        raise ConvergenceError("a slice of the spectrum could not be found: too many equal values")
    return _Slice(edge, edge + width, count)


def _pairs_of(work: Work, part: _Slice, known: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the values, vectors and residuals of a slice, all of them."""
    pencil: Pencil = work.pencil
    middle, tol = (part.start + part.stop) / 2, min(work.tol, TIGHT)
    inverse = signed_inverse(pencil, middle, 1e-3 * (part.stop - part.start) / part.number)
    values, norms = np.zeros(0), np.zeros(0)
    vectors = np.zeros((pencil.n, 0))
    for attempt in range(_TRIES):
        missing = part.number - len(values)
        settings = settings_for(missing + 2, tol)
        others = np.hstack([known, vectors])
        found = search(pencil, inverse, others, missing + 2, settings, work.seed + attempt)
        kernel = pencil.kernel[:, :0]
        done = polish(pencil, inverse, found.vectors, found.values, kernel, missing + 2, tol)
        inside = (done.values > part.start) & (done.values < part.stop)
        values = np.concatenate([values, done.values[inside]])
        norms = np.concatenate([norms, done.residuals[inside]])
        vectors = np.hstack([vectors, done.vectors[:, inside]])
        work.solves += found.solves + done.solves
        work.basis = max(work.basis, found.basis)
        if len(values) >= part.number:
            break
    if len(values) != part.number:
        raise ConvergenceError(
            f"{part.number} eigenvalues are in a slice of the spectrum, {len(values)} were found"
        )
    order = np.argsort(values, kind="stable")
    return values[order], np.ascontiguousarray(vectors[:, order]), norms[order]
