"""Seconds and bytes of compressing within bounds from coarse to fine, in every mode."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from benchmarks.packages import package
from benchmarks.report import grid

ERRORS = ("1e-2", "3e-3", "1e-3", "3e-4", "1e-4")  # of the diagonal
MODES = ("grid", "smooth", "spectral", "auto")
EFFORTS = ("best", "fast")


@dataclass(frozen=True)
class Within:
    """One mesh within one bound: CPU seconds of compressing, bytes, the mode that was taken."""

    mesh: str
    n: int
    error: str
    mode: str
    effort: str
    seconds: float
    size: int
    taken: str

    @property
    def rate(self) -> float:
        """Seconds for 100,000 vertices."""
        return self.seconds * 1e5 / self.n

    @property
    def cell(self) -> str:
        """What stands in the table."""
        taken = f", {self.taken}" if self.mode == "auto" else ""
        return f"{self.rate:.2f} s, {8 * self.size / self.n:.2f}{taken}"


def measure_within(name: str, mesh: Any, error: str, mode: str, effort: str) -> Within:
    """Compress within a bound; the file is decoded, and must keep it."""
    bt = package("beltrami")
    bound = float(error) * float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))
    start = time.process_time()
    data = bt.compress(mesh, max_error=bound, mode=mode, effort=effort, verify=False)
    seconds = time.process_time() - start
    found = bt.decompress(data).vertices - mesh.vertices[bt.vertex_order(mesh)]
    if np.linalg.norm(found, axis=1).max() > bound:
        raise RuntimeError(f"{name} is farther off than {error} in the mode {mode}")
    taken = package("beltrami.compression.contents").describe(data).mode
    return Within(name, mesh.n_vertices, error, mode, effort, seconds, len(data), taken)


def _measure(*asked: Any) -> dict[str, Any]:
    return asdict(measure_within(*asked))


def measure_all(name: str, mesh: Any, get: Callable[[str, Callable[[], Any]], Any]) -> list[Within]:
    """Measure every bound, effort and mode, or take what ``get`` keeps."""
    found = []
    for error, effort, mode in product(ERRORS, EFFORTS, MODES):
        make = partial(_measure, name, mesh, error, mode, effort)
        found.append(Within(**get(f"{name} within {error} {mode} {effort}", make)))
    return found


def goal_lines(found: Sequence[Within], goals: dict[str, float]) -> Iterator[list[str]]:
    """Say of each mesh and effort how slow the slowest is."""
    for mesh in dict.fromkeys(one.mesh for one in found):
        for effort, most in goals.items():
            slowest = max(
                (one for one in found if (one.mesh, one.effort) == (mesh, effort)),
                key=lambda one: one.rate,
            )
            where = f"{slowest.mode}, {slowest.error}, {mesh} of {slowest.n:,} vertices"
            told = f"{slowest.rate:.1f}", f"<= {most:g}"
            judged = "met" if slowest.rate <= most else "**missed**"
            yield [f"seconds for 100k vertices within a bound, {effort} ({where})", *told, judged]


def table(found: Sequence[Within]) -> str:
    """Write seconds for 100k vertices and bits per vertex of each bound, effort and mode."""
    meshes = list(dict.fromkeys(one.mesh for one in found))
    cells = {(one.error, one.effort, one.mode, one.mesh): one.cell for one in found}
    lines = [
        [f"{error}, {effort}, {mode}", *(cells[error, effort, mode, mesh] for mesh in meshes)]
        for error, effort, mode in product(ERRORS, EFFORTS, MODES)
    ]
    return grid(["error, effort, mode", *meshes], lines)
