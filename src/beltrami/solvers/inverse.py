"""(L - σB)⁻¹ for blocks in the order of elimination: what an eigensolver applies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from beltrami._jit import kernel
from beltrami.errors import NotPositiveDefiniteError, SingularMatrixError
from beltrami.solvers.cholesky import Cholesky, factorize_cholesky
from beltrami.solvers.ldl import factorize_ldl
from beltrami.solvers.many import lines_for
from beltrami.solvers.pencil import Block, Pencil

_SEED = 577_215_664
_TRIES = 6
_HIT = 1e7  # growth of a vector, times the step: the shift is an eigenvalue
_FAINT = 50.0  # units of rounding of the diagonal: a smaller shift drowns in them


@dataclass(frozen=True, eq=False)
class Inverse:
    """The factor of L - σB; called with a block (n, c), it returns the solutions, in its precision.

    Attributes
    ----------
    shift
        σ, in the unit of the pencil.
    factor
        In float32 or float64.
    scale
        (n,) of the factor, in the order of elimination and its precision.
    """

    shift: float
    factor: Cholesky
    scale: NDArray[Any]

    @property
    def dtype(self) -> np.dtype[Any]:
        """float32 or float64."""
        return self.factor.values.dtype

    @property
    def definite(self) -> bool:
        """Whether no eigenvalue is below the shift."""
        return self.factor.inertia[1] == 0

    def __call__(self, b: Block) -> Block:
        """Return x with (L - σB) x = b."""
        x = lines_for(len(b), b.shape[1], self.dtype)
        _scale(b, self.scale, x)
        self.factor.substitute(x)
        result = np.empty(b.shape, self.dtype)
        _scale(x, self.scale, result)
        return result


def definite_inverse(pencil: Pencil, shift: float, dtype: DTypeLike) -> Inverse | None:
    """Factorise with Cholesky; in float64 where float32 does not do, None if not definite."""
    diagonal = pencil.stiffness.diagonal()
    if not (diagonal > shift).all():
        return None
    size = abs(shift) / max(float(np.median(diagonal)), -shift)
    for kind in (np.dtype(dtype), np.dtype(np.float64)):
        if size < _FAINT * float(np.finfo(kind).eps):
            continue
        try:
            factor = factorize_cholesky(pencil.shifted(shift), pencil.elimination, kind)
        except (NotPositiveDefiniteError, SingularMatrixError):
            continue
        if np.isfinite(factor.values).all():
            return _inverse(pencil, shift, factor)
    return None


def signed_inverse(pencil: Pencil, shift: float, step: float) -> Inverse:
    """Factorise with signs, in float64; if that meets an eigenvalue, ``step`` aside of it.

    Raises
    ------
    SingularMatrixError
        If no shift nearby can be factorised.
    """
    trial = np.random.default_rng(_SEED).standard_normal((pencil.n, 8))
    failure = SingularMatrixError("every shift nearby is an eigenvalue, to working precision")
    for i in range(_TRIES):
        moved = shift + step * i * (-1) ** i
        try:
            factor = factorize_ldl(pencil.shifted(moved), pencil.elimination)
        except SingularMatrixError as error:
            failure = error
            continue
        inverse = _inverse(pencil, moved, factor)
        growth = float(np.abs(inverse(trial)).max())
        if growth * step < _HIT:
            return inverse
    raise failure


def better_inverse(pencil: Pencil, inverse: Inverse) -> Inverse:
    """Return the same inverse in float64."""
    if inverse.dtype == np.float64:
        return inverse
    return definite_inverse(pencil, inverse.shift, np.float64) or inverse


def _inverse(pencil: Pencil, shift: float, factor: Cholesky) -> Inverse:
    scale = factor.scale[pencil.elimination.order].astype(factor.values.dtype)
    return Inverse(shift, factor, scale)


@kernel
def _scale(b: Any, scale: Any, x: Any) -> None:
    """Multiply row i of b by ``scale[i]``, into x; what x has more columns becomes zero."""
    columns = min(b.shape[1], x.shape[1])
    for i in range(b.shape[0]):
        source, to, s = b[i], x[i], scale[i]
        for j in range(columns):
            to[j] = source[j] * s
        for j in range(columns, to.size):
            to[j] = 0
