"""Orthonormal blocks: Cholesky QR, with directions that are only rounding replaced by new ones."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.linalg

from beltrami._arrays import Floats
from beltrami.solvers.columns import Columns
from beltrami.solvers.pencil import Block, Pencil

_TIMES_ROUNDING = 100.0  # what is shorter than so many units of rounding has no direction


class Orthonormal(NamedTuple):
    """W = Q R with Q'BQ = Id; ``lost``: how short the shortest direction of W was, at most 1."""

    block: Block
    factor: Floats
    lost: float


def orthonormalize(pencil: Pencil, W: Block) -> Block:
    """Return an orthonormal block with the same span, for a W that is not far from one."""
    return W @ _inverse_factor(_gram(pencil, W))[0].astype(W.dtype)


def new_block(
    pencil: Pencil, W: Block, size: float, known: Columns, random: np.random.Generator
) -> Orthonormal:
    """Orthonormalise what is left of a block of length ``size`` after projections.

    Directions that are no longer than the rounding of ``size`` are replaced by random ones,
    orthogonal to all that is known; R maps nothing to them.
    """
    G = _gram(pencil, W)
    lengths, V = np.linalg.eigh(G)
    rounding = (_TIMES_ROUNDING * float(np.finfo(W.dtype).eps) * size) ** 2
    alive = lengths > rounding
    lost = float(np.sqrt(max(lengths[0], 0.0))) / size if size else 0.0
    if alive.all():
        first, R = _inverse_factor(G)
        Q = W @ first.astype(W.dtype)
        second, again = _inverse_factor(_gram(pencil, Q))
        return Orthonormal(Q @ second.astype(W.dtype), again @ R, lost)
    Q = np.empty_like(W)
    count = int(alive.sum())
    turn = V[:, alive] / np.sqrt(lengths[alive])
    R = np.zeros_like(G)
    R[:count] = (V[:, alive] * np.sqrt(lengths[alive])).T
    Q[:, :count] = W @ turn.astype(W.dtype)
    Q[:, count:] = random.standard_normal((len(W), W.shape[1] - count), dtype=W.dtype.type)
    for _ in range(3):
        known.subtract(Q, known.transposed_times(pencil.weighed(Q), known.count))
        Q = _one_after_another(pencil, Q, count)
    return Orthonormal(Q, R, lost)


def _one_after_another(pencil: Pencil, Q: Block, count: int) -> Block:
    """Orthonormalise the first ``count`` columns, and the others against them."""
    first = orthonormalize(pencil, Q[:, :count]) if count else Q[:, :0]
    others = Q[:, count:] - first @ (first.T @ pencil.weighed(Q[:, count:]))
    return np.ascontiguousarray(np.hstack([first, orthonormalize(pencil, others)]))


def _gram(pencil: Pencil, W: Block) -> Floats:
    G = (W.T @ pencil.weighed(W)).astype(np.float64)
    return (G + G.T) / 2


def _inverse_factor(G: Floats) -> tuple[Floats, Floats]:
    """Return R⁻¹ and R with G = R'R."""
    size = np.sqrt(np.diag(G))
    R = np.linalg.cholesky(G / size / size[:, None]).T * size
    return scipy.linalg.solve_triangular(R, np.eye(len(R)), check_finite=False), R
