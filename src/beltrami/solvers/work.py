"""Work: what a search for eigenpairs knows so far."""

from __future__ import annotations

from dataclasses import dataclass

from beltrami._arrays import Floats
from beltrami.solvers.pencil import Pencil


@dataclass(eq=False)
class Work:
    """What grows during the computation; values and vectors of the pencil, without its kernel."""

    pencil: Pencil
    near: float
    k: int
    tol: float
    seed: int
    values: Floats
    vectors: Floats
    residuals: Floats
    definite: bool = True
    method: str = "kernel"
    precision: str = "float64"
    shift: float = 0.0
    basis: int = 0
    block: int = 0
    solves: int = 0
    history: tuple[float, ...] = ()
    counted: float = 0.0
