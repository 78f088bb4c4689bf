"""Factorise B + tL with t = 100 h² (an implicit step of heat), and solve: 3 and 64 at once.

Solving is compared by the time of one right-hand side: "cholespy at its best" solves for 64, as
many at a time as suit it, and its time is scaled to as many as the row has. SuperLU, which takes
minutes for a large mesh, is left out there.

Each peer gets the matrix in its own format before the time starts; beltrami gets the csr_array of
its pair, and the positions. CHOLMOD's wrapper is compiled against the SuiteSparse of the system
(Debian: ``libsuitesparse-dev`` and a fast BLAS, ``libopenblas0-pthread``).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix, csr_array
from scipy.sparse.linalg import splu

from benchmarks.cases import Case
from benchmarks.claims import Contender, Goal, Row
from benchmarks.packages import package

SEED = 161_803_398
CHOLMOD = "CHOLMOD, minimum degree"
CHOLESPY_BEST = "cholespy at its best, scaled"
BATCHES = (3, 8, 16, 64)
LARGE = 200_000  # vertices

Solve = Callable[[NDArray[np.float64]], NDArray[np.float64]]


def step_of_heat(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> csr_array:
    """B + 100 h² L, where h is the mean length of the edges."""
    bt = package("beltrami")
    mesh = bt.Mesh(vertices, faces)
    pair = bt.laplacian(mesh)
    h = float(np.mean(mesh.edge_lengths))
    return csr_array(pair.mass + 100 * h**2 * pair.stiffness)


def with_beltrami(matrix: csr_array, vertices: NDArray[np.float64]) -> Solve:
    return package("beltrami").factorize(matrix, vertices).solve


def with_superlu(matrix: csc_matrix) -> Solve:
    return splu(
        matrix,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    ).solve


def with_cholespy(entries: Any) -> Solve:
    cholespy = package("cholespy")
    solver = cholespy.CholeskySolverD(
        entries.shape[0], entries.row, entries.col, entries.data, cholespy.MatrixType.COO
    )

    def solve(b: NDArray[np.float64]) -> NDArray[np.float64]:
        x = np.empty_like(b)
        solver.solve(b, x)
        return x

    return solve


def with_cholmod(matrix: csc_matrix) -> Solve:
    return package("sksparse.cholmod").cholesky(matrix, ordering_method="amd")


def factorizations(case: Case) -> list[tuple[str, Callable[[], Any], Callable[[Any], Solve]]]:
    """List the names, what each one's matrix is, and how it factorises."""
    matrix = cache(lambda: step_of_heat(case.vertices, case.faces))
    columns = cache(lambda: csc_matrix(matrix()))
    entries = cache(lambda: columns().tocoo())
    found: list[tuple[str, Callable[[], Any], Callable[[Any], Solve]]] = [
        ("beltrami", matrix, lambda A: with_beltrami(A, case.vertices)),
        ("cholespy", entries, with_cholespy),
        (CHOLMOD, columns, with_cholmod),
    ]
    if len(case.vertices) < LARGE:
        found.insert(1, ("SuperLU, as we call it", columns, with_superlu))
    return found


def right_hand_sides(n: int, count: int) -> NDArray[np.float64]:
    return np.random.default_rng(SEED).normal(size=(n, count))


def difference(a: NDArray[Any], b: NDArray[Any]) -> float:
    return float(abs(a - b).max() / abs(a).max())


def factorizing(case: Case) -> Sequence[Contender]:
    def contender(name: str, prepare: Callable[[], Any], run: Callable[[Any], Solve]) -> Contender:
        return Contender(
            name,
            run,
            prepare,
            lambda solve: solve(right_hand_sides(len(case.vertices), 3)),
            ours=name == "beltrami",
        )

    return [contender(*one) for one in factorizations(case)]


def solving(count: int) -> Callable[[Case], Sequence[Contender]]:
    def contenders(case: Case) -> Sequence[Contender]:
        b = right_hand_sides(len(case.vertices), count)

        def contender(
            name: str, prepare: Callable[[], Any], run: Callable[[Any], Solve]
        ) -> Contender:
            factor = cache(lambda: run(prepare()))
            return Contender(name, lambda solve: solve(b), factor, ours=name == "beltrami")

        found = [contender(*one) for one in factorizations(case)]
        prepare = next(one.prepare for one in found if one.name == "cholespy")
        best = Contender(
            CHOLESPY_BEST, lambda solve: count * seconds_each(solve, case), prepare,
            times_itself=True,
        )  # fmt: skip
        return [*found, best]

    return contenders


def seconds_each(solve: Solve, case: Case) -> float:
    """CPU seconds for one right-hand side, with as many at a time as is fastest."""
    b = right_hand_sides(len(case.vertices), max(BATCHES))
    found = []
    for batch in BATCHES:
        parts = [np.ascontiguousarray(b[:, j : j + batch]) for j in range(0, b.shape[1], batch)]
        start = time.process_time()
        for part in parts:
            solve(part)
        found.append((time.process_time() - start) / b.shape[1])
    return min(found)


FACTORIZE = Row(
    name="factorize",
    work="factorise B + 100 h² L, the ordering included",
    contenders=factorizing,
    goals=(Goal(0.4, against=CHOLMOD),),
    difference=difference,
    runs=3,
)

FACTORIZE_LARGE = Row(
    name="factorize-large",
    work="factorise B + 100 h² L, the ordering included",
    contenders=factorizing,
    goals=(Goal(0.5, against=CHOLMOD),),
    difference=difference,
    size=537_000,
    runs=3,
)

SOLVE_3 = Row(
    name="solve-3",
    work="solve with the factor, 3 right-hand sides at once",
    contenders=solving(3),
    goals=(Goal(1.0, against=CHOLESPY_BEST),),
    difference=difference,
    memory=False,
)

SOLVE_64 = Row(
    name="solve-64",
    work="solve with the factor, 64 right-hand sides at once",
    contenders=solving(64),
    goals=(Goal(0.25, against=CHOLESPY_BEST),),
    difference=difference,
    memory=False,
)
