"""Rayleigh-Ritz for columns that are nearly eigenvectors, in the form of a correction."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.linalg

from beltrami._arrays import Floats, Integers
from beltrami.solvers.columns import FEW, without_dust
from beltrami.solvers.pencil import Block, Pencil

_SMALL = 1e-4  # a rotation whose second order is rounding
_APART = 1e-5  # relative distance of eigenvalues whose vectors are turned against each other
_TURNED = (1e-2, 1e-4)  # rotations beyond this are done in float64: in the first pass, later


class Projected(NamedTuple):
    """Z'AZ and Z'BZ of the improved columns Z = X - E."""

    operator: Floats
    gram: Floats


def projected(
    pencil: Pencil, X: Floats, E: Block, columns: Integers, distances: Floats, fresh: bool
) -> tuple[Projected, float]:
    r"""Project A = L - σB on Z = X - E, where E = A⁻¹(LX - BXΛ), so that AZ = BX(Λ - σ).

    So :math:`Z^TAZ = (G - C^T)(\Lambda - \sigma)` and :math:`Z^TBZ = G - C - C^T + E^TBE` with
    :math:`G = X^TBX`, :math:`C = X^TBE`: no product with A, and what is large (G) is known well
    while what is computed in single precision (C) is small. E has the chosen columns only. If not
    ``fresh``, G is taken to be the identity. The largest entry of C is told as well.
    """
    k, exact = X.shape[1], E.dtype == np.float64
    part = np.zeros((k, len(columns)), E.dtype)
    G = np.zeros((k, k))
    BX = X if pencil.plain else np.asarray(pencil.mass @ X)
    for r in range(0, len(X), FEW):
        rows = BX[r : r + FEW]
        part += rows.astype(E.dtype, copy=False).T @ E[r : r + FEW]
        if fresh or exact:
            G += X[r : r + FEW].T @ rows
    G = (G + G.T) / 2 if fresh or exact else np.eye(k)
    C = np.zeros((k, k))
    C[:, columns] = part
    gram = G - C - C.T
    if len(columns):
        gram[np.ix_(columns, columns)] += E.T @ pencil.weighed(E)
    operator = (G - C.T) * distances
    small = Projected((operator + operator.T) / 2, (gram + gram.T) / 2)
    return small, float(np.abs(C).max(initial=0.0))


def rotation(small: Projected, gentle: bool) -> tuple[Floats, Floats]:
    """Return the eigenvalues of the projected pencil, and the columns that diagonalise it.

    ``gentle``: to first order where that is exact enough; vectors of nearly equal eigenvalues are
    then left as they are, because turning them in single precision would only add noise.
    """
    if gentle:
        found = _first_order(small)
        if found is not None:
            return found
    values, S = scipy.linalg.eigh(*small, check_finite=False)
    nearest = _matching(small)
    return values[nearest], S[:, nearest] * np.where(np.diag(S[:, nearest]) < 0, -1.0, 1.0)


def _matching(small: Projected) -> Integers:
    """Return for each column the Ritz pair that has its place in the order of the values."""
    places = np.empty(len(small.gram), np.int64)
    places[np.argsort(np.diag(small.operator) / np.diag(small.gram), kind="stable")] = np.arange(
        len(places)
    )
    return places


def _first_order(small: Projected) -> tuple[Floats, Floats] | None:
    excess = small.gram - np.eye(len(small.gram))
    B = small.operator - (excess @ small.operator + small.operator @ excess) / 2
    values = np.diag(B).copy()
    difference = values - values[:, None]
    apart = np.abs(difference) > _APART * np.abs(values)
    np.fill_diagonal(apart, False)
    turn = np.where(apart, B / np.where(apart, difference, 1.0), 0.0)
    if np.abs(turn).max() < _SMALL and np.abs(excess).max() < _SMALL:
        return values, np.eye(len(values)) - excess / 2 + turn
    return None


def rotate(X: Floats, E: Block, columns: Integers, S: Floats, fresh: bool) -> None:
    """Replace X by (X - E) S in place, the small part of S in the precision of E."""
    exact = E.dtype == np.float64
    change = S - np.eye(len(S))
    large = np.flatnonzero(
        np.abs(change).max(axis=0) > (0 if exact else _TURNED[0 if fresh else 1])
    )
    exactly = np.ascontiguousarray(S[:, large])
    small, whole = without_dust(change, E.dtype), len(columns) == len(S)
    for r in range(0, len(X), FEW):
        x = X[r : r + FEW]
        if whole:
            x -= E[r : r + FEW]
        else:
            x[:, columns] -= E[r : r + FEW]
        turned = x @ exactly if len(large) else None
        if not exact:
            x += x.astype(E.dtype) @ small
        if turned is not None:
            x[:, large] = turned
