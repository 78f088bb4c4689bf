"""BENCHMARKS-COMPRESSION.md: the goals, and the tables they come from."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from benchmarks import compression_bounds
from benchmarks.compressing import BOUNDED_MOST, Curve, Duration, Sizes
from benchmarks.compression_bounds import Within
from benchmarks.machine import facts
from benchmarks.mesh_errors import bytes_at
from benchmarks.packages import versions
from benchmarks.report import NONE, grid

SAME = "same grid"
MEASURES = {
    "rms": "RMS distance of the vertices",
    "angle": "normal angle",
    "visual": "error of Karni and Gotsman",
    "largest": "largest distance",
}
GOALS = {
    SAME: {7: 0.65, 8: 0.71, 9: 0.75, 10: 0.78, 12: 0.84, 14: 0.88},
    "rms": {7: 0.50, 8: 0.60, 9: 0.68, 10: 0.75, 12: 0.84, 14: 0.88},
    "angle": {8: 0.52, 9: 0.52, 10: 0.66},
}
CONNECTIVITY_GOAL = 0.90
SECONDS_GOALS = {"best": 10.0, "fast": 4.0}
HEAD = """# Benchmarks of compression

Written by `python -m benchmarks.compression --folder kept --output BENCHMARKS-COMPRESSION.md`
with one thread (OPENBLAS_NUM_THREADS=1); its `--help` tells how it is measured. Bytes are those
of whole files; ratios below 1 are fewer bytes than Draco's at its best level, on the grid of so
many bits or at the error that this grid has. Errors are parts of the diagonal of the bounding
box. Means are geometric.
"""


@dataclass(frozen=True)
class Found:
    """All that was measured of one mesh; ``xz`` and ``draco_connectivity`` are bytes."""

    name: str
    sizes: list[Sizes]
    curves: Curve
    xz: int
    draco_connectivity: int
    durations: list[Duration]

    @property
    def connectivity(self) -> float:
        """Our bytes of the faces over Draco's."""
        return self.sizes[-1].connectivity / self.draco_connectivity

    def at_equal(self, measure: str, one: Sizes) -> tuple[float, str]:
        """Return (our bytes over Draco's, the mode) at the error that Draco has."""
        error = getattr(one.errors, measure)
        found = [(one.ratio, "grid")]
        for mode, curve in self.curves.items():
            points = [(getattr(point.errors, measure), point.size) for point in curve]
            if points:
                found.append((bytes_at(error, points) / one.draco, mode))
        if measure == "largest" and one.bounded is not None:
            found.append((one.bounded / one.draco, f"{one.bounded_mode}, as a bound"))
        return min(found)

    def ratio(self, measure: str, one: Sizes) -> tuple[float, str]:
        """Return the ratio and what stands in its cell."""
        if measure == SAME:
            return one.ratio, f"{8 * one.ours / one.n:.2f} ({one.ratio:.3f})"
        ratio, mode = self.at_equal(measure, one)
        return ratio, f"{ratio:.3f} {mode}"


def geometric_mean(values: Sequence[float]) -> float:
    """Return e to the mean of the logarithms."""
    return math.exp(sum(map(math.log, values)) / len(values))


def means(found: Sequence[Found], measure: str) -> dict[int, float]:
    """Return the mean ratio at each number of bits."""
    ratios: dict[int, list[float]] = {}
    for mesh in found:
        for one in mesh.sizes:
            ratios.setdefault(one.bits, []).append(mesh.ratio(measure, one)[0])
    return {bits: geometric_mean(values) for bits, values in ratios.items()}


def _judged(value: float, limit: float) -> str:
    return "met" if value <= limit else "**missed**"


def _goal_lines(found: Sequence[Found]) -> Iterator[list[str]]:
    """Say of each goal whether it is met."""
    for measure, limits in GOALS.items():
        for bits, value in means(found, measure).items():
            if bits in limits:
                what = SAME if measure == SAME else f"equal {MEASURES[measure]}"
                told = f"{value:.3f}", f"<= {limits[bits]:.2f}", _judged(value, limits[bits])
                yield [f"{what}, {bits} bits", *told]
    every = [*GOALS, *(measure for measure in MEASURES if measure not in GOALS)]
    worst = max(
        (mesh.ratio(measure, one)[0], f"{mesh.name}, {one.bits} bits, {measure}")
        for mesh in found
        for one in mesh.sizes
        for measure in every
    )
    yield [f"worst of all tables ({worst[1]})", f"{worst[0]:.3f}", "<= 1", _judged(worst[0], 1.0)]
    shares = [mesh.connectivity for mesh in found]
    mean, limit = geometric_mean(shares), CONNECTIVITY_GOAL
    yield ["connectivity, mean", f"{mean:.3f}", f"<= {limit:.2f}", _judged(mean, limit)]
    share, name = max((mesh.connectivity, mesh.name) for mesh in found)
    yield [
        f"connectivity, worst ({name})",
        f"{share:.3f}",
        f"<= {limit:.2f}",
        _judged(share, limit),
    ]
    for effort, most in SECONDS_GOALS.items():
        for bounded in (False, True):
            spent = [
                (max(one.compress, one.decompress), f"{one.mode}, {one.setting}, {mesh.name}")
                for mesh in found
                for one in mesh.durations
                if one.effort == effort and one.setting.startswith("error") == bounded
            ]
            if spent:
                seconds, where = max(spent)
                told = f"{seconds:.1f}", f"<= {most:g}", _judged(seconds, most)
                yield [f"seconds for 100k vertices, {effort}: slowest ({where})", *told]


