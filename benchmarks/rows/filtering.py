"""Heat for a given time as a filter, exp(-tL) X with unit weights: direct, and by a transform."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.cases import Case
from benchmarks.claims import Contender, Goal, Row
from benchmarks.packages import package

TIME = 30.0  # with weights 1: a few edges far
ORDER = 100  # of peers that must be told: enough for 1e-8
MODES = 256


def difference(a: NDArray[Any], b: NDArray[Any]) -> float:
    """Largest distance of a coordinate, over the size of the mesh."""
    return float(abs(a - b).max() / np.ptp(a, axis=0).max())


def laplacian(case: Case) -> Any:
    bt = package("beltrami")
    return bt.laplacian(bt.Mesh(case.vertices, case.faces), "combinatorial", "unit")


def with_pygsp(case: Case) -> Contender:
    @cache
    def start() -> Any:
        pygsp = package("pygsp")
        weights = laplacian(case).weights.copy()  # it writes into what it is given
        graph = pygsp.graphs.Graph(package("scipy.sparse").csr_matrix(weights))
        graph.estimate_lmax()
        return pygsp.filters.Heat(graph, scale=TIME * graph.lmax)  # its time is t λ_max

    return Contender(
        "PyGSP, order given",
        lambda heat: heat.filter(case.vertices, method="chebyshev", order=ORDER),
        start,
        tolerance=1e-7,
    )


def with_scipy(case: Case) -> Contender:
    return Contender(
        "scipy, expm_multiply",
        lambda L: package("scipy.sparse.linalg").expm_multiply(-TIME * L, case.vertices),
        cache(lambda: laplacian(case).stiffness),
        tolerance=1e-7,
    )


def through_a_basis(case: Case, pair: Callable[[], Any]) -> Contender:
    """Transform there and back. Any columns cost the same: none are computed here."""

    @cache
    def start() -> Any:
        n = len(case.vertices)
        columns = np.random.default_rng(0).normal(size=(n, MODES)) / np.sqrt(n)
        rows = np.linspace(0, 1, MODES), columns, pair().mass, np.zeros(MODES)
        return package("beltrami").FourierBasis(*rows)

    def run(basis: Any) -> Any:
        return basis.filter(case.vertices, package("beltrami").kernels.Heat(TIME))

    name = f"{MODES} columns of a basis, given, there and back"
    return Contender(name, run, start, counts=False, tolerance=None)


def contenders(case: Case) -> Sequence[Contender]:
    pair = cache(lambda: laplacian(case))

    def ours(name: str, method: str) -> Contender:
        def run(given: Any) -> Any:
            bt = package("beltrami")
            return bt.filter(given, case.vertices, bt.kernels.Heat(TIME), method)

        return Contender(name, run, pair, ours=True, tolerance=1e-7)

    return [
        ours("beltrami", "chebyshev"),
        ours("beltrami, lanczos", "lanczos"),
        with_pygsp(case),
        with_scipy(case),
        through_a_basis(case, pair),
    ]


FILTERING = Row(
    name="filtering",
    work=f"exp(-{TIME:g} L) of the positions, the operator given",
    contenders=contenders,
    goals=(Goal(0.5),),
    difference=difference,
)
