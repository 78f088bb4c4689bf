"""The smallest eigenpairs of the cotangent pair: 50, 200 and 500 of them, at a residual of 1e-6.

Each gets the pair ready-made, in its own format. scipy's eigsh, at tol=1e-7 (it reaches 1e-11 at
no more cost than at 1e-6), runs with SuperLU inside, as users call it, and with cholespy's Cholesky
factor. LaPy is eigsh with SuperLU, or with CHOLMOD where scikit-sparse is there.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import LinearOperator, eigsh

from benchmarks.cases import Case
from benchmarks.claims import Contender, Goal, Row
from benchmarks.packages import package
from benchmarks.rows.factorizing import with_cholespy

SHIFT = -0.01  # times the eigenvalue that Weyl's law expects last
TOLERANCE = 1e-7
SUPERLU = "eigsh with SuperLU"
CHOLESPY = "eigsh with cholespy"

Values = NDArray[np.float64]


def pair(case: Case) -> Any:
    bt = package("beltrami")
    return bt.laplacian(bt.Mesh(case.vertices, case.faces))


def matrices(case: Case, k: int) -> tuple[csc_matrix, csc_matrix, float]:
    """L, B, and a shift below zero."""
    made = pair(case)
    L, B = csc_matrix(made.stiffness), csc_matrix(made.mass)
    return L, B, SHIFT * 4 * np.pi * k / B.sum()


def with_superlu(given: tuple[csc_matrix, csc_matrix, float], k: int) -> Values:
    L, B, shift = given
    return eigsh(L, k, B, sigma=shift, tol=TOLERANCE)[0]


def eigsh_with_cholespy(given: tuple[csc_matrix, csc_matrix, float], k: int) -> Values:
    L, B, shift = given
    solve = with_cholespy((L - shift * B).tocoo())
    inverse = LinearOperator(L.shape, matvec=lambda b: solve(np.array(b)), dtype=np.float64)
    return eigsh(L, k, B, sigma=shift, OPinv=inverse, tol=TOLERANCE)[0]


def with_lapy(case: Case) -> Any:
    lapy = package("lapy")
    cholmod = importlib.util.find_spec("sksparse") is not None
    return lapy.Solver(lapy.TriaMesh(case.vertices, case.faces), lump=True, use_cholmod=cholmod)


def difference(a: Values, b: Values) -> float:
    """Largest relative difference; the first eigenvalue is zero."""
    return float(np.abs(b[1:] / a[1:] - 1).max())


def searching(k: int, best_only: bool = False) -> Callable[[Case], Sequence[Contender]]:
    def contenders(case: Case) -> Sequence[Contender]:
        found = [
            Contender(
                "beltrami",
                lambda given: package("beltrami").fourier_basis(given, k).eigenvalues,
                lambda: pair(case),
                ours=True,
            ),
            Contender(
                CHOLESPY, lambda given: eigsh_with_cholespy(given, k), lambda: matrices(case, k)
            ),
        ]
        if best_only:
            return found
        return [
            *found,
            Contender(SUPERLU, lambda given: with_superlu(given, k), lambda: matrices(case, k)),
            # its masses are those of a third of the faces, not of Voronoi cells
            Contender(
                "LaPy", lambda solver: solver.eigs(k)[0], lambda: with_lapy(case), tolerance=None
            ),
        ]

    return contenders


def row(name: str, k: int, goals: Sequence[Goal], **more: Any) -> Row:
    best_only = bool(more.pop("best_only", False))
    return Row(
        name=name,
        work=f"the {k} smallest eigenpairs of the cotangent pair",
        contenders=searching(k, best_only),
        goals=goals,
        difference=difference,
        **more,
    )


EIGEN_50 = row("eigen-50", 50, (Goal(0.3), Goal(0.15, against=SUPERLU)), runs=3)
EIGEN_200 = row("eigen-200", 200, (Goal(0.15),), runs=1)
EIGEN_500 = row("eigen-500", 500, (Goal(0.1),), runs=1, best_only=True, on_demand=True)
EIGEN_LARGE = row(
    "eigen-50-large", 50, (Goal(0.35),), runs=1, size=537_000, best_only=True, on_demand=True
)
