"""Residuals of approximate eigenpairs, and their norms in the units of the pair."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import DTypeLike

from beltrami._arrays import Floats
from beltrami._jit import kernel
from beltrami.solvers.pencil import Block, Pencil

_UNITS = 8.0  # of rounding in one residual


class Residuals(NamedTuple):
    """``vectors`` (n, c) Lx - λBx; ``norms`` (c,) beside λBx; ``rounding`` (c,) of the norms."""

    vectors: Block
    norms: Floats
    rounding: Floats


def residuals(
    pencil: Pencil, X: Floats, columns: slice, values: Floats, dtype: DTypeLike
) -> Residuals:
    r"""Return :math:`Lx - \lambda Bx` of some columns of X, computed in float64.

    Norms are those of (L, B), not of the scaled pencil: :math:`\|L\varphi - \lambda B\varphi\|
    / \|\lambda B\varphi\|`. Where rounding has left nothing of λ they are below 1/ε².
    """
    L, B = pencil.stiffness, pencil.mass
    R = np.empty((len(X), len(values)), dtype)
    sums = np.zeros((3, len(values)))
    _residuals(
        L.indptr, L.indices, L.data, B.indptr, B.indices, B.data, L.diagonal(), pencil.root,
        X, columns.start, values, R, *sums,
    )  # fmt: skip
    residual, force, size = np.sqrt(sums)
    eps, tiny = np.finfo(float).eps, np.finfo(float).tiny
    force = np.maximum(force * np.abs(values), np.maximum(eps**2 * size, tiny))
    return Residuals(R, residual / force, _UNITS * eps * size / force)


@kernel
def _residuals(
    starts: Any, columns: Any, data: Any, mass_starts: Any, mass_columns: Any, mass: Any,
    diagonal: Any, root: Any, X: Any, start: int, values: Any, R: Any, residual: Any, force: Any,
    size: Any,
) -> None:  # fmt: skip
    """Row by row; sums of squares of D r, of D B x, and of twice the diagonal times D x."""
    c = R.shape[1]
    Lx, Bx = np.empty(c), np.empty(c)
    for i in range(X.shape[0]):
        Lx[:] = 0
        Bx[:] = 0
        for q in range(starts[i], starts[i + 1]):
            a, x = data[q], X[columns[q], start : start + c]
            for j in range(c):
                Lx[j] += a * x[j]
        for q in range(mass_starts[i], mass_starts[i + 1]):
            a, x = mass[q], X[mass_columns[q], start : start + c]
            for j in range(c):
                Bx[j] += a * x[j]
        d, large, x, to = root[i], 2 * diagonal[i], X[i, start : start + c], R[i]
        for j in range(c):
            r = Lx[j] - values[j] * Bx[j]
            to[j] = r
            residual[j] += (d * r) ** 2
            force[j] += (d * Bx[j]) ** 2
            size[j] += (d * large * x[j]) ** 2
