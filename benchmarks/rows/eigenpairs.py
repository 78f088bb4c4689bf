"""The smallest eigenpairs of the cotangent pair: 50, 200 and 500 of them, at a residual of 1e-6.

Meshes of four sizes, all in the large report.

Each gets the pair ready-made, in its own format. scipy's eigsh, at tol=1e-7 (it reaches 1e-11 at
no more cost than at 1e-6), runs with SuperLU inside, as users call it, and with cholespy's Cholesky
factor. LaPy is eigsh with SuperLU, or with CHOLMOD where scikit-sparse is there.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import LinearOperator, eigsh

from benchmarks.cases import Case
from benchmarks.claims import Contender, Goal, Row
from benchmarks.packages import package
from benchmarks.rows.factorizing import SIZES, with_cholespy

SHIFT = -0.01  # times the eigenvalue that Weyl's law expects last
TOLERANCE = 1e-7
SUPERLU = "eigsh with SuperLU"
CHOLESPY = "eigsh with cholespy"

Pairs = tuple[NDArray[np.float64], NDArray[np.float64]]


def pair(case: Case) -> Any:
    bt = package("beltrami")
    return bt.laplacian(bt.Mesh(case.vertices, case.faces))


def matrices(case: Case, k: int) -> tuple[csc_matrix, csc_matrix, float]:
    """L, B, and a shift below zero."""
    made = pair(case)
    L, B = csc_matrix(made.stiffness), csc_matrix(made.mass)
    return L, B, SHIFT * 4 * np.pi * k / B.sum()


def with_superlu(given: tuple[csc_matrix, csc_matrix, float], k: int) -> Pairs:
    L, B, shift = given
    return eigsh(L, k, B, sigma=shift, tol=TOLERANCE)


def eigsh_with_cholespy(given: tuple[csc_matrix, csc_matrix, float], k: int) -> Pairs:
    L, B, shift = given
    solve = with_cholespy((L - shift * B).tocoo())
    inverse = LinearOperator(L.shape, matvec=lambda b: solve(np.array(b)), dtype=np.float64)
    return eigsh(L, k, B, sigma=shift, OPinv=inverse, tol=TOLERANCE)


def with_beltrami(given: Any, k: int) -> Pairs:
    basis = package("beltrami").fourier_basis(given, k)
    return basis.eigenvalues, basis.eigenvectors


def with_lapy(case: Case) -> Any:
    lapy = package("lapy")
    cholmod = importlib.util.find_spec("sksparse") is not None
    return lapy.Solver(lapy.TriaMesh(case.vertices, case.faces), lump=True, use_cholmod=cholmod)


def lapys_own(case: Case) -> tuple[Any, Any]:
    """Return the pair of matrices that LaPy decomposes."""
    solver = with_lapy(case)
    return solver.stiffness, solver.mass


def difference(a: Pairs, b: Pairs) -> float:
    """Largest relative difference of eigenvalues; the first one is zero."""
    return float(np.abs(b[0][1:] / a[0][1:] - 1).max())


def residual(L: Any, B: Any, found: Pairs) -> float:
    """Largest norm of Lx - λBx beside λBx; the first eigenvalue is zero."""
    values, vectors = found[0][1:], found[1][:, 1:]
    worst = 0.0
    for value, x in zip(values, vectors.T, strict=True):
        force = value * (B @ x)
        worst = max(worst, float(np.linalg.norm(L @ x - force) / np.linalg.norm(force)))
    return worst


def searching(k: int, best_only: bool = False) -> Callable[[Case], Sequence[Contender]]:
    def contenders(case: Case) -> Sequence[Contender]:
        ours = cache(lambda: pair(case))

        def of_ours(found: Pairs) -> float:
            return residual(ours().stiffness, ours().mass, found)

        found = [
            Contender(
                "beltrami",
                lambda given: with_beltrami(given, k),
                lambda: pair(case),
                ours=True,
                residual=of_ours,
            ),
            Contender(
                CHOLESPY,
                lambda given: eigsh_with_cholespy(given, k),
                lambda: matrices(case, k),
                residual=of_ours,
            ),
        ]
        if best_only:
            return found
        return [
            *found,
            Contender(
                SUPERLU,
                lambda given: with_superlu(given, k),
                lambda: matrices(case, k),
                residual=of_ours,
            ),
            # its masses are those of a third of the faces, not of Voronoi cells
            Contender(
                "LaPy",
                lambda solver: solver.eigs(k),
                lambda: with_lapy(case),
                tolerance=None,
                residual=lambda found: residual(*lapys_own(case), found),
            ),
        ]

    return contenders


def row(k: int, name: str, goals: Sequence[Goal], runs: int = 1, best_only: bool = False) -> Row:
    return Row(
        name=f"eigen-{k}-{name}",
        work=f"the {k} smallest eigenpairs of the cotangent pair",
        contenders=searching(k, best_only),
        goals=goals,
        difference=difference,
        size=SIZES[name],
        runs=runs,
        large=True,
    )


WHAT_USERS_RUN = Goal(0.15, against=SUPERLU)
EIGENPAIRS = [
    row(50, "35k", (Goal(0.3), WHAT_USERS_RUN), runs=3),
    row(200, "35k", (Goal(0.2),)),
    row(50, "134k", (Goal(0.3), WHAT_USERS_RUN), runs=3),
    row(200, "134k", (Goal(0.15),)),
    row(500, "134k", (Goal(0.1),), best_only=True),
    row(50, "537k", (Goal(0.35),), best_only=True),
    row(50, "2m", (Goal(0.35),), best_only=True),
]
