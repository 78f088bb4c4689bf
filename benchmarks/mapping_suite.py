"""Maps of disks to the plane, beside libigl, PyMeshLab and xatlas: valid, distorted, how long.

python -m benchmarks.mapping_suite [disk ...] [--largest 50000] [--slow 12000] [--details]
python -m benchmarks.mapping_suite --large SIZE ...

Disks are natural ones, surfaces cut to disks, spheres less one triangle, and closed tubes less
one triangle, longer and longer; every method gets the same vertices and faces. Slow peers (SLIM
and xatlas) get those of 12,000 vertices at most, or as many as ``--slow`` says. Valid is what our
exact certificate calls a bijection (mirrored charts are turned back first), whoever made it.
Distortion is the symmetric Dirichlet energy at the best scale, 1 for an isometry. Seconds are CPU
time. SLIM starts from our map with a fixed boundary, because it cannot start from a fold. An atlas
of xatlas has charts of its own choice: they are counted.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.disks import GROUPS, suite
from benchmarks.packages import package
from benchmarks.surfaces import disk_of, less_one

FIXED_GOALS = {"natural": 1.8, "cut": 3.0, "one triangle": 10.0}
SECONDS_GOALS = {50_000: 3.0, 200_000: 15.0}
SLIM_GOAL, SLIM_STEPS = 1.1, 20
SLOW = 12_000
SLOW_PEERS = (f"libigl slim({SLIM_STEPS})", "xatlas")
OURS = ("auto", "free", "tutte", "least_squares_conformal", "spectral_conformal")

Array = NDArray[Any]


@dataclass(frozen=True)
class Outcome:
    """One map: whether it is a bijection, how distorted, in how many seconds."""

    valid: bool
    energy: float
    seconds: float
    note: str = ""


Found = dict[tuple[str, str], dict[str, Outcome]]  # by group and method, then by disk


def judged(mesh: Any, call: Callable[[], Array]) -> Outcome:
    """Time a map of the vertices, certify it and measure it; what fails is no map."""
    bt = package("beltrami")
    start = time.process_time()
    try:
        uv = np.ascontiguousarray(call(), dtype=np.float64)[:, :2]
    except Exception as failure:  # noqa: BLE001, of any library
        return Outcome(False, np.inf, time.process_time() - start, type(failure).__name__)
    seconds = time.process_time() - start
    if uv.shape != (mesh.n_vertices, 2) or not np.isfinite(uv).all():
        return Outcome(False, np.inf, seconds, "not finite")
    found = bt.certify(upright(mesh, uv), uv)
    note = f"{len(found.flipped)} flipped" if len(found.flipped) else ""
    if len(found.crossings):
        note = f"{note} {len(found.crossings)} crossings".strip()
    energy = bt.distortion(mesh, uv).symmetric_dirichlet
    return Outcome(found.is_bijective, energy, seconds, note)


def upright(mesh: Any, uv: Array) -> Any:
    """Turn over the faces of each component of which the image is mirrored for the most part."""
    labels = mesh.components()
    a, b, c = uv[mesh.faces].transpose(1, 0, 2)
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    mirrored = np.bincount(labels, np.sign(area))[labels] < 0
    faces = np.where(mirrored[:, None], mesh.faces[:, ::-1], mesh.faces)
    return package("beltrami").Mesh(mesh.vertices, faces)


def methods(mesh: Any) -> Iterator[tuple[str, Callable[[], Outcome]]]:
    """Yield the maps of a disk, ours first."""
    bt = package("beltrami")
    kept: dict[str, Array] = {}

    def ours(method: str) -> Array:
        strict = method in ("auto", "free")
        kept[method] = bt.parameterize(mesh, method, cut=False, strict=strict).uv
        return kept[method]

    for method in OURS:
        yield f"beltrami {method}", lambda method=method: judged(mesh, lambda: ours(method))
    V, F = np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64)
    loop = np.array(mesh.boundary_loops[0])
    for name, call in _libigl(V, F, loop, kept):
        yield name, lambda call=call: judged(mesh, call)
    for name in ("harmonic", "least_squares_conformal_maps"):
        yield f"pymeshlab {name}", lambda name=name: judged(mesh, lambda: _pymeshlab(V, F, name))
    yield "xatlas", lambda: _xatlas(V, F)


def _libigl(
    V: Array, F: Array, loop: Array, kept: dict[str, Array]
) -> Iterator[tuple[str, Callable[[], Array]]]:
    def placed() -> Array:
        return np.asarray(package("igl").map_vertices_to_circle(V, loop))

    def lscm() -> Array:
        ends = loop[[0, len(loop) // 2]]
        uv = package("igl").lscm(V, F, ends, np.array([[0.0, 0.0], [1.0, 0.0]]))
        return np.asarray(uv[0] if isinstance(uv, tuple) else uv)

    def slim() -> Array:
        igl = package("igl")
        sides = np.linalg.norm(V[F] - V[np.roll(F, 1, axis=1)], axis=2)
        half = sides.sum(axis=1) / 2
        area = np.sqrt(np.maximum(half * (half[:, None] - sides).prod(axis=1), 0)).sum()
        unit = np.sqrt(area / np.pi)  # the circle has the area of the surface
        kind = igl.MappingEnergyType.SYMMETRIC_DIRICHLET
        none = np.zeros(0, np.int64), np.zeros((0, 2))
        begin = np.asfortranarray(kept["auto"])
        data = igl.slim_precompute(V / unit, F, begin, kind, *none, 0.0)
        return np.asarray(igl.slim_solve(data, SLIM_STEPS))

    yield "libigl harmonic", lambda: package("igl").harmonic(V, F, loop, placed(), 1)
    yield "libigl lscm", lscm
    yield f"libigl slim({SLIM_STEPS})", slim


def _pymeshlab(V: Array, F: Array, name: str) -> Array:
    pymeshlab = package("pymeshlab")
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(V, F.astype(np.int32)))
    meshes.apply_filter(f"compute_texcoord_parametrization_{name}")
    return np.asarray(meshes.current_mesh().vertex_tex_coord_matrix())


def _xatlas(V: Array, F: Array) -> Outcome:
    """Its charts are many maps: valid if all of them are bijections, apart from each other.

    It cuts by itself, so it gets the surface without our cut.
    """
    bt = package("beltrami")
    V, welded = np.unique(V, axis=0, return_inverse=True)
    F = welded.ravel()[F]
    start = time.process_time()
    try:
        atlas = package("xatlas").Atlas()
    except ImportError:
        return Outcome(False, np.inf, 0.0, "not installed")
    atlas.add_mesh(V.astype(np.float32), F.astype(np.uint32))
    options = package("xatlas").PackOptions()
    options.padding = 2  # charts that touch would not be apart
    atlas.generate(pack_options=options)
    copies, faces, uv = atlas.get_mesh(0)
    seconds = time.process_time() - start
    one = judged(bt.Mesh(V[copies], faces.astype(np.int64)), lambda: uv)
    note = f"{atlas.chart_count} charts {one.note}".strip()
    return Outcome(one.valid, one.energy, seconds, note)


def report(found: Found, group: str) -> Iterator[str]:
    """Yield the table of a group, then what it says of the goals."""
    yield f"\n{group}: valid, median and largest symmetric Dirichlet energy of the valid, CPU\n"
    yield "| method | valid | median | largest | seconds |"
    yield "|---|---|---|---|---|"
    for (of, method), outcomes in found.items():
        if of == group:
            energies = _energies(outcomes)
            yield (
                f"| {method} | {len(energies)} of {len(outcomes)} | {_median(energies)} | "
                f"{max(energies, default=np.inf):.3g} | "
                f"{sum(one.seconds for one in outcomes.values()):.1f} |"
            )
    fixed, free = found[group, "beltrami auto"], found[group, "beltrami free"]
    valid = all(one.valid for one in (*fixed.values(), *free.values()))
    yield f"\ngoal, every map a certified bijection: {'met' if valid else 'MISSED'}"
    if group in FIXED_GOALS:
        median = _median([one.energy for one in fixed.values()])
        yield f"goal, fixed boundary, median <= {FIXED_GOALS[group]}: {median}"
    slim = found.get((group, f"libigl slim({SLIM_STEPS})"), {})
    for valid, words in ((True, "is valid"), (False, "is none, which is easier,")):
        ratios = [
            free[disk].energy / other.energy
            for disk, other in slim.items()
            if other.valid is valid and np.isfinite(other.energy)
        ]
        if ratios:
            yield (
                f"goal, free boundary, <= {SLIM_GOAL} x SLIM({SLIM_STEPS}) where that {words} on "
                f"{len(ratios)} disks: {np.median(ratios):.3f} median, {max(ratios):.3f} largest"
            )


def summary(found: Found) -> Iterator[str]:
    """Yield one table of all groups but the tubes: valid maps, and the median of each group."""
    groups = [group for group in FIXED_GOALS if (group, "beltrami auto") in found]
    yield f"\nall: valid maps, then median energy of the valid: {' / '.join(groups)}\n"
    yield "| method | valid | median energy |"
    yield "|---|---|---|"
    for method in dict.fromkeys(name for _, name in found):
        outcomes = [found.get((group, method), {}) for group in groups]
        energies = [_energies(those) for those in outcomes]
        yield (
            f"| {method} | {sum(map(len, energies))} of {sum(map(len, outcomes))} | "
            f"{' / '.join(map(_median, energies))} |"
        )


def _energies(outcomes: dict[str, Outcome]) -> list[float]:
    return [one.energy for one in outcomes.values() if one.valid]


def _median(energies: list[float]) -> str:
    return f"{np.median(energies):.3g}" if energies else "-"


def large(size: int) -> Iterator[str]:
    """Map a blob, cut to a disk and less one triangle, with the default method; yield lines."""
    bt = package("beltrami")
    bt.parameterize(bt.shapes.blob(1500))  # compile
    mesh = bt.shapes.blob(size)
    goal = f", goal {SECONDS_GOALS[size]:g} s" if size in SECONDS_GOALS else ""
    for kind, disk in (("cut", disk_of(mesh)), ("one triangle", less_one(mesh))):
        outcome = judged(disk, lambda disk=disk: bt.parameterize(disk, cut=False).uv)
        verdict = "a bijection" if outcome.valid else "NO bijection"
        yield (
            f"{kind}, {disk.n_vertices} vertices: {verdict}, energy {outcome.energy:.3g}, "
            f"{outcome.seconds:.1f} s of CPU{goal}"
        )


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mapping_suite", description=__doc__)
    parser.add_argument("disks", nargs="*", help="names of disks; all by default")
    parser.add_argument("--largest", type=int, default=50_000, help="vertices of a disk, at most")
    parser.add_argument("--slow", type=int, default=SLOW, help="likewise, for SLIM and xatlas")
    parser.add_argument("--details", action="store_true", help="print every map")
    parser.add_argument("--large", type=int, nargs="*", default=(), help="time such blobs instead")
    asked = parser.parse_args()
    for size in asked.large:
        for line in large(size):
            print(line, flush=True)
    if asked.large:
        return
    found: Found = {}
    for group, name, mesh in suite(asked.largest, asked.disks):
        for method, call in methods(mesh):
            if method in SLOW_PEERS and mesh.n_vertices > asked.slow:
                continue
            one = call()
            found.setdefault((group, method), {})[name] = one
            if asked.details:
                print(
                    f"{group}, {name}, {mesh.n_vertices} vertices, {method}: "
                    f"{'valid' if one.valid else 'INVALID'} {one.energy:.4g} {one.seconds:.2f} s "
                    f"{one.note}",
                    flush=True,
                )
    for group in GROUPS:
        if any(of == group for of, _ in found):
            print("\n".join(report(found, group)), flush=True)
    print("\n".join(summary(found)))


if __name__ == "__main__":
    main()
