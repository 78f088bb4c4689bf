"""Block Lanczos for (L - σB)⁻¹B, with partial reorthogonalisation and thick restart."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import scipy.linalg

from beltrami._arrays import Floats
from beltrami.solvers.columns import Columns, subtract_product
from beltrami.solvers.inverse import Inverse
from beltrami.solvers.orthonormal import new_block, orthonormalize
from beltrami.solvers.pencil import Block, Pencil

_LONGEST = 4  # steps between two reorthogonalisations, at most
_KEPT = 0.45  # of the digits of the precision may be lost


class Ritz(NamedTuple):
    """Eigenvalues of the projected operator, largest in size first.

    ``coordinates`` (m, count) in the basis; ``errors`` the norms of their residuals beside them.
    """

    values: Floats
    coordinates: Floats
    errors: Floats


class Lanczos:
    r"""An orthonormal basis Q, :math:`Q^TBQ = Id`, that grows block by block, and H = Q'B A⁻¹B Q.

    The method of the study: all in the precision of the inverse; each new block is made
    orthogonal to the last two at once, and to all others (two blocks together) only as often as
    their loss, which is measured, demands (Simon 1984; Grimes, Lewis and Simon 1994). Eigenvectors
    that are ``known`` stand before the first block, and what is found is orthogonal to them. A
    restart keeps Ritz vectors in place of the blocks (Wu and Simon 2000).
    """

    def __init__(
        self, pencil: Pencil, inverse: Inverse, start: Block, known: Block, seed: int
    ) -> None:
        self.pencil, self.inverse = pencil, inverse
        self.basis = Columns(pencil.n, inverse.dtype)
        self.solves = 0
        self._random = np.random.default_rng(seed)
        self._known = known.shape[1]
        if self._known:
            self.basis.append(known.astype(inverse.dtype))
        self._H = np.zeros((0, 0))
        self._last = self._orthogonal(start)
        self._coupling = np.zeros((start.shape[1], 0))
        self._period, self._since, self._arrow = 2, 0, self._known > 0
        self.basis.append(self._last)

    @property
    def size(self) -> int:
        """Number of columns of the basis that H knows."""
        return len(self._H)

    def _orthogonal(self, start: Block) -> Block:
        q = orthonormalize(self.pencil, start.astype(self.inverse.dtype))
        for _ in range(2):
            C = self.basis.transposed_times(self.pencil.weighed(q), 0, self.basis.count)
            self.basis.subtract(q, C)
            q = orthonormalize(self.pencil, q)
        return q

    def extend(self) -> None:
        """Apply the operator to the last block, and make a new one of what is left."""
        q, j, b = self._last, self.size, self._last.shape[1]
        self._H = np.pad(self._H, (0, b))
        self._H[j:, :j] = self._padded(j)
        self._H[:j, j:] = self._H[j:, :j].T
        W = self.inverse(self.pencil.weighed(q))
        self.solves += b
        size = math.sqrt(abs(float(np.vdot(W, self.pencil.weighed(W)))) / b)
        stop = self.basis.count
        recent = max(stop - 2 * b, self._known)
        C = self._remove(W, recent, stop)[-b:]
        whole = self._arrow or self._period == 1
        C += self._remove(W, 0 if whole else recent, stop, self._period == 1)[-b:]
        self._H[j:, j:] = (C + C.T) / 2
        new, R = new_block(self.pencil, W, size, self.basis, self._random)
        self._since = 0 if whole else self._since + 1
        if self._since >= self._period and stop > b:
            q, new = self._reorthogonalize(q, new)
        self.basis.append(new)
        self._last, self._coupling, self._arrow = new, R, False

    def _remove(self, W: Block, start: int, stop: int, watched: bool = False) -> Floats:
        """Make W orthogonal to columns of the basis; return the coefficients.

        If ``watched``, those of the columns but for the last two blocks tell what was lost.
        """
        C = self.basis.transposed_times(self.pencil.weighed(W), start, stop)
        self.basis.subtract(W, C, start)
        old = C[: max(len(C) - 2 * W.shape[1], 0)]
        if watched and old.size:
            length = math.sqrt(abs(float(np.vdot(W, self.pencil.weighed(W)))) / W.shape[1])
            self._choose(float(np.abs(old).max()) / max(length, np.finfo(C.dtype).tiny), 1)
        return C.astype(np.float64)

    def _padded(self, j: int) -> Floats:
        """Return the rows of H that couple the last block to the columns before it."""
        rows = np.zeros((self._last.shape[1], j))
        if self._coupling.shape[1]:
            rows[:, j - self._coupling.shape[1] :] = self._coupling
        return rows

    def _reorthogonalize(self, q: Block, new: Block) -> tuple[Block, Block]:
        """Make the last two blocks orthogonal to all before, and choose the next time."""
        b = q.shape[1]
        j = self.basis.count - b
        Z = np.hstack([q, new])
        C = self.basis.transposed_times(self.pencil.weighed(Z), 0, j)
        self.basis.subtract(Z, C)
        q = orthonormalize(self.pencil, np.ascontiguousarray(Z[:, :b]))
        new = np.ascontiguousarray(Z[:, b:])
        subtract_product(new, q, q.T @ self.pencil.weighed(new))
        new = orthonormalize(self.pencil, new)
        self.basis.replace_last(q)
        self._choose(float(np.abs(C).max()), self._since)
        self._since = 0
        return q, new

    def _choose(self, loss: float, steps: int) -> None:
        """Choose the next time by what was lost; the losses of the first steps mislead."""
        self._period = min(_next_period(loss, steps, self.basis.dtype), self._period + 1)

    def ritz(self, count: int) -> Ritz:
        """Return the ``count`` Ritz pairs that are largest in size."""
        m = self.size
        if self.inverse.definite:
            values, S = scipy.linalg.eigh(
                self._H, subset_by_index=[m - count, m - 1], driver="evr", check_finite=False
            )
        else:
            values, S = scipy.linalg.eigh(self._H, check_finite=False)
        chosen = np.argsort(-np.abs(values), kind="stable")[:count]
        values, S = values[chosen], np.ascontiguousarray(S[:, chosen])
        width = self._coupling.shape[1]
        errors = np.linalg.norm(self._coupling @ S[m - width :], axis=0) / np.abs(values)
        return Ritz(values, S, errors)

    def vectors(self, ritz: Ritz) -> Floats:
        """Return the Ritz vectors (n, count), in float64."""
        known = np.zeros((self._known, len(ritz.values)))
        return self.basis.times(np.vstack([known, ritz.coordinates]), np.float64)

    def restart(self, ritz: Ritz) -> None:
        """Keep these Ritz vectors and the last block only."""
        width = self._coupling.shape[1]
        coupling = self._coupling @ ritz.coordinates[self.size - width :]
        self.basis.contract(scipy.linalg.block_diag(np.eye(self._known), ritz.coordinates))
        self._H = np.diag(ritz.values)
        self._last = self._orthogonal(self._last)
        self._coupling, self._arrow, self._since = coupling, True, 0
        self.basis.append(self._last)


def _next_period(loss: float, steps: int, dtype: np.dtype) -> int:
    """Return after how many steps the loss of orthogonality would reach the root of rounding."""
    rounding = float(np.finfo(dtype).eps)
    growth = max(math.log(max(loss, rounding) / rounding) / max(steps, 1), 1e-3)
    return int(np.clip(-_KEPT * math.log(rounding) / growth, 1, _LONGEST))
