"""Rayleigh-Ritz on the columns and their corrections together (Davidson 1975)."""

from __future__ import annotations

import numpy as np
import scipy.linalg

from beltrami._arrays import Floats
from beltrami.solvers.columns import FEW
from beltrami.solvers.pencil import Block, Pencil

_DEPENDENT = 1e-8  # eigenvalue of a Gram matrix beside the largest that counts as zero


def enriched(
    pencil: Pencil, X: Floats, values: Floats, E: Block, shift: float
) -> tuple[Floats, Floats]:
    """Return as many Ritz pairs of the span of X and E as X has columns, nearest to the shift.

    X is orthonormal and diagonalises L. This finds what inverse iteration cannot separate:
    columns mixed with eigenvectors that are beyond the last.
    """
    k = X.shape[1]
    E = _complement(pencil, X, E)
    LE = np.asarray(pencil.stiffness @ E)
    H = np.zeros((k + E.shape[1],) * 2)
    H[:k, :k] = np.diag(values)
    H[:k, k:] = X.T @ LE
    H[k:, :k] = H[:k, k:].T
    H[k:, k:] = E.T @ LE
    found, S = scipy.linalg.eigh((H + H.T) / 2, check_finite=False)
    chosen = np.sort(np.argsort(np.abs(found - shift), kind="stable")[:k])
    S = np.ascontiguousarray(S[:, chosen])
    result = np.empty_like(X)
    for r in range(0, len(X), FEW):
        result[r : r + FEW] = X[r : r + FEW] @ S[:k] + E[r : r + FEW] @ S[k:]
    return result, found[chosen]


def _complement(pencil: Pencil, X: Floats, E: Block) -> Floats:
    """Return an orthonormal basis, in float64, of what E adds to X."""
    E = E.astype(np.float64)
    E /= np.maximum(np.linalg.norm(E, axis=0), np.finfo(float).tiny)
    for _ in range(2):
        E -= X @ (X.T @ pencil.weighed(E))
    for _ in range(2):
        lengths, V = np.linalg.eigh(E.T @ pencil.weighed(E))
        kept = lengths > _DEPENDENT * lengths.max(initial=np.finfo(float).tiny)
        E = E @ (V[:, kept] / np.sqrt(lengths[kept]))
        E -= X @ (X.T @ pencil.weighed(E))
    return E
