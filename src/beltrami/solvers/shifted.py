"""Solve with a shifted matrix L - σB, which is indefinite for a shift inside the spectrum."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array
from scipy.sparse.linalg import minres

from beltrami._arrays import Floats
from beltrami.errors import ConvergenceError, SingularMatrixError, check_name
from beltrami.solvers.factor import Factor
from beltrami.solvers.factorize import factorize

SHIFTED_SOLVERS = ("auto", "lu", "ldl", "minres")
_BACKENDS = {"auto": "auto", "lu": "superlu", "ldl": "ldl"}
_NAMES = {"superlu": "lu"}  # of backends, where the chapter says otherwise
_LOOK = 10  # steps of MINRES between looks at the true residual
_ROUNDING = 1e-14  # a residual beside |A||x| + |b| that no solver makes much smaller


class ShiftedSolver(Protocol):
    """What solves with L - σB."""

    @property
    def name(self) -> str:
        """The method."""
        ...

    def solve(self, b: Floats, tolerance: float) -> tuple[Floats, int]:
        """Return x with ``|b - Ax| <= tolerance |b|``, and the inner iterations it took."""
        ...


@dataclass(frozen=True, eq=False)
class Direct:
    """A factorisation: exact to rounding, whatever the tolerance."""

    factor: Factor

    @property
    def name(self) -> str:
        """The factorisation."""
        return _NAMES.get(self.factor.backend, self.factor.backend)

    def solve(self, b: Floats, tolerance: float) -> tuple[Floats, int]:  # noqa: ARG002
        """Return the solution, and 0."""
        return self.factor.solve(b), 0


@dataclass(frozen=True, eq=False)
class Minres:
    r"""MINRES (Paige and Saunders 1975), for symmetric matrices of any signs.

    Rows and columns are scaled to a largest entry of about 1. Residuals count in the norm
    :math:`\sqrt{\sum_i r_i^2 / b_i}` of the masses, in which they bound errors of eigenvalues.
    """

    A: csr_array
    masses: Floats
    max_iterations: int

    @property
    def name(self) -> str:
        """The method."""
        return "minres"

    @cached_property
    def scale(self) -> Floats:
        """(n,) factors of rows and columns, which take the units away."""
        return np.asarray(1 / np.sqrt(abs(self.A).max(axis=1).toarray().ravel()))

    @cached_property
    def scaled(self) -> csr_array:
        """The matrix of the scaled system."""
        return csr_array((self.A * self.scale[:, None]) * self.scale[None, :])

    @cached_property
    def absolute(self) -> csr_array:
        """|A|, for the rounding that a residual cannot avoid."""
        return csr_array(abs(self.A))

    def solve(self, b: Floats, tolerance: float) -> tuple[Floats, int]:
        """Iterate until the true residual is small enough, which is looked at now and then.

        scipy measures residuals beside ``|A||x|``, which near an eigenvalue is far too weak, and
        ends where rounding has spoiled its own residual: then it is started again with the true
        one, as long as that helps.
        """
        x, count, size = np.zeros_like(b), 0, self._norm(b)
        enough, before = tolerance * size, np.inf
        while size < before / 2 and count < self.max_iterations:
            y, steps = self._once(x, b, enough, self.max_iterations - count)
            count, before, smaller = count + steps, size, self._norm(b - self.A @ y)
            if smaller < size:
                x, size = y, smaller
            if self._is_solution(x, b, enough):
                break
        else:
            raise ConvergenceError(
                f"MINRES stopped after {count} iterations with a relative residual of "
                f"{size / self._norm(b):.1e} where {tolerance:.1e} is needed. The nearer the shift "
                "to an eigenvalue, the more it takes: factorise, or allow more iterations"
            )
        return x, count

    def _once(self, x: Floats, b: Floats, enough: float, most: int) -> tuple[Floats, int]:
        """Run MINRES for the residual of x; return the better x, and the number of steps."""
        count, reached = 0, x
        right = self.scale * (b - self.A @ x)
        size = np.linalg.norm(right)  # scipy has thresholds without a unit

        def look(y: Floats) -> None:
            nonlocal count, reached
            count += 1
            if count % _LOOK == 0:
                reached = x + size * self.scale * y
                if self._is_solution(reached, b, enough):
                    raise _ReachedError

        try:
            y, _ = minres(self.scaled, right / size, rtol=0, maxiter=most, callback=look)
        except _ReachedError:
            return reached, count
        return x + size * self.scale * y, count

    def _norm(self, r: Floats) -> float:
        return float(np.linalg.norm(r / np.sqrt(self.masses)))

    def _is_solution(self, x: Floats, b: Floats, enough: float) -> bool:
        residual = self._norm(b - self.A @ x)
        if residual <= enough:
            return True
        return residual <= _ROUNDING * self._norm(self.absolute @ np.abs(x) + np.abs(b))


class _ReachedError(Exception):
    """MINRES may stop."""


def shifted_solver(
    L: csr_array,
    B: csr_array,
    shift: float,
    solver: str = "auto",
    *,
    coordinates: ArrayLike | None = None,
    max_inner_iterations: int = 10_000,
) -> ShiftedSolver:
    """Prepare to solve with L - σB: one factorisation, or none for ``"minres"``.

    Raises
    ------
    UnknownNameError
        If there is no such solver. There is no ``"cg"``: it is for definite matrices (E68).
    SingularMatrixError
        If the shift is an eigenvalue to working precision, or LDL needs exchanges of rows.

    Examples
    --------
    >>> from scipy.sparse import csr_array, eye_array
    >>> L = csr_array([[1.0, -1.0], [-1.0, 1.0]])
    >>> shifted_solver(L, csr_array(eye_array(2)), 0.5).name
    'lu'
    """
    check_name("solver", solver, SHIFTED_SOLVERS)
    A = csr_array(L - shift * B)
    if solver == "minres":
        return Minres(A, np.asarray(B.sum(axis=1)), max_inner_iterations)
    try:
        return Direct(factorize(A, coordinates, _BACKENDS[solver]))
    except SingularMatrixError as cause:
        exchanges = (
            ", or the matrix needs exchanges of rows, which LDL does not do. Move the shift a "
            'little, or use solver="lu"'
            if solver == "ldl"
            else ". Move the shift a little"
        )
        raise SingularMatrixError(
            f"L - {shift:.17g} B has no inverse: the shift is an eigenvalue to working precision"
            + exchanges,
            cause.rows,
        ) from cause
