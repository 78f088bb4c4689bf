"""Conjugate gradients on B + 100 h² L with the diagonal as preconditioner, four columns to 1e-10.

A factorisation is beside them, because it is what one would take where it fits in memory.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.linalg import LinearOperator, cg

from benchmarks.cases import Case
from benchmarks.claims import Contender, Goal, Row
from benchmarks.packages import package
from benchmarks.rows.factorizing import difference, right_hand_sides, step_of_heat

TOLERANCE = 1e-10
COLUMNS = 4
SCIPY = "scipy, column by column"


def with_scipy(A: csr_array, b: NDArray[np.float64]) -> NDArray[np.float64]:
    inverse = 1 / A.diagonal()
    M = LinearOperator(A.shape, matvec=lambda r: inverse * r, dtype=np.float64)
    columns = [cg(A, column, rtol=TOLERANCE, M=M)[0] for column in b.T]
    return np.stack(columns, axis=1)


def with_beltrami(
    A: csr_array, b: NDArray[np.float64], preconditioner: str = "jacobi"
) -> NDArray[np.float64]:
    bt = package("beltrami")
    found = bt.conjugate_gradients(A, b, preconditioner=preconditioner, tolerance=TOLERANCE)
    solution: NDArray[np.float64] = found.solution
    return solution


def contenders(case: Case) -> Sequence[Contender]:
    matrix = cache(lambda: step_of_heat(case.vertices, case.faces))
    b = right_hand_sides(len(case.vertices), COLUMNS)

    def contender(name: str, run: Callable[[Any], Any], ours: bool = True) -> Contender:
        return Contender(name, run, matrix, ours=ours, tolerance=1e-6, counts=not ours)

    return [
        contender("beltrami", lambda A: with_beltrami(A, b)),
        contender("beltrami, multigrid", lambda A: with_beltrami(A, b, "multigrid")),
        contender(
            "beltrami, factorised",
            lambda A: package("beltrami").factorize(A, case.vertices).solve(b),
        ),
        contender(SCIPY, lambda A: with_scipy(A, b), ours=False),
    ]


CONJUGATE_GRADIENTS = Row(
    name="conjugate-gradients",
    work="solve B + 100 h² L by conjugate gradients, 4 right-hand sides, residual 1e-10",
    contenders=contenders,
    goals=(Goal(0.8, against=SCIPY),),
    difference=difference,
    runs=3,
)
