"""The harmonic map of a disk to the circle, from two raw arrays and the boundary."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.cases import Case
from benchmarks.claims import Contender, Goal, Row
from benchmarks.packages import package


def difference(a: NDArray[Any], b: NDArray[Any]) -> float:
    """Largest distance of two images of a vertex, over the radius of the disk."""
    return float(np.linalg.norm(a - b, axis=1).max())


def contenders(case: Case) -> Sequence[Contender]:
    V = case.vertices

    @cache
    def disk() -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
        """Drop the faces around vertex 0; return faces, boundary, its places on the circle."""
        bt = package("beltrami")
        F = np.delete(case.faces, bt.Mesh(V, case.faces).face_ring(0), axis=0)
        loop = np.array(bt.Mesh(V, F).boundary_loops[0])
        turn = 2 * np.pi * np.arange(len(loop)) / len(loop)
        return F, loop, np.stack([np.cos(turn), np.sin(turn)], axis=1)

    def compact() -> tuple[NDArray[Any], NDArray[Any], NDArray[Any], NDArray[Any]]:
        F, loop, placed = disk()
        used, local = np.unique(F, return_inverse=True)
        return V[used], local.reshape(-1, 3), np.searchsorted(used, loop), placed

    def ours(given: Any) -> Any:
        bt = package("beltrami")
        x, faces, loop, placed = given
        return bt.harmonic(bt.Mesh(x, faces), loop, placed, "cotangent")

    def igl(given: Any) -> Any:
        x, faces, loop, placed = given
        return package("igl").harmonic(x, faces, loop, placed, 1)

    return [
        Contender("beltrami", ours, compact, ours=True),
        Contender("libigl", igl, compact),
    ]


HARMONIC = Row(
    name="harmonic",
    work="harmonic map of a disk to the circle, cotangent weights, from the raw arrays",
    contenders=contenders,
    goals=(Goal(0.4),),
    difference=difference,
    runs=3,
)
