"""Factorise B + tL with t = 100 h² (an implicit step of heat), and solve: 3 and 64 at once.

Meshes of four sizes, all in the large report.

Solving is compared by the time of one right-hand side: "cholespy at its best" solves for 64, as
many at a time as suit it, and its time is scaled to as many as the row has. SuperLU, which takes
minutes for a mesh of 134k vertices, plays at 35k only.

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
LARGE = 100_000  # vertices
SIZES = {"35k": 35_000, "134k": 134_000, "537k": 537_000, "2m": 2_150_000}

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


def backward_error(case: Case, x: NDArray[Any], b: NDArray[Any]) -> float:
    """Largest |Ax - b| beside |A||x| + |b|, row by row."""
    A = step_of_heat(case.vertices, case.faces)
    return float((abs(A @ x - b) / (abs(A) @ abs(x) + abs(b))).max())


def factorizing(case: Case) -> Sequence[Contender]:
    b = cache(lambda: right_hand_sides(len(case.vertices), 3))

    def contender(name: str, prepare: Callable[[], Any], run: Callable[[Any], Solve]) -> Contender:
        return Contender(
            name,
            run,
            prepare,
            lambda solve: solve(b()),
            ours=name == "beltrami",
            residual=lambda x: backward_error(case, x, b()),
        )

    return [contender(*one) for one in factorizations(case)]


def solving(count: int) -> Callable[[Case], Sequence[Contender]]:
    def contenders(case: Case) -> Sequence[Contender]:
        b = right_hand_sides(len(case.vertices), count)

        def contender(
            name: str, prepare: Callable[[], Any], run: Callable[[Any], Solve]
        ) -> Contender:
            def made() -> Solve:
                return run(prepare())

            # kept from run to run, but where several would not fit in memory
            factor = made if len(case.vertices) > 1_000_000 else cache(made)
            return Contender(
                name,
                lambda solve: solve(b),
                factor,
                ours=name == "beltrami",
                residual=lambda x: backward_error(case, x, b),
            )

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


def runs(size: int) -> int:
    return 5 if size < LARGE else 3 if size < 1_000_000 else 1


def factorize_row(name: str, limit: float) -> Row:
    size = SIZES[name]
    return Row(
        name=f"factorize-{name}",
        work="factorise B + 100 h² L, the ordering included",
        contenders=factorizing,
        goals=(Goal(limit, against=CHOLMOD),),
        difference=difference,
        size=size,
        runs=runs(size),
        large=True,
    )


def solve_row(name: str, size: int, count: int, limit: float) -> Row:
    return Row(
        name=f"solve-{count}-{name}",
        work=f"solve with the factor, {count} right-hand sides at once",
        contenders=solving(count),
        goals=(Goal(limit, against=CHOLESPY_BEST), Goal(1.0, against="cholespy")),
        difference=difference,
        size=size,
        runs=runs(size),
        memory=False,
        large=True,
    )


FACTORIZATIONS = [
    factorize_row(name, limit)
    for name, limit in (("35k", 1.0), ("134k", 0.4), ("537k", 0.5), ("2m", 0.5))
]
SOLVES = [
    solve_row(name, size, count, limit)
    for name, size in SIZES.items()
    for count, limit in ((3, 1.0), (64, 0.25))
    if count * size < 1e8  # 64 at 2.1M vertices: more memory than most machines have
]
