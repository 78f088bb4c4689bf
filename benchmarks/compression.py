"""Bytes of compressed meshes, beside Draco: ``python -m benchmarks.compression [file ...]``.

Both get the same vertices and faces, and round them to the same grid: 2^bits points along the
longest side. Draco's bytes are the smallest over its levels; xz and meshoptimizer are beside them.
More tables compare at equal errors: Draco's is that of the grid; ours are those of the modes
"smooth" and "spectral", each between whole bits by a line in logarithms, and the one of fewer
bytes counts; for the largest error also what is written with it for a bound. Every file of ours
is decoded and compared, positions and faces; a mesh that does not come back has no ratio.

Seconds are CPU time on one thread. With --folder what was measured is kept there, and a run that
was stopped goes on from it.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, TypeVar

from benchmarks import other_codecs
from benchmarks.compressing import (
    CURVES,
    Curve,
    Duration,
    Point,
    Sizes,
    durations,
    measure,
    measure_point,
    read,
)
from benchmarks.compression_bounds import Within, measure_all
from benchmarks.compression_report import Found, written
from benchmarks.mesh_errors import Errors
from benchmarks.packages import package

BITS = (7, 8, 9, 10, 12, 14)
FILES = (
    "spot_triangulated.obj",
    "fertility.off",
    "Fandisk0.3/Original.obj",
    "camel-head.off",
    "face.obj",
    "conte69_32k_lh.gii",
    "bun_zipper.ply",
    "armadillo.obj",
    "igea.ply",
)
TIMED_FILES = ("camel-head.off", "armadillo.obj")
BOUNDED_FILES = ("fertility.off", "armadillo.obj", "igea.ply")
BLOB = 100_000  # vertices of a mesh of our own, beside these
RUNS = 1
Value = TypeVar("Value")


class Kept:
    """What was measured, by name, in a file that grows."""

    def __init__(self, folder: Path | None) -> None:
        self.path = None if folder is None else folder / "compression.json"
        some = self.path is not None and self.path.exists()
        self.values: dict[str, Any] = (
            json.loads(self.path.read_text()) if self.path and some else {}
        )

    def get(self, name: str, make: Callable[[], Any]) -> Any:
        """Return what is kept under a name, or make and keep it."""
        if name not in self.values:
            self.values[name] = make()
            if self.path is not None:
                partial = self.path.with_suffix(".partial")
                partial.write_text(json.dumps(self.values))
                partial.replace(self.path)
            print(name, file=sys.stderr, flush=True)
        return self.values[name]


def measured(path: Path, bits: Sequence[int], effort: str, kept: Kept, runs: int) -> Found:
    """Measure a mesh, or take what is kept."""
    mesh, name = read(path), path.name
    sizes = []
    for q in bits:
        one = kept.get(f"{name} {q} {effort}", lambda q=q: asdict(measure(name, mesh, q, effort)))
        errors, seconds, draco = Errors(**one["errors"]), one["seconds"], one["draco_seconds"]
        times = {"seconds": tuple(seconds), "draco_seconds": tuple(draco)}
        sizes.append(Sizes(**one | times | {"errors": errors}))
    curves: Curve = {}
    for mode, grids in CURVES.items():
        curves[mode] = []
        for q in (q for q in grids if q <= max(bits)):
            one = kept.get(
                f"{name} {mode} {q} {effort}",
                lambda q=q, mode=mode: asdict(measure_point(mesh, mode, q, effort)),
            )
            curves[mode].append(Point(one["bits"], Errors(**one["errors"]), one["size"]))
    plain = kept.get(f"{name} xz", lambda: other_codecs.xz(mesh))
    flat = kept.get(f"{name} connectivity", lambda: other_codecs.draco_connectivity(mesh))
    times = []
    if runs and name in TIMED_FILES:
        spent = kept.get(f"{name} times", lambda: [asdict(one) for one in durations(mesh, runs)])
        times = [Duration(**one) for one in spent]
    return Found(name, sizes, curves, plain, flat, times)


def measured_within(paths: Sequence[Path], kept: Kept) -> list[Within]:
    """Measure within bounds those of the files that are meant to be, and the blob if all are."""
    found = []
    for path in (path for path in paths if path.name in BOUNDED_FILES):
        found += measure_all(path.name, read(path), kept.get)
    if {path.name for path in paths}.issuperset(BOUNDED_FILES):
        found += measure_all(f"blob({BLOB})", package("beltrami").shapes.blob(BLOB), kept.get)
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure the files that are named, or those of the folder in BELTRAMI_MESHES."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.compression", description=__doc__)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--bits", nargs="+", type=int, default=list(BITS))
    parser.add_argument("--effort", default="best")
    parser.add_argument("--runs", type=int, default=RUNS, help="of the times; 0 for none")
    parser.add_argument("--folder", type=Path, help="keep what was measured there, and go on")
    parser.add_argument("--output", type=Path, help="write the report there, instead of printing")
    asked = parser.parse_args(arguments)
    if asked.folder is not None:
        asked.folder.mkdir(parents=True, exist_ok=True)
    folder, kept = Path(os.environ.get("BELTRAMI_MESHES", ".")), Kept(asked.folder)
    small = package("beltrami").shapes.icosphere(1)
    for mode in CURVES:
        measure_point(small, mode, 5, asked.effort)  # compiles
    measure("to compile", small, 7, asked.effort)
    paths = asked.files or [folder / name for name in FILES]
    found = [measured(path, asked.bits, asked.effort, kept, asked.runs) for path in paths]
    within = measured_within(paths, kept) if asked.runs else []
    report = written(found, asked.effort, within)
    if asked.output is None:
        print(report)
    else:
        asked.output.write_text(report, encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
