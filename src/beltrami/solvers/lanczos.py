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
        self._last = self._before = self._orthogonal(start)
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
            C = self.basis.transposed_times(self.pencil.weighed(q), self.basis.count)
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
        recent = q if self._arrow or j == 0 else np.hstack([self._before, q])
        C = self._project(W, recent)
        if self._arrow:
            before = self.basis.count - b
            self.basis.subtract(W, self.basis.transposed_times(self.pencil.weighed(W), before))
        C += self._project(W, recent)
        diagonal = C[-b:]
        self._H[j:, j:] = (diagonal + diagonal.T) / 2
        new, R = new_block(self.pencil, W, size, self.basis, self._random)
        self._since += 1
        if self.basis.count > b and (self._since >= self._period or self._arrow):
            q, new = self._reorthogonalize(q, new)
        self.basis.append(new)
        self._before, self._last, self._coupling, self._arrow = q, new, R, False

    def _project(self, W: Block, recent: Block) -> Floats:
        C = recent.T @ self.pencil.weighed(W)
        subtract_product(W, recent, C)
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
        if self._since == 1:  # q is
            C = self.basis.transposed_times(self.pencil.weighed(new), self.basis.count)
            self.basis.subtract(new, C)
            new = orthonormalize(self.pencil, new)
            self._choose(C)
            return q, new
        j = self.basis.count - b
        Z = np.hstack([q, new])
        C = self.basis.transposed_times(self.pencil.weighed(Z), j)
        self.basis.subtract(Z, C)
        q = orthonormalize(self.pencil, np.ascontiguousarray(Z[:, :b]))
        new = np.ascontiguousarray(Z[:, b:])
        self._project(new, q)
        new = orthonormalize(self.pencil, new)
        self.basis.put(j, q)
        self._choose(C)
        return q, new

    def _choose(self, C: Block) -> None:
        """Choose the next time by what was lost; the losses of the first steps mislead."""
        next_one = _next_period(float(np.abs(C).max()), self._since, C.dtype)
        self._period, self._since = min(next_one, self._period + (self._since > 1)), 0

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
        self._last = self._before = self._orthogonal(self._last)
        self._coupling, self._arrow, self._since = coupling, True, 0
        self.basis.append(self._last)


def _next_period(loss: float, steps: int, dtype: np.dtype) -> int:
    """Return after how many steps the loss of orthogonality would reach the root of rounding."""
    rounding = float(np.finfo(dtype).eps)
    growth = max(math.log(max(loss, rounding) / rounding) / max(steps, 1), 1e-3)
    return int(np.clip(-_KEPT * math.log(rounding) / growth, 1, _LONGEST))
