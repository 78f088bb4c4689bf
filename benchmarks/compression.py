"""Bytes of compressed meshes, beside Draco: ``python -m benchmarks.compression [file ...]``.

Both get the same vertices and faces, and round them to the same grid: 2^bits points along the
longest side. Draco's bytes are the smallest over its levels. A second table compares at
equal root mean square errors: Draco's is that of the grid, ours that of the mode "smooth", between
whole bits by a line in logarithms. Every file of ours is decoded and
compared, positions and faces; a mesh that does not come back has no ratio.
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

from benchmarks.packages import package

BITS = (7, 8, 9, 10, 11, 12, 13, 14)
LEVELS = (5, 7, 8, 9, 10)
FILES = (
    "spot_triangulated.obj",
    "fertility.off",
    "Fandisk0.3/Original.obj",
    "camel-head.off",
    "armadillo.obj",
    "igea.ply",
)
GOALS = {7: 0.65, 8: 0.71, 9: 0.75, 10: 0.78, 12: 0.84, 14: 0.88}
EQUAL_ERROR_GOALS = {7: 0.50, 8: 0.60, 9: 0.68, 10: 0.75, 12: 0.84, 14: 0.88}
CONNECTIVITY_GOAL = 0.90
COARSEST = 4  # bits of the mode "smooth" that may reach Draco's error


@dataclass(frozen=True)
class Sizes:
    """Bytes for one mesh and one grid, and the seconds of ours, to and fro."""

    name: str
    bits: int
    n: int
    ours: int
    connectivity: int
    draco: int
    seconds: tuple[float, float]
    error: float  # root mean square, that of Draco too

    @property
    def ratio(self) -> float:
        """Ours over Draco's."""
        return self.ours / self.draco


def read(path: Path) -> Any:
    """Read a mesh without the vertices that no face names, in single precision, as Draco has it."""
    bt = package("beltrami")
    mesh = bt.read_mesh(path)
    used, faces = np.unique(mesh.faces, return_inverse=True)
    positions = mesh.vertices[used].astype(np.float32).astype(np.float64)
    return bt.Mesh(positions, faces.reshape(-1, 3))


def draco(mesh: Any, bits: int) -> int:
    """Return the fewest bytes of Draco over its levels."""
    encode = package("DracoPy").encode
    V, F = mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32)
    return min(len(encode(V, F, quantization_bits=bits, compression_level=q)) for q in LEVELS)


def draco_connectivity(mesh: Any) -> int:
    """Return the fewest bytes where every position is rounded to the same point."""
    encode = package("DracoPy").encode
    V, F = mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32)
    flat = {"quantization_bits": 1, "quantization_range": 1e8, "quantization_origin": [0, 0, 0]}
    return min(len(encode(V, F, compression_level=q, **flat)) for q in LEVELS)


def same_faces(ours: NDArray[Any], theirs: NDArray[Any]) -> bool:
    """Whether the faces are the same up to their order and first corners."""

    def canonical(faces: NDArray[Any]) -> NDArray[Any]:
        first = faces.argmin(axis=1)[:, None]
        turned = np.take_along_axis(faces, (first + np.arange(3)) % 3, axis=1)
        return turned[np.lexsort(turned.T)]

    return bool(np.array_equal(canonical(ours), canonical(theirs)))


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
    connectivity = dict(contents.sections)["connectivity"]
    seconds = (middle - start, end - middle)
    size, error = len(mesh.vertices), root_mean_square(mesh, decoded.vertices, order)
    return Sizes(name, bits, size, len(data), connectivity, draco(mesh, bits), seconds, error)


def root_mean_square(mesh: Any, found: NDArray[Any], order: NDArray[Any]) -> float:
    """Return the root of the mean square distance of the vertices."""
    return float(np.sqrt(((found - mesh.vertices[order]) ** 2).sum(axis=1).mean()))


