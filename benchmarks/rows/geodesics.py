"""The heat method for distances: what is prepared once, and what each source costs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.cases import Case
from benchmarks.claims import Contender, Goal, Row
from benchmarks.packages import package

INTRINSIC = "beltrami, intrinsic"


def difference(a: NDArray[Any], b: NDArray[Any]) -> float:
    """Largest difference of a distance, over the largest one."""
    return float(abs(a - b).max() / abs(a).max())


def methods(case: Case) -> dict[str, tuple[Callable[[], Any], Callable[[Any], Any]]]:
    """Return for each name how to prepare, and the distances from vertex 0."""
    V, F = case.vertices, case.faces

    def ours(intrinsic: bool) -> Any:
        bt = package("beltrami")
        return bt.HeatMethod(bt.Mesh(V, F), intrinsic=intrinsic)

    def potpourri3d(robust: bool) -> Any:
        return package("potpourri3d").MeshHeatMethodDistanceSolver(V, F, use_robust=robust)

    def igl() -> Any:
        igl = package("igl")
        data = igl.HeatGeodesicsData()
        igl.heat_geodesics_precompute(V, F, data)
        return data

    def igl_distance(data: Any) -> Any:
        return package("igl").heat_geodesics_solve(data, np.zeros(1, np.int64))

    return {
        "beltrami": (lambda: ours(False), lambda method: method.distance(0)),
        INTRINSIC: (lambda: ours(True), lambda method: method.distance(0)),
        "potpourri3d": (lambda: potpourri3d(False), lambda solver: solver.compute_distance(0)),
        "potpourri3d, intrinsic": (
            lambda: potpourri3d(True),
            lambda solver: solver.compute_distance(0),
        ),
        "libigl": (igl, igl_distance),
    }


def preparing(case: Case) -> Sequence[Contender]:
    def contender(name: str, make: Callable[[], Any], solve: Callable[[Any], Any]) -> Contender:
        return Contender(
            name,
            lambda _: make(),
            canonical=solve,
            ours=name.startswith("beltrami"),
            tolerance=None,
        )

    return [contender(name, *pair) for name, pair in methods(case).items()]


def solving(case: Case) -> Sequence[Contender]:
    return [
        Contender(name, solve, cache(make), ours=name.startswith("beltrami"), tolerance=None)
        for name, (make, solve) in methods(case).items()
    ]


GEODESICS = Row(
    name="geodesics",
    work="distances from one vertex by the heat method, all prepared",
    contenders=solving,
    goals=(Goal(1), Goal(1, of=INTRINSIC)),
    difference=difference,
)
GEODESICS_PREPARED = Row(
    name="geodesics_prepared",
    work="factorisations of the heat method, from the raw arrays",
    contenders=preparing,
    goals=(Goal(1), Goal(1, of=INTRINSIC)),
    difference=difference,
    runs=3,
)
