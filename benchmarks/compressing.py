"""What compressing one mesh costs: bytes, errors and seconds, ours and those of other codecs."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks import other_codecs
from benchmarks.mesh_errors import Errors, measure_errors
from benchmarks.packages import package

CURVES = {"smooth": range(6, 12), "spectral": range(4, 9)}  # bits of the modes
TIMED = (("grid", 8), ("grid", 14), ("smooth", 8), ("spectral", 6), ("spectral", 8))
TIMED_BOUND = 1e-3  # of the diagonal, for the mode "auto"
BOUNDED_MOST = 20_000  # vertices of meshes that are also written with a bound: several tries each


@dataclass(frozen=True)
class Sizes:
    """Bytes for one mesh and one grid, and seconds, to and fro, of ours and of Draco."""

    name: str
    bits: int
    n: int
    ours: int
    connectivity: int
    draco: int
    meshopt: int | None
    seconds: tuple[float, float]
    draco_seconds: tuple[float, float]
    errors: Errors  # those of Draco too
    bounded: int | None  # ours, with Draco's largest error for a bound
    bounded_mode: str | None

    @property
    def ratio(self) -> float:
        """Ours over Draco's."""
        return self.ours / self.draco


@dataclass(frozen=True)
class Point:
    """One mode at so many bits: its errors and its bytes."""

    bits: int
    errors: Errors
    size: int


@dataclass(frozen=True)
class Duration:
    """Seconds to and fro for 100,000 vertices."""

    mode: str
    setting: str
    effort: str
    compress: float
    decompress: float


Curve = dict[str, list[Point]]


def read(path: Path) -> Any:
    """Read a mesh without the vertices that no face names, in single precision, as Draco has it."""
    bt = package("beltrami")
    mesh = bt.read_mesh(path)
    used, faces = np.unique(mesh.faces, return_inverse=True)
    positions = mesh.vertices[used].astype(np.float32).astype(np.float64)
    return bt.Mesh(positions, faces.reshape(-1, 3))


def same_faces(ours: NDArray[Any], theirs: NDArray[Any]) -> bool:
    """Whether the faces are the same up to their order and first corners."""

    def canonical(faces: NDArray[Any]) -> NDArray[Any]:
        first = faces.argmin(axis=1)[:, None]
        turned = np.take_along_axis(faces, (first + np.arange(3)) % 3, axis=1)
        return turned[np.lexsort(turned.T)]

    return bool(np.array_equal(canonical(ours), canonical(theirs)))


def numbered_back(mesh: Any, found: NDArray[Any], order: NDArray[Any]) -> NDArray[Any]:
    """Give the positions of a file the numbers of the mesh."""
    x = np.empty_like(mesh.vertices)
    x[order] = found
    return x


def measure(name: str, mesh: Any, bits: int, effort: str) -> Sizes:
    """Compress, decompress, compare; return the sizes.

    Raises
    ------
    RuntimeError
        If the mesh does not come back on the grid.
    """
    bt = package("beltrami")
    data, decoded, seconds = _both_ways(mesh, bits=bits, effort=effort)
    order = bt.vertex_order(mesh)
    step = np.ptp(mesh.vertices, axis=0).max() / (2**bits - 1)
    worst = abs(decoded.vertices - mesh.vertices[order]).max() / step
    if worst > 0.501 or not same_faces(order[decoded.faces], mesh.faces):
        raise RuntimeError(f"{name} does not come back: {worst:.3f} steps off")
    describe = package("beltrami.compression.contents").describe
    errors = measure_errors(mesh, numbered_back(mesh, decoded.vertices, order))
    bounded = bounded_mode = None
    if len(mesh.vertices) <= BOUNDED_MOST:
        largest = float(np.linalg.norm(decoded.vertices - mesh.vertices[order], axis=1).max())
        within = bt.compress(mesh, max_error=largest, effort=effort, verify=False)
        bounded, bounded_mode = len(within), describe(within).mode
    return Sizes(
        name,
        bits,
        len(mesh.vertices),
        len(data),
        dict(describe(data).sections)["connectivity"],
        other_codecs.draco(mesh, bits),
        other_codecs.meshopt(mesh, bits),
        seconds,
        other_codecs.draco_seconds(mesh, bits),
        errors,
        bounded,
        bounded_mode,
    )


def _both_ways(mesh: Any, **options: Any) -> tuple[bytes, Any, tuple[float, float]]:
    """Return (bytes, the mesh decoded, CPU seconds to and fro)."""
    bt = package("beltrami")
    start = time.process_time()
    data = bt.compress(mesh, verify=False, **options)
    middle = time.process_time()
    decoded = bt.decompress(data)
    return data, decoded, (middle - start, time.process_time() - middle)


def measure_point(mesh: Any, mode: str, bits: int, effort: str) -> Point:
    """Return (errors, bytes) of a mode that moves vertices off the grid."""
    data, decoded, _ = _both_ways(mesh, bits=bits, mode=mode, effort=effort)
    order = package("beltrami").vertex_order(mesh)
    found = numbered_back(mesh, decoded.vertices, order)
    if not same_faces(order[decoded.faces], mesh.faces):
        raise RuntimeError(f"the faces do not come back in the mode {mode}")
    return Point(bits, measure_errors(mesh, found), len(data))


def durations(mesh: Any, runs: int) -> list[Duration]:
    """Time every mode at both efforts, and ``"auto"`` with a bound; the least of some runs."""
    bound = TIMED_BOUND * float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))
    asked: list[tuple[str, str, dict[str, Any]]] = [
        (mode, f"{bits} bits", {"mode": mode, "bits": bits}) for mode, bits in TIMED
    ]
    asked += [
        (mode, "error 1e-3", {"mode": mode, "max_error": bound})
        for mode in ("smooth", "spectral", "auto")
    ]
    found = []
    for mode, setting, options in asked:
        for effort in ("best", "fast"):
            times = [_both_ways(mesh, effort=effort, **options)[2] for _ in range(runs)]
            to, fro = (min(time) * 1e5 / len(mesh.vertices) for time in zip(*times, strict=True))
            found.append(Duration(mode, setting, effort, to, fro))
    return found
