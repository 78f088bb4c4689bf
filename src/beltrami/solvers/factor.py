"""Factor: a matrix factorised once, solved with many times."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csc_array

from beltrami._arrays import Floats, as_floats
from beltrami.errors import BeltramiError, ConvergenceError, DimensionError, NonFiniteError
from beltrami.solvers.matrix import as_right_hand_side

REFINE_ABOVE = 1e-14  # backward error of a trial for which every solution is refined
_ROUNDS = 20  # of refinement, at most
_REFUSED = 1e-10  # backward error of a refined solution that is not given out

Answer = TypeVar("Answer")


class Backend(Protocol):
    """What a library gives back; None where it does not tell."""

    @property
    def fill(self) -> int | None:
        """Number of stored entries of the factors."""
        ...

    @property
    def memory(self) -> int | None:
        """Bytes that the factors take."""
        ...

    def solve(self, b: Floats) -> Floats:
        """Return x with A x = b, of the same shape: (n,) or (n, c)."""
        ...

    def logdet(self) -> float | None:
        """Return log abs det A."""
        ...

    @property
    def inertia(self) -> tuple[int, int] | None:
        """Numbers of positive and negative eigenvalues."""
        ...


@dataclass(frozen=True, eq=False, repr=False)
class Factor:
    """The factorisation of a square sparse matrix; ``factorize`` makes it.

    It belongs to its process: it is not pickled, but made anew from the matrix. What the library
    does not tell (``fill``, ``memory``, ``logdet`` or ``inertia``) raises BeltramiError.

    Attributes
    ----------
    matrix
        (n, n) csc_array A, as it was factorised.
    backend
        The name of the library that factorised.
    refined
        Whether solutions are corrected by their residuals until those are at rounding level: so
        if a trial solution was not there by itself, as with factors in float32.
    """

    matrix: csc_array
    backend: str
    refined: bool
    _solver: Backend = field(repr=False)

    def __repr__(self) -> str:
        fill = "" if self._solver.fill is None else f", {self._solver.fill} non-zeros"
        return f"<Factor: {self.n} unknowns, {self.backend}{fill}>"

    @property
    def n(self) -> int:
        """Number of unknowns."""
        return int(self.matrix.shape[0])

    @property
    def fill(self) -> int:
        """Number of stored entries of the factors."""
        return self._told(self._solver.fill, "fill", "cholesky")

    @property
    def memory(self) -> int:
        """Bytes that the factors take."""
        return self._told(self._solver.memory, "memory", "cholesky")

    @property
    def logdet(self) -> float:
        """Return log abs det A, the sum of the logarithms of the pivots."""
        return self._told(self._solver.logdet(), "determinant", "superlu")

    @property
    def inertia(self) -> tuple[int, int]:
        """Numbers of positive and of negative eigenvalues of A, by Sylvester's law.

        With A = L - σB the second is the number of eigenvalues of (L, B) below σ.

        Raises
        ------
        BeltramiError
            If the factors do not tell: those of SuperLU, which exchanges rows.

        Examples
        --------
        >>> import scipy.sparse
        >>> from beltrami.solvers.factorize import factorize
        >>> factorize(scipy.sparse.diags_array([2.0, -1.0, 3.0]), backend="ldl").inertia
        (2, 1)
        """
        return self._told(self._solver.inertia, "inertia", "ldl")

    def _told(self, found: Answer | None, what: str, other: str) -> Answer:
        """Return what the library told, or raise an error that names one that tells."""
        if found is None:
            raise BeltramiError(
                f'the factors of {self.backend} do not tell the {what}: use backend="{other}"'
            )
        return found

    def solve(self, b: ArrayLike) -> Floats:
        """Solve A x = b for one right-hand side (n,) or several (n, c); several at once are faster.

        Raises
        ------
        DimensionError
            If b has not n rows, or more than two axes.
        NonFiniteError
            If b, or the solution, is not finite.
        ConvergenceError
            If refinement was needed, and did not help.
        """
        right = as_right_hand_side(b, self.n)
        solution: Any = self._solver.solve(right)
        if not np.isfinite(solution).all():
            where = "right-hand side" if not np.isfinite(right).all() else "solution"
            raise NonFiniteError(f"the {where} has values that are NaN or infinite")
        if self.refined and right.size:
            solution = self._refine(right, solution)
        return np.asarray(solution, dtype=np.float64)

    def backward_error(self, x: ArrayLike, b: ArrayLike) -> Floats:
        r"""Return how good a solution is: :math:`\max_i |b - Ax|_i / (|A| |x| + |b|)_i`.

        It is the smallest relative change of the entries of A and b that makes x exact (Oettli and
        Prager 1964): about 1e-16 is the best that there is, whatever the condition of A or the
        units of its rows. One number, or one for each column.

        Examples
        --------
        >>> import scipy.sparse
        >>> from beltrami.solvers.factorize import factorize
        >>> factor = factorize(scipy.sparse.csr_array([[4.0, 1.0], [1.0, 3.0]]))
        >>> bool(factor.backward_error(factor.solve([1.0, 2.0]), [1.0, 2.0]) < 1e-15)
        True
        """
        solution, right = as_floats(x), as_floats(b)
        if solution.shape != right.shape or solution.shape[:1] != self.matrix.shape[:1]:
            raise DimensionError(
                f"a solution of the shape {solution.shape} and a right side of {right.shape} "
                f"where {self.matrix.shape[0]} rows are needed"
            )
        scale = abs(self.matrix) @ np.abs(solution) + np.abs(right)
        residual = np.abs(right - self.matrix @ solution)
        ratio = np.divide(residual, scale, out=np.zeros_like(scale), where=scale > 0)
        return np.asarray(ratio.max(axis=0, initial=0.0))

    def _refine(self, b: Floats, x: Floats) -> Floats:
        """Correct x by the solution for its residual, while that makes the residual smaller."""
        best, error = x, float(self._normwise_error(x, b))
        for _ in range(_ROUNDS):
            if error <= REFINE_ABOVE / 10:
                break
            better = best + self._solver.solve(b - self.matrix @ best)
            smaller = float(self._normwise_error(better, b))
            if not smaller < error:
                break
            best, error = better, smaller
        if not error <= _REFUSED:
            raise ConvergenceError(
                f"a solution could not be refined beyond a relative residual of {error:.1e}. "
                "Factorise in float64, or scale the rows of the matrix"
            )
        return best

    def _normwise_error(self, x: Floats, b: Floats) -> float:
        """Largest over the columns of the residual beside norm(A) norm(x) + norm(b)."""
        residual = np.abs(b - self.matrix @ x).max(axis=0)
        norm = float(abs(self.matrix).sum(axis=1).max())
        scale = norm * np.abs(x).max(axis=0) + np.abs(b).max(axis=0)
        return float((residual / np.where(scale > 0, scale, 1)).max())
