"""All eigenpairs of a small pencil, by LAPACK."""

from __future__ import annotations

import numpy as np
import scipy.linalg

from beltrami._arrays import Floats
from beltrami.solvers.pencil import Pencil


def dense_pairs(pencil: Pencil, k: int, near: float) -> tuple[Floats, Floats]:
    """Return the k eigenpairs nearest to ``near`` that are not in the known kernel.

    That is moved out of the way, beyond the largest eigenvalue.
    """
    L, known = pencil.stiffness.toarray(), pencil.kernel
    if known.shape[1]:
        moved = pencil.weighed(known)
        L += 2 * np.abs(L).sum(axis=0).max() / _least(pencil) * (moved @ moved.T)
    mass = None if pencil.plain else pencil.mass.toarray()
    values, X = scipy.linalg.eigh(L, mass)
    count = pencil.n - known.shape[1]
    values, X = values[:count], X[:, :count]
    chosen = np.sort(np.argsort(np.abs(values - near), kind="stable")[:k])
    return values[chosen], np.ascontiguousarray(X[:, chosen])


def _least(pencil: Pencil) -> float:
    """Smallest eigenvalue of the mass."""
    return 1.0 if pencil.plain else float(np.linalg.eigvalsh(pencil.mass.toarray())[0])
