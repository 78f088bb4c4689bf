"""Factor: a matrix factorised once, solved with many times."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, rectangular
from beltrami.errors import DimensionError, NonFiniteError


class Backend(Protocol):
    """What a backend gives back: the solution for an (n, c) block of right-hand sides."""

    def solve(self, b: Floats) -> Floats:
        """Return x with A x = b, of the same shape."""
        ...


@dataclass(frozen=True, eq=False, repr=False)
class Factor:
    """The factorisation of a square sparse matrix; ``factorize`` makes it.

    It belongs to its process: it is not pickled, but made anew from the matrix.

    Attributes
    ----------
    n
        Number of unknowns.
    backend
        The name of the library that factorised.
    fill
        Number of stored non-zeros of the factors.
    """

    n: int
    backend: str
    fill: int
    _solver: Backend = field(repr=False)

    def __repr__(self) -> str:
        return f"<Factor: {self.n} unknowns, {self.backend}, {self.fill} non-zeros>"

    def solve(self, b: ArrayLike) -> Floats:
        """Solve A x = b for one right-hand side (n,) or several (n, c).

        Raises
        ------
        DimensionError
            If b has not n rows, or more than two axes.
        NonFiniteError
            If b, or the solution, is not finite.
        """
        right = np.asarray(rectangular(b), dtype=np.float64)
        if right.ndim not in (1, 2) or len(right) != self.n:
            raise DimensionError(
                f"the right-hand side has the shape {right.shape} where ({self.n},) or "
                f"({self.n}, c) is needed"
            )
        solution: Any = self._solver.solve(right)
        if not np.isfinite(solution).all():
            where = "right-hand side" if not np.isfinite(right).all() else "solution"
            raise NonFiniteError(f"the {where} has values that are NaN or infinite")
        return np.asarray(solution, dtype=np.float64)