def smooth_curve(mesh: Any, bits: Sequence[int], effort: str) -> list[tuple[float, int]]:
    """Return (error, bytes) of the mode "smooth" on these grids."""
    bt = package("beltrami")
    order = bt.vertex_order(mesh)
    curve = []
    for q in bits:
        data = bt.compress(mesh, bits=q, mode="smooth", effort=effort, verify=False)
        found = bt.decompress(data).vertices
        curve.append((root_mean_square(mesh, found, order), len(data)))
    return curve


def bytes_at(error: float, curve: Sequence[tuple[float, int]]) -> float:
    """Return the bytes that this error takes, by lines in logarithms; no fewer than the fewest."""
    logs = np.log(sorted(curve))
    return float(np.exp(np.interp(np.log(error), logs[:, 0], logs[:, 1])))


def geometric_mean(values: Sequence[float]) -> float:
    """Return e to the mean of the logarithms."""
    return math.exp(sum(map(math.log, values)) / len(values))


def report(sizes: Sequence[Sizes], bits: Sequence[int]) -> str:
    """Write a Markdown table: bits per vertex of ours, ratio to Draco, and the mean ratios."""
    lines = ["| mesh | vertices | " + " | ".join(f"{q} bits" for q in bits) + " |"]
    lines.append("|---|---|" + "---|" * len(bits))
    for name in dict.fromkeys(one.name for one in sizes):
        row = [one for one in sizes if one.name == name]
        cells = [f"{8 * one.ours / one.n:.2f} ({one.ratio:.3f})" for one in row]
        lines.append(f"| {name} | {row[0].n} | " + " | ".join(cells) + " |")
    means = []
    for q in bits:
        mean = geometric_mean([one.ratio for one in sizes if one.bits == q])
        goal = GOALS.get(q)
        means.append(f"**{mean:.3f}**" + (f" (goal {goal})" if goal else ""))
    lines.append("| geometric mean | | " + " | ".join(means) + " |")
    return "\n".join(lines)


def equal_errors(
    sizes: Sequence[Sizes], curves: dict[str, list[tuple[float, int]]], bits: Sequence[int]
) -> str:
    """Write a Markdown table: our bytes over Draco's, at the error that Draco has."""
    lines = ["| equal error | " + " | ".join(f"{q} bits" for q in bits) + " |"]
    lines.append("|---|" + "---|" * len(bits))
    ratios = {one: bytes_at(one.error, curves[one.name]) / one.draco for one in sizes}
    for name in curves:
        cells = [f"{ratios[one]:.3f}" for one in sizes if one.name == name]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    means = []
    for q in bits:
        mean = geometric_mean([ratios[one] for one in sizes if one.bits == q])
        goal = EQUAL_ERROR_GOALS.get(q)
        means.append(f"**{mean:.3f}**" + (f" (goal {goal})" if goal else ""))
    lines.append("| geometric mean | " + " | ".join(means) + " |")
    return "\n".join(lines)


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure the files that are named, or those of the folder in BELTRAMI_MESHES."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.compression", description=__doc__)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--bits", nargs="+", type=int, default=list(BITS))
    parser.add_argument("--effort", default="best")
    asked = parser.parse_args(arguments)
    folder = Path(os.environ.get("BELTRAMI_MESHES", "."))
    sizes, ratios, curves = [], [], {}
    for path in asked.files or [folder / name for name in FILES]:
        mesh = read(path)
        for bits in asked.bits:
            one = measure(path.name, mesh, bits, asked.effort)
            sizes.append(one)
            rate = 1e5 / one.n
            told = "  ".join(f"{s * rate:.1f}" for s in one.seconds)
            print(f"{one.name} {bits}: {one.ratio:.3f}; seconds/100k: {told}", flush=True)
        grids = range(COARSEST, max(asked.bits) + 1)
        curves[path.name] = smooth_curve(mesh, grids, asked.effort)
        ratios.append(sizes[-1].connectivity / draco_connectivity(mesh))
        print(f"{path.name}: connectivity {ratios[-1]:.3f} of Draco's", flush=True)
    print()
    print(report(sizes, asked.bits))
    print()
    print(equal_errors(sizes, curves, asked.bits))
    print(f"\nConnectivity: {geometric_mean(ratios):.3f} of Draco's (goal {CONNECTIVITY_GOAL}).")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
