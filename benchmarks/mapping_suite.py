"""Maps of disks to the plane, beside libigl, PyMeshLab and xatlas: valid, distorted, how long.

python -m benchmarks.mapping_suite [disk ...] [--largest 50000] [--slow 12000] [--details]
python -m benchmarks.mapping_suite --large SIZE ...     large blobs, and nothing else
python -m benchmarks.mapping_suite [--folder kept] --output BENCHMARKS-MAPS.md

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
import json
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.disks import GROUPS, suite
from benchmarks.mapping_report import (
    SECONDS_GOALS,
    SLIM,
    SLIM_STEPS,
    Found,
    Large,
    Outcome,
    written,
)
from benchmarks.packages import package
from benchmarks.surfaces import disk_of, less_one

SLOW = 12_000
KEPT = "maps.jsonl"
SLOW_PEERS = (SLIM, "xatlas")
OURS = ("auto", "free", "tutte", "least_squares_conformal", "spectral_conformal")

Array = NDArray[Any]


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

    def from_clamped() -> Array:
        return np.asarray(bt.parameterize(mesh, "auto", "clamped", cut=False).uv)

    for method in OURS:
        yield f"beltrami {method}", lambda method=method: judged(mesh, lambda: ours(method))
    yield "beltrami auto, clamped", lambda: judged(mesh, from_clamped)
    V, F = np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64)
    loop = np.array(mesh.boundary_loops[0])
    for name, call in _libigl(mesh, V, F, loop, kept):
        yield name, lambda call=call: judged(mesh, call)
    for name in ("harmonic", "least_squares_conformal_maps"):
        yield f"pymeshlab {name}", lambda name=name: judged(mesh, lambda: _pymeshlab(V, F, name))
    yield "xatlas", lambda: _xatlas(V, F)


def _libigl(
    mesh: Any, V: Array, F: Array, loop: Array, kept: dict[str, Array]
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
    if "auto" not in kept:  # it was measured before
        kept["auto"] = package("beltrami").parameterize(mesh, cut=False).uv
    yield SLIM, slim


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


def large(size: int) -> Iterator[Large]:
    """Map a blob, cut to a disk and less one triangle, with the default method."""
    bt = package("beltrami")
    compiled()
    mesh = bt.shapes.blob(size)
    for kind, disk in (("cut", disk_of(mesh)), ("one triangle", less_one(mesh))):
        outcome = judged(disk, lambda disk=disk: bt.parameterize(disk, cut=False).uv)
        yield Large(kind, size, disk.n_vertices, outcome)


def compiled() -> None:
    """Make a map by each method of ours, so that the seconds of none hold those of compiling."""
    bt = package("beltrami")
    mesh = less_one(bt.shapes.blob(6000))  # large enough to be mapped after a coarser one
    for method in OURS:
        bt.parameterize(mesh, method, cut=False, strict=False)


def measured(asked: argparse.Namespace) -> Found:
    """Make all maps that are not kept from a run before, and keep each one."""
    compiled()
    found: Found = {}
    file = None if asked.folder is None else asked.folder / KEPT
    known = read_kept(file)
    for group, name, mesh in suite(asked.largest, asked.disks):
        for method, call in methods(mesh):
            if method in SLOW_PEERS and mesh.n_vertices > asked.slow:
                continue
            one = known.get((group, name, method))
            if one is None:
                one = call()
                keep(file, (group, name, method), one)
            found.setdefault((group, method), {})[name] = one
            if asked.details:
                print(
                    f"{group}, {name}, {mesh.n_vertices} vertices, {method}: "
                    f"{'valid' if one.valid else 'INVALID'} {one.energy:.4g} {one.seconds:.2f} s "
                    f"{one.note}",
                    flush=True,
                )
    return found


def read_kept(file: Path | None) -> dict[tuple[str, str, str], Outcome]:
    """Return what was kept: by group, disk and method."""
    if file is None or not file.exists():
        return {}
    rows = [json.loads(line) for line in file.read_text().splitlines()]
    return {(group, name, method): Outcome(**one) for group, name, method, one in rows}


def keep(file: Path | None, key: tuple[str, str, str], one: Outcome) -> None:
    """Add a line to the file, if there is one."""
    if file is not None:
        file.parent.mkdir(parents=True, exist_ok=True)
        with file.open("a") as stream:
            stream.write(json.dumps([*key, asdict(one)]) + "\n")


def main() -> None:
    """Print the report, or write it."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mapping_suite", description=__doc__)
    parser.add_argument("disks", nargs="*", help="names of disks; all by default")
    parser.add_argument("--largest", type=int, default=50_000, help="vertices of a disk, at most")
    parser.add_argument("--slow", type=int, default=SLOW, help="likewise, for SLIM and xatlas")
    parser.add_argument("--details", action="store_true", help="print every map")
    parser.add_argument("--large", type=int, nargs="*", help="sizes of large blobs; with --output "
                        "those that have goals, if this is not said")  # fmt: skip
    parser.add_argument("--folder", type=Path, help="keep what is measured there, and go on")
    parser.add_argument("--output", type=Path, help="write the report there")
    asked = parser.parse_args()
    sizes = asked.large
    if sizes is None:
        sizes = list(SECONDS_GOALS) if asked.output else []
    found = measured(asked) if asked.output or not sizes else {}
    text = written(found, [one for size in sizes for one in large(size)], GROUPS)
    if asked.output is None:
        print(text)
    else:
        asked.output.write_text(text)


if __name__ == "__main__":
    main()
