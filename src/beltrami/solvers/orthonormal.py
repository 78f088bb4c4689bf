"""Orthonormal blocks: Cholesky QR; where directions are nearly lost, one column after another."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from beltrami._arrays import Booleans, Floats
from beltrami.solvers.columns import Columns
from beltrami.solvers.pencil import Block, Pencil

_TIMES_ROUNDING = 100.0  # what is shorter than so many units of rounding has no direction
_WEAK = 3e-3  # of the size: what is shorter carries much of the rounding of old directions
_FLAT = 1e2  # units of rounding: a Gram matrix with a smaller eigenvalue is not relied on


def orthonormalize(pencil: Pencil, W: Block) -> Block:
    """Return an orthonormal block with the same span, for a W that is not far from one."""
    G = _gram(pencil, W)
    if _is_flat(np.linalg.eigvalsh(G), W.dtype):
        return _in_turn(pencil, W, 0.0)[0].astype(W.dtype)
    return W @ _inverse_factor(G)[0].astype(W.dtype)


def new_block(
    pencil: Pencil, W: Block, size: float, known: Columns, random: np.random.Generator
) -> tuple[Block, Floats]:
    """Return Q and R with W = Q R, for what is left of a block of length ``size``.

    W is changed. If little is left, its rounding is first cleared of all that is known.
    Directions that are no longer than the rounding of ``size`` are replaced by random ones,
    orthogonal to all that is known; R maps nothing to them.
    """
    G = _gram(pencil, W)
    lengths = np.linalg.eigvalsh(G)
    if lengths[0] < (_WEAK * size) ** 2:
        for _ in range(2):
            known.subtract(W, known.transposed_times(pencil.weighed(W), 0, known.count))
        G = _gram(pencil, W)
        lengths = np.linalg.eigvalsh(G)
    rounding = _TIMES_ROUNDING * float(np.finfo(W.dtype).eps) * size
    if lengths[0] > rounding**2 and not _is_flat(lengths, W.dtype):
        first, R = _inverse_factor(G)
        Q = W @ first.astype(W.dtype)
        second, again = _inverse_factor(_gram(pencil, Q))
        return Q @ second.astype(W.dtype), again @ R
    exact, R, dead = _in_turn(pencil, W, rounding)
    Q = exact.astype(W.dtype)
    if dead.any():
        _renew(pencil, Q, dead, known, random)
    return Q, R


def _renew(
    pencil: Pencil, Q: Block, dead: Booleans, known: Columns, random: np.random.Generator
) -> None:
    """Put random directions, orthogonal to everything, in place of the dead columns."""
    kept, fresh = Q[:, ~dead], random.standard_normal((len(Q), int(dead.sum())))
    new = fresh.astype(Q.dtype)
    for _ in range(3):
        known.subtract(new, known.transposed_times(pencil.weighed(new), 0, known.count))
        new = new - kept @ (kept.T @ pencil.weighed(new))
        new = orthonormalize(pencil, new)
    Q[:, dead] = new


def _in_turn(pencil: Pencil, W: Block, rounding: float) -> tuple[Floats, Floats, Booleans]:
    """Orthonormalise one column after another, in float64: Q, R, and which columns are dead."""
    Q = W.astype(np.float64)
    b = Q.shape[1]
    R, dead = np.zeros((b, b)), np.zeros(b, np.bool_)
    for j in range(b):
        q, before = Q[:, j : j + 1], Q[:, :j]
        for _ in range(2):
            C = before.T @ pencil.weighed(q)
            q -= before @ C
            R[:j, j] += C[:, 0]
        length = float(np.sqrt((q * pencil.weighed(q)).sum()))
        dead[j] = length <= rounding
        q *= 0.0 if dead[j] else 1 / length
        R[j, j] = 0.0 if dead[j] else length
    return Q, R, dead


def _gram(pencil: Pencil, W: Block) -> Floats:
    G = (W.T @ pencil.weighed(W)).astype(np.float64)
    return (G + G.T) / 2


def _is_flat(lengths: NDArray[Any], dtype: np.dtype[Any]) -> bool:
    """Whether the squares of the lengths of a block differ so much that rounding hides some."""
    return bool(lengths[0] <= _FLAT * float(np.finfo(dtype).eps) * lengths[-1])


def _inverse_factor(G: Floats) -> tuple[Floats, Floats]:
    """Return R⁻¹ and R with G = R'R."""
    size = np.sqrt(np.diag(G))
    R = np.linalg.cholesky(G / size / size[:, None]).T * size
    inverse = scipy.linalg.solve_triangular(R, np.eye(len(R)), check_finite=False)
    return np.asarray(inverse, np.float64), np.asarray(R, np.float64)
