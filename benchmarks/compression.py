"""Bytes of compressed meshes, beside Draco: ``python -m benchmarks.compression [file ...]``.

Both get the same vertices and faces, and round them to the same grid: 2^bits points along the
longest side. Draco's bytes are the smallest over its levels; xz and meshoptimizer are beside them.
More tables compare at equal errors: Draco's is that of the grid; ours are those of the modes
"smooth" and "spectral", each between whole bits by a line in logarithms, and the one of fewer
bytes counts; for the largest error also what is written with it for a bound. Every file of ours
is decoded and compared, positions and faces; a mesh that does not come back has no ratio.
"""

from __future__ import annotations

import argparse
import math
import os
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks import other_codecs
from benchmarks.mesh_errors import Errors, bytes_at, measure_errors
from benchmarks.packages import package

BITS = (7, 8, 9, 10, 11, 12, 13, 14)
FILES = (
    "spot_triangulated.obj",
    "fertility.off",
    "Fandisk0.3/Original.obj",
    "camel-head.off",
    "bun_zipper.ply",
    "armadillo.obj",
    "igea.ply",
)
GOALS = {
    "the same grid": {7: 0.65, 8: 0.71, 9: 0.75, 10: 0.78, 12: 0.84, 14: 0.88},
    "rms": {7: 0.50, 8: 0.60, 9: 0.68, 10: 0.75, 12: 0.84, 14: 0.88},
    "angle": {8: 0.52, 9: 0.52, 10: 0.66},
}
CONNECTIVITY_GOAL = 0.90
CURVES = {"smooth": range(4, 15), "spectral": range(3, 11)}  # bits of the modes


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
    bounded: int  # ours, with Draco's largest error for a bound

    @property
    def ratio(self) -> float:
        """Ours over Draco's."""
        return self.ours / self.draco


Curve = dict[str, list[tuple[Errors, int]]]


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
    start = time.process_time()
    data = bt.compress(mesh, bits=bits, effort=effort, verify=False)
    middle = time.process_time()
    decoded = bt.decompress(data)
    end = time.process_time()
    order = bt.vertex_order(mesh)
    step = np.ptp(mesh.vertices, axis=0).max() / (2**bits - 1)
    worst = abs(decoded.vertices - mesh.vertices[order]).max() / step
    if worst > 0.501 or not same_faces(order[decoded.faces], mesh.faces):
        raise RuntimeError(f"{name} does not come back: {worst:.3f} steps off")
    contents = package("beltrami.compression.contents").describe(data)
    errors = measure_errors(mesh, numbered_back(mesh, decoded.vertices, order))
    largest = float(np.linalg.norm(decoded.vertices - mesh.vertices[order], axis=1).max())
    bounded = bt.compress(mesh, max_error=largest, effort=effort, verify=False)
    return Sizes(
        name,
        bits,
        len(mesh.vertices),
        len(data),
        dict(contents.sections)["connectivity"],
        other_codecs.draco(mesh, bits),
        other_codecs.meshopt(mesh, bits),
        (middle - start, end - middle),
        other_codecs.draco_seconds(mesh, bits),
        errors,
        len(bounded),
    )


def error_curves(mesh: Any, most: int, effort: str) -> Curve:
    """Return (errors, bytes) of the modes that move vertices off the grid."""
    bt = package("beltrami")
    order = bt.vertex_order(mesh)
    curves: Curve = {}
    for mode, grids in CURVES.items():
        curves[mode] = []
        for q in grids:
            if q <= most:
                data = bt.compress(mesh, bits=q, mode=mode, effort=effort, verify=False)
                found = numbered_back(mesh, bt.decompress(data).vertices, order)
                curves[mode].append((measure_errors(mesh, found), len(data)))
    return curves


def at_equal(measure_name: str, one: Sizes, curves: Curve) -> tuple[float, str]:
    """Return (our bytes over Draco's, the mode) at the error that Draco has."""
    error = getattr(one.errors, measure_name)
    found = []
    for mode, curve in curves.items():
        points = [(getattr(errors, measure_name), size) for errors, size in curve]
        found.append((bytes_at(error, points) / one.draco, mode))
    found.append((one.ratio, "grid"))
    if measure_name == "largest":
        found.append((one.bounded / one.draco, "bound"))
    return min(found)


def geometric_mean(values: Sequence[float]) -> float:
    """Return e to the mean of the logarithms."""
    return math.exp(sum(map(math.log, values)) / len(values))


