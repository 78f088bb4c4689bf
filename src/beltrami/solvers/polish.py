"""Polish approximate eigenvectors until their residuals, in float64, are small: a certificate."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami.errors import ConvergenceError
from beltrami.solvers.columns import subtract_product
from beltrami.solvers.davidson import enriched
from beltrami.solvers.inverse import Inverse, better_inverse
from beltrami.solvers.pencil import Block, Pencil
from beltrami.solvers.rayleigh import projected, rotate, rotation
from beltrami.solvers.residuals import residuals

_BLOCK = 64  # columns whose residuals are computed and solved with at a time
_PASSES = 30
_SAFE = 0.7  # of the tolerance: columns below it are left alone
_STALLED = 0.2  # a pass that leaves more than this of the residual has stalled
_PATIENCE = 3  # passes that stall before the factor is made in float64
_LARGE = 1e-3  # a correction of which single precision keeps too little
_MOST = 64  # directions that one Davidson step adds


class Polished(NamedTuple):
    """Eigenpairs with residuals that are small; the worst residual of each pass; solves."""

    vectors: Floats
    values: Floats
    residuals: Floats
    history: tuple[float, ...]
    solves: int


class _Pass(NamedTuple):
    norms: Floats
    limits: Floats
    corrections: Block
    columns: Integers


def polish(
    pencil: Pencil,
    inverse: Inverse,
    X: Floats,
    values: Floats,
    known: Floats,
    wanted: int,
    tol: float,
) -> Polished:
    """Correct the columns of X, in place, by u <- u - A⁻¹(Lu - λBu) and Rayleigh-Ritz.

    The residual is in float64 and the solution in the precision of the inverse: so one pass is a
    step of inverse iteration, and its first half tells whether it was needed. It ends when the
    ``wanted`` pairs nearest to the shift have residuals of at most ``tol``, or as small as they
    can be computed. The others are guards; values ascend. All stay orthogonal to the eigenvectors
    that are ``known``.

    Raises
    ------
    ConvergenceError
        If that takes more than 30 passes.
    """
    history: list[float] = []
    stalled = solves = 0
    fresh = True
    _clear(pencil, X, known)
    for count in range(_PASSES):
        first = count == 0
        now = _corrections(pencil, inverse, X, values, 0.0 if first else tol)
        solves += len(now.columns)
        _clear(pencil, now.corrections, known)
        nearest = np.argsort(np.abs(values - inverse.shift), kind="stable")[:wanted]
        history.append(float(now.norms[nearest].max(initial=0.0)))
        if not fresh and (now.norms <= now.limits)[nearest].all():
            return Polished(X, values, now.norms, tuple(history), solves)
        if stalled % 2 and inverse.definite:  # inside the spectrum it could mislead
            X, values = _with_davidson(pencil, inverse, X, values, now)
            fresh = False
        else:
            values, change = _improved(pencil, inverse, X, values, now, fresh)
            fresh = change > _LARGE
        order = np.argsort(values, kind="stable")
        if (np.diff(order) < 0).any():
            X, values = np.ascontiguousarray(X[:, order]), values[order]
        if stalled or (count >= 1 and history[-1] > _STALLED * history[-2]):
            stalled += 1
        if stalled == _PATIENCE:
            inverse = better_inverse(pencil, inverse)
    raise ConvergenceError(
        f"eigenpairs could not be polished beyond a residual of {history[-1]:.1e} (tol={tol:g})"
    )


def _corrections(pencil: Pencil, inverse: Inverse, X: Floats, values: Floats, tol: float) -> _Pass:
    """Compute the residuals, and A⁻¹r for the columns where they are not small."""
    norms, limits = np.empty(len(values)), np.empty(len(values))
    parts, columns = [np.empty((len(X), 0), inverse.dtype)], []
    for start in range(0, len(values), _BLOCK):
        stop = min(start + _BLOCK, len(values))
        found = residuals(pencil, X, slice(start, stop), values[start:stop], inverse.dtype)
        norms[start:stop] = found.norms
        limits[start:stop] = np.maximum(tol, found.rounding)
        chosen = np.flatnonzero(found.norms > _SAFE * limits[start:stop] * (tol > 0))
        if len(chosen):
            whole = len(chosen) == stop - start
            right = found.vectors if whole else np.ascontiguousarray(found.vectors[:, chosen])
            parts.append(inverse(right))
            columns.append(start + chosen)
    E = np.concatenate(parts, axis=1)
    return _Pass(norms, limits, E, np.concatenate(columns) if columns else np.zeros(0, np.int64))


def _clear(pencil: Pencil, X: Block, known: Floats) -> None:
    """Take the parts along known eigenvectors away, in place."""
    if known.shape[1]:
        known = known.astype(X.dtype, copy=False)
        subtract_product(X, known, pencil.weighed(known).T @ X)


def _improved(
    pencil: Pencil, inverse: Inverse, X: Floats, values: Floats, now: _Pass, fresh: bool
) -> tuple[Floats, float]:
    """Take the corrections away, and turn the columns into Ritz vectors, in place.

    Returns the values, and how much of that was in the precision of the inverse.
    """
    E, columns = now.corrections, now.columns
    small, change = projected(pencil, X, E, columns, values - inverse.shift, fresh)
    single = E.dtype == np.float32
    distances, S = rotation(small, gentle=single and not fresh)
    rotate(X, E, columns, S, fresh)
    return inverse.shift + distances, change if single else 0.0


def _with_davidson(
    pencil: Pencil, inverse: Inverse, X: Floats, values: Floats, now: _Pass
) -> tuple[Floats, Floats]:
    """Add the corrections of the worst columns to the subspace."""
    worst = np.argsort(-now.norms[now.columns], kind="stable")[:_MOST]
    return enriched(pencil, X, values, now.corrections[:, worst], inverse.shift)