def _ratios(found: Sequence[Found], measure: str) -> str:
    """Write the ratios of each mesh, and their means beside the goals."""
    bits = [one.bits for one in found[0].sizes]
    title = "bits per vertex (ratio)" if measure == SAME else "ratio, mode"
    lines = [[mesh.name, *(mesh.ratio(measure, one)[1] for one in mesh.sizes)] for mesh in found]
    limits = GOALS.get(measure, {})
    mean = means(found, measure)
    goals = {q: f" (goal {limits[q]:.2f})" if q in limits else "" for q in bits}
    lines.append(["geometric mean", *(f"**{mean[q]:.3f}**{goals[q]}" for q in bits)])
    return grid([title, *(f"{q} bits" for q in bits)], lines)


def _others(found: Sequence[Found]) -> str:
    """Write bits per vertex of all codecs, the errors, and seconds per 100k vertices."""
    heads = ["mesh, bits", "ours", "Draco", "meshopt + zstd", "xz", "RMS", "largest", "angle"]
    heads += ["Karni-Gotsman", "s/100k, to and fro", "Draco's"]
    lines = []
    for mesh in found:
        for one in mesh.sizes:
            rates = [one.ours, one.draco, one.meshopt, mesh.xz]
            told = [NONE if size is None else f"{8 * size / one.n:.2f}" for size in rates]
            errors = one.errors
            told += [f"{errors.rms:.2e}", f"{errors.largest:.2e}", f"{errors.angle:.2f}°"]
            told.append(f"{errors.visual:.2e}")
            for seconds in (one.seconds, one.draco_seconds):
                told.append(", ".join(f"{s * 1e5 / one.n:.2f}" for s in seconds))
            lines.append([f"{mesh.name} {one.bits}", *told])
    return grid(heads, lines)


def _faces(found: Sequence[Found]) -> str:
    """Write the bits of the faces."""
    lines = []
    for mesh in found:
        n = mesh.sizes[0].n
        ours, theirs = 8 * mesh.sizes[-1].connectivity / n, 8 * mesh.draco_connectivity / n
        lines.append(
            [mesh.name, str(n), f"{ours:.3f}", f"{theirs:.3f}", f"{mesh.connectivity:.3f}"]
        )
    return grid(["mesh", "vertices", "ours, bits per vertex", "Draco's", "ratio"], lines)


def _seconds(found: Sequence[Found]) -> str:
    """Write how long each mode takes."""
    timed = [mesh for mesh in found if mesh.durations]
    heads = ["mode, setting, effort", *(mesh.name for mesh in timed)]
    lines = [
        [
            f"{same[0].mode}, {same[0].setting}, {same[0].effort}",
            *(f"{one.compress:.2f}, {one.decompress:.2f}" for one in same),
        ]
        for same in zip(*(mesh.durations for mesh in timed), strict=True)
    ]
    return grid(heads, lines)


def written(found: Sequence[Found], effort: str, within: Sequence[Within] = ()) -> str:
    """Write the report."""
    parts = [HEAD, f"Effort: {effort}, unless another one is said.", "## Goals"]
    goals = [*_goal_lines(found), *compression_bounds.goal_lines(within, SECONDS_GOALS)]
    parts.append(grid(("what", "value", "goal", ""), goals))
    parts += ["## On the same grid", _ratios(found, SAME)]
    for measure, name in MEASURES.items():
        parts += [f"## At equal {name}", _ratios(found, measure)]
    parts.append(f"With a bound only meshes of at most {BOUNDED_MOST:,} vertices were written.")
    parts += ["## Faces", _faces(found)]
    parts += ["## All codecs, errors and times", _others(found)]
    if any(mesh.durations for mesh in found):
        parts += ["## Seconds for 100k vertices, to and fro", _seconds(found)]
        parts.append("A file is not verified here; `compress` also decodes it unless told not to.")
    if within:
        parts += ["## Within a bound: seconds for 100k vertices, bits per vertex", _BOUNDS]
        parts.append(compression_bounds.table(within))
    known = [*facts(), *((name, version) for name, version in versions() if name in _NAMED)]
    parts += ["## Machine and packages", grid(("", ""), known)]
    return "\n\n".join(part.strip() for part in parts) + "\n"


_BOUNDS = """Errors are parts of the diagonal; with "auto" the mode follows that was taken. Every
file keeps its bound. Seconds are those of compressing without verification."""
_NAMED = ("beltrami", "DracoPy", "meshoptimizer", "zstandard", "numpy", "numba")