def _table(
    title: str, cells: dict[str, dict[int, tuple[float, str]]], goals: dict[int, float]
) -> str:
    """Write a Markdown table of (ratio, text) by mesh and bits, with the mean ratios."""
    bits = sorted({q for row in cells.values() for q in row})
    lines = [f"| {title} | " + " | ".join(f"{q} bits" for q in bits) + " |"]
    lines.append("|---|" + "---|" * len(bits))
    for name, row in cells.items():
        lines.append(f"| {name} | " + " | ".join(row[q][1] for q in bits) + " |")
    means = []
    for q in bits:
        mean = geometric_mean([row[q][0] for row in cells.values()])
        means.append(f"**{mean:.3f}**" + (f" (goal {goals[q]})" if q in goals else ""))
    lines.append("| geometric mean | " + " | ".join(means) + " |")
    return "\n".join(lines)


def report(sizes: Sequence[Sizes]) -> str:
    """Write the bits per vertex on the same grid, and the ratios to Draco."""
    cells: dict[str, dict[int, tuple[float, str]]] = {}
    for one in sizes:
        text = f"{8 * one.ours / one.n:.2f} ({one.ratio:.3f})"
        cells.setdefault(one.name, {})[one.bits] = one.ratio, text
    return _table("the same grid", cells, GOALS["the same grid"])


def equal_errors(name: str, sizes: Sequence[Sizes], curves: dict[str, Curve]) -> str:
    """Write our bytes over Draco's at Draco's error, and the mode that takes the fewest."""
    cells: dict[str, dict[int, tuple[float, str]]] = {}
    for one in sizes:
        ratio, mode = at_equal(name, one, curves[one.name])
        cells.setdefault(one.name, {})[one.bits] = ratio, f"{ratio:.3f} {mode}"
    return _table(f"equal {name}", cells, GOALS.get(name, {}))


def others(sizes: Sequence[Sizes], plain: dict[str, int]) -> str:
    """Write bits per vertex of all codecs, the errors, and seconds per 100k vertices."""
    lines = ["| mesh, bits | ours | Draco | meshopt + zstd | xz | rms | largest | angle | visual |"]
    lines[0] += " s/100k, to and fro | Draco's |"
    lines.append("|---|" + "---|" * 10)
    for one in sizes:
        rates = [one.ours, one.draco, one.meshopt, plain[one.name]]
        told = ["-" if size is None else f"{8 * size / one.n:.2f}" for size in rates]
        errors = one.errors
        told += [f"{errors.rms:.2e}", f"{errors.largest:.2e}", f"{errors.angle:.2f}°"]
        told.append(f"{errors.visual:.2e}")
        for seconds in (one.seconds, one.draco_seconds):
            told.append(", ".join(f"{s * 1e5 / one.n:.2f}" for s in seconds))
        lines.append(f"| {one.name} {one.bits} | " + " | ".join(told) + " |")
    return "\n".join(lines)


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure the files that are named, or those of the folder in BELTRAMI_MESHES."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.compression", description=__doc__)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--bits", nargs="+", type=int, default=list(BITS))
    parser.add_argument("--effort", default="best")
    asked = parser.parse_args(arguments)
    folder = Path(os.environ.get("BELTRAMI_MESHES", "."))
    sizes: list[Sizes] = []
    curves: dict[str, Curve] = {}
    faces, plain = [], {}
    small = package("beltrami").shapes.icosphere(1)
    measure("to compile", small, 7, asked.effort)
    for path in asked.files or [folder / name for name in FILES]:
        mesh = read(path)
        for bits in asked.bits:
            one = measure(path.name, mesh, bits, asked.effort)
            sizes.append(one)
            print(f"{one.name} {bits}: {one.ratio:.3f} of Draco", flush=True)
        curves[path.name] = error_curves(mesh, max(asked.bits), asked.effort)
        plain[path.name] = other_codecs.xz(mesh)
        faces.append(sizes[-1].connectivity / other_codecs.draco_connectivity(mesh))
        print(f"{path.name}: connectivity {faces[-1]:.3f} of Draco's", flush=True)
    for table in (report(sizes), *(equal_errors(name, sizes, curves) for name in _MEASURES)):
        print("\n" + table)
    print("\n" + others(sizes, plain))
    print(f"\nConnectivity: {geometric_mean(faces):.3f} of Draco's (goal {CONNECTIVITY_GOAL}).")
    return 0


_MEASURES = ("rms", "angle", "visual", "largest")

if __name__ == "__main__":
    raise SystemExit(main())
