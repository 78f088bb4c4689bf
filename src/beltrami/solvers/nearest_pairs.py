"""The search: Lanczos around a shift that fits, until the wanted Ritz pairs stand still."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from beltrami._arrays import Floats
from beltrami.errors import ConvergenceError
from beltrami.solvers.inverse import Inverse, definite_inverse
from beltrami.solvers.lanczos import Lanczos, Ritz
from beltrami.solvers.pencil import Pencil

_FIT = 1.0  # a shift farther below zero than so many times the last eigenvalue is too far
_STEP = 0.12  # columns to add for each eigenvalue and each missing digit
_RESTARTS = 60


class Settings(NamedTuple):
    """How many columns at a time, how far below zero, how exact."""

    block: int
    shift: float
    guards: int
    tolerance: float


class Found(NamedTuple):
    """Approximate pairs, guards included, values ascending; what the search took."""

    vectors: Floats
    values: Floats
    inverse: Inverse
    basis: int
    solves: int


def settings_for(k: int, tol: float) -> Settings:
    """Return what the study found to be fast for k eigenpairs."""
    tolerance = 2 * min(tol, 1e-6)
    return Settings(_block(k), -0.05 if k <= 80 else -0.1, max(4, int(0.03 * k)), tolerance)


def largest_basis(k: int) -> int:
    """Return how many columns a search for k eigenpairs holds at most."""
    block = _block(k)
    return _most_columns(k, block) + block


def _most_columns(k: int, b: int) -> int:
    """Return the size of the basis at which Lanczos restarts."""
    return _blocks(2.6 * k + 20 * b, b)


def _first_look(k: int, b: int) -> int:
    """Return the size of the basis at which k eigenpairs of a surface have converged, about."""
    return _blocks(2.55 * k + 8 * b, b)


def _block(k: int) -> int:
    return 4 if k <= 12 else 8 if k <= 80 else 16 if k < 350 else 24


def search(
    pencil: Pencil, inverse: Inverse, known: Floats, k: int, settings: Settings, seed: int
) -> Found:
    """Find the k eigenpairs nearest to the shift of the inverse, and some guards.

    ``known`` eigenvectors are not found again. If the first Ritz values show that the shift, a
    guess, is far from where it should be, the search begins anew with a better one.

    Raises
    ------
    ConvergenceError
        If many restarts do not do.
    """
    random = np.random.default_rng(seed)
    n, b = pencil.n, settings.block
    count = min(k + settings.guards, n - known.shape[1])
    start = random.standard_normal((n, b), dtype=inverse.dtype.type)
    process = Lanczos(pencil, inverse, start, known, seed)
    solves = restarts = 0
    most = _most_columns(k, b)
    look = min(_first_look(k, b), most)
    while True:
        while process.size < look:
            process.extend()
        ritz = process.ritz(min(count, process.size))
        worst = float(ritz.errors[:k].max())
        better = _better_shift(inverse, ritz, k, settings.shift)
        if better is not None:
            moved = definite_inverse(pencil, better, inverse.dtype)
            if moved is not None:
                mixing = random.standard_normal((len(ritz.values), b))
                start = process.vectors(ritz) @ mixing
                solves += process.solves
                inverse, process = moved, Lanczos(pencil, moved, start, known, seed)
                look = min(_first_look(k, b), most)
                continue
        if worst < settings.tolerance or process.size + known.shape[1] + b > n:
            break
        more = math.log10(worst / settings.tolerance) * _STEP * k
        look = process.size + max(b, _blocks(more - b + 1, b))
        if look > most:
            if process.size + b <= most:
                look = process.size + b
                continue
            restarts += 1
            if restarts > _RESTARTS:
                raise ConvergenceError(
                    f"Lanczos stopped at a relative error of {worst:.1e} after many restarts"
                )
            process.restart(process.ritz(min(count + 2 * b, process.size)))
            look = process.size + _blocks((most - process.size) / 2, b)
    values = inverse.shift + 1 / ritz.values
    order = np.argsort(values, kind="stable")
    ritz = Ritz(ritz.values[order], ritz.coordinates[:, order], ritz.errors[order])
    X = process.vectors(ritz)
    return Found(X, values[order], inverse, process.size, solves + process.solves)


def _blocks(columns: float, b: int) -> int:
    """Round up to whole blocks."""
    return -(-math.ceil(columns) // b) * b


def _better_shift(inverse: Inverse, ritz: Ritz, k: int, wanted: float) -> float | None:
    """Return a shift in the right place below zero, if this one is much too far."""
    if not inverse.definite or inverse.shift >= 0:
        return None
    last = inverse.shift + 1 / float(ritz.values[min(k, len(ritz.values)) - 1])
    return wanted * last if 0 < last < -inverse.shift / _FIT else None
