"""Solve with a shifted matrix L - σB, which is indefinite for a shift inside the spectrum."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Floats
from beltrami.errors import ConvergenceError, SingularMatrixError, check_name
from beltrami.solvers.factor import Factor
from beltrami.solvers.factorize import factorize
from beltrami.solvers.minres import minres

SHIFTED_SOLVERS = ("auto", "lu", "ldl", "minres")
_BACKENDS = {"auto": "auto", "lu": "superlu", "ldl": "ldl"}
_NAMES = {"superlu": "lu"}  # of backends, where the chapter says otherwise
_ROUNDING = 3e-14  # a residual beside |A||x| that no solver makes much smaller
_SOMETHING = 0.5  # of the right-hand side must be solved in any case


class ShiftedSolver(Protocol):
    """What solves with L - σB."""

    @property
    def name(self) -> str:
        """The method."""
        ...

    def solve(self, b: Floats, tolerance: float, guess: Floats | None) -> tuple[Floats, int]:
        """Return x with ``|b - Ax| <= tolerance |b|``, and the inner iterations it took."""
        ...


@dataclass(frozen=True, eq=False)
class Direct:
    """A factorisation: exact to rounding, whatever the tolerance and the guess."""

    factor: Factor

    @property
    def name(self) -> str:
        """The factorisation."""
        return _NAMES.get(self.factor.backend, self.factor.backend)

    def solve(
        self,
        b: Floats,
        tolerance: float,  # noqa: ARG002
        guess: Floats | None,  # noqa: ARG002
    ) -> tuple[Floats, int]:
        """Return the solution, and 0."""
        return self.factor.solve(b), 0


@dataclass(frozen=True, eq=False)
class Minres:
    r"""MINRES for :math:`B^{-1/2} A B^{-1/2}`, with the row sums of B where it is not diagonal.

    There the length of a residual is the :math:`\sqrt{\sum_i r_i^2 / b_i}` that bounds errors of
    eigenvalues.
    """

    A: csr_array
    root: Floats
    most_iterations: int

    @property
    def name(self) -> str:
        """The method."""
        return "minres"

    @cached_property
    def absolute(self) -> csr_array:
        """|A|, for the rounding that a residual cannot avoid."""
        return csr_array(abs(self.A))

    @cached_property
    def largest(self) -> Floats:
        """(n,) largest entries of the rows; the diagonal may be zero by chance."""
        largest = abs(self.A).max(axis=1).toarray().ravel()
        return np.where(largest > 0, largest, 1.0)

    def precondition(self, r: Floats) -> Floats:
        """Divide by the largest entries of the rows."""
        return r / self.largest

    def solve(self, b: Floats, tolerance: float, guess: Floats | None) -> tuple[Floats, int]:
        """Iterate until the residual is small, or as small as rounding lets it be.

        The guess tells how large x is. To start from it would be no help: it is along b.
        """
        right = b / self.root
        if guess is not None:
            rounding = _ROUNDING * np.linalg.norm(self.absolute @ np.abs(guess * self.root))
            tolerance = max(tolerance, float(rounding / np.linalg.norm(right)))
        try:
            found = minres(
                self.A,
                right,
                preconditioner=self.precondition,
                tolerance=min(tolerance, _SOMETHING),
                most_iterations=self.most_iterations,
                kernel=None,
            )
        except ConvergenceError as cause:
            raise ConvergenceError(
                f"MINRES does not solve with L - σB well enough: {cause}. The nearer the shift to "
                "an eigenvalue, the more it takes",
                residuals=cause.residuals,
            ) from cause
        return found.solution / self.root, found.iterations


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
        root = np.sqrt(np.asarray(B.sum(axis=1)))
        scaled = csr_array((A / root[:, None]) / root[None, :])
        return Minres(csr_array((scaled + scaled.T) / 2), root, max_inner_iterations)
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
