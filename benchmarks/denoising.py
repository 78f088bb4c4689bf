"""Denoising without a parameter, against peers at the best parameter that knowing the truth finds.

python -m benchmarks.denoising [mesh ...] [--seeds 3] [--folder kept]  BENCHMARKS-DENOISING.md
python -m benchmarks.denoising --further data/meshes                    CGAL's meshes too
python -m benchmarks.denoising --faces 1000000 [--spikes 0.02]          one large mesh, printed

Noise is white, along the normals, of 0.1, 0.2 and 0.3 mean edge lengths; "Fandisk0.3" is a noisy
mesh with its truth, as published. Errors are the mean angle of the normals of the faces, in
degrees, and the root mean square distance of the vertices, in mean edge lengths. With a folder,
what was measured is kept there and not measured again: a run that was stopped goes on, and several
may share it.
"""

from __future__ import annotations

from benchmarks.threads import one_thread

if __name__ == "__main__":
    one_thread()  # before numpy is loaded

import argparse
import json
import os
import resource
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.cases import FOLDER_VARIABLE, plain, subdivided
from benchmarks.denoising_report import Case, OddCase, written
from benchmarks.noisy_meshes import (
    FURTHER,
    HELD_OUT,
    ODD,
    PAIR,
    TUNED,
    errors,
    is_there,
    noisy,
    odd_noise,
    pair,
    truth_of,
)
from benchmarks.packages import package
from benchmarks.smoothers import DEFAULT, peers

LEVELS = (0.1, 0.2, 0.3)
LITTLE = (0.02, 0.05)
REPORT = Path(__file__).parents[1] / "BENCHMARKS-DENOISING.md"
_LARGE, _VERY_LARGE = 15_000, 40_000  # vertices, from which there are two seeds, and one
_SMALL = 15_000  # vertices, up to which odd noise is tried too
Facts = dict[str, Any]


def kept(folder: Path | None, name: str, measure: Callable[[], Facts]) -> Facts:
    """Read what was measured before, or measure it and keep it."""
    if folder is None:
        return measure()
    path = folder / f"{name}.json"
    if not path.exists():
        partial = path.with_suffix(".partial")
        partial.write_text(json.dumps(measure()))
        partial.replace(path)
    facts: Facts = json.loads(path.read_text())
    return facts


def of_peers(truth: Any, mesh: Any) -> Facts:
    """Return the least errors of any peer at any parameter, and of any at its defaults."""
    tried, plainly = [], []
    for peer, value, call in peers(mesh):
        vertices = np.asarray(call(), dtype=np.float64)
        if np.isfinite(vertices).all():
            found = (*errors(truth, vertices), f"{peer} {value}")
            tried.append(found)
            if value == DEFAULT:
                plainly.append(found)
    return {
        "noisy": errors(truth, mesh.vertices),
        "angle": [min(tried)[0], min(tried)[2]],
        "distance": min([one[1], one[2]] for one in tried),
        "defaults": [min(one[0] for one in plainly), min(one[1] for one in plainly)],
    }


def of_ours(truth: Any, mesh: Any) -> Facts:
    """Return the errors of the blind choice, those of its best single filter, and the CPU time."""
    start = time.process_time()
    found = package("beltrami").denoise(mesh)
    seconds = time.process_time() - start
    return {
        "errors": errors(truth, found.mesh.vertices),
        "own": best_filter(truth, mesh),
        "seconds": seconds,
        "sigma": found.sigma / truth.edge_lengths.mean(),
        "warned": bool(found.warnings),
    }


def best_filter(truth: Any, mesh: Any, *, linear: bool = False) -> tuple[float, float]:
    """Return the least errors of the filters that are mixed, each alone, knowing the truth."""
    candidates = package("beltrami.diffusion.candidates")
    low = package("beltrami.diffusion.linear_filters")
    alike = low.LINEAR if mesh.is_closed else (*low.LINEAR, *low.AT_BORDERS)
    filters = alike if linear else (*alike, *low.IN_PARTS, *candidates.OF_NORMALS)
    bench = candidates.Bench.of(mesh)
    found = [errors(truth, x) for x in candidates.filtered(mesh, bench, filters)]
    return min(one[0] for one in found), min(one[1] for one in found)


def of_odd(truth: Any, mesh: Any) -> Facts:
    """Return the distances of the blind choice and of the best linear filter."""
    found = package("beltrami").denoise(mesh)
    return {
        "noisy": errors(truth, mesh.vertices)[1],
        "distance": errors(truth, found.mesh.vertices)[1],
        "linear": best_filter(truth, mesh, linear=True)[1],
        "warned": bool(found.warnings),
    }


def of_little(truth: Any) -> Facts:
    """Return what the blind choice does to the truth itself, and to it with little noise."""
    denoise = package("beltrami").denoise
    clean = denoise(truth)
    facts: Facts = {
        "clean": errors(truth, clean.mesh.vertices),
        "said": [bool(clean.warnings)],
        "levels": [],
    }
    for level in LITTLE:
        mesh = noisy(truth, level, 0)
        found = denoise(mesh)
        before, after = (errors(truth, one.vertices)[1] for one in (mesh, found.mesh))
        facts["said"].append(bool(found.warnings))
        facts["levels"].append({"level": level, "noisy": before, "distance": after})
    return facts


def measured(
    name: str,
    meshes: Path,
    folder: Path | None,
    seeds: int,
    levels: Sequence[float] = LEVELS,
    *,
    more: bool = True,
    odd_kinds: Sequence[str] = tuple(ODD),
) -> tuple[list[Case], list[OddCase], dict[str, Facts]]:
    """Measure one mesh at some levels, with little noise, and, if it is small, with odd noise.

    Without ``more`` only what the folder has is told.
    """

    def wanted(*names: str) -> bool:
        return more or (folder is not None and all((folder / f"{x}.json").exists() for x in names))

    if name == PAIR:
        truth, mesh = pair(meshes)
        facts = (
            kept(folder, f"{PAIR}-{one.__name__}", lambda one=one: one(truth, mesh))
            for one in (of_peers, of_ours)
        )
        return [Case(name, 0.3, truth.n_vertices, (tuple(facts),))], [], {}
    truth = truth_of(name, meshes)
    n = truth.n_vertices
    seeds = 1 if n > _VERY_LARGE else min(seeds, 2) if n > _LARGE else seeds
    cases, odd = [], []
    for level in levels:
        runs = []
        for seed in range(seeds):
            key = f"{name}-{level}-{seed}"
            if not wanted(f"{key}-of_peers", f"{key}-of_ours"):
                continue
            mesh = noisy(truth, level, seed)
            facts = (
                kept(folder, f"{key}-{one.__name__}",
                     lambda one=one, mesh=mesh: one(truth, mesh))
                for one in (of_peers, of_ours)
            )  # fmt: skip
            runs.append(tuple(facts))
        if runs:
            cases.append(Case(name, level, n, tuple(runs)))
    for kind in odd_kinds if n <= _SMALL else ():
        if not wanted(f"{name}-{kind}"):
            continue
        mesh = odd_noise(truth, kind, 0)
        facts = kept(folder, f"{name}-{kind}", lambda mesh=mesh: of_odd(truth, mesh))
        odd.append(OddCase(name, kind, facts))
    little: dict[str, Facts] = {}
    names = [f"{name}-{level}-0-of_peers" for level in LITTLE]
    if wanted(f"{name}-little", *names):
        facts = kept(folder, f"{name}-little", lambda: of_little(truth))
        peers = [
            kept(folder, key, lambda level=level: of_peers(truth, noisy(truth, level, 0)))
            for key, level in zip(names, LITTLE, strict=True)
        ]
        little[name] = {**facts, "peers": [one["distance"] for one in peers]}
    return cases, odd, little


def time_of(faces: int, spikes: float = 0.0) -> str:
    """Tell the time, the memory and the errors of a shape of about so many faces.

    So many of the vertices are off by a normal variable of one mean edge, upon the white noise.
    """
    bt = package("beltrami")
    arrays = subdivided(*subdivided(*plain(bt.shapes.blob(faces // 32))))
    truth = bt.Mesh(*arrays)
    mesh = spiked(noisy(truth, 0.2, 0), truth, spikes)
    small = bt.shapes.icosphere(4)
    bt.denoise(spiked(noisy(small, 0.2, 0), small, 0.05 if spikes else 0.0))  # compiles
    cpu, wall = time.process_time(), time.perf_counter()
    found = bt.denoise(mesh)
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    angle, distance = errors(truth, found.mesh.vertices)
    return (
        f"{truth.n_faces:,} faces: {cpu:.1f} s of one core, {wall:.1f} s, peak {peak:.2f} GiB; "
        f"{angle:.2f}°, {distance:.3f} mean edges, {len(found.spikes):,} spikes"
    )


def spiked(mesh: Any, truth: Any, share: float) -> Any:
    """Move a share of the vertices along the true normals by a normal variable of one mean edge."""
    random = np.random.default_rng(1)
    hit = random.random(mesh.n_vertices) < share
    away = truth.edge_lengths.mean() * hit * random.standard_normal(mesh.n_vertices)
    return mesh.with_vertices(mesh.vertices + away[:, None] * truth.vertex_normals)


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure, and write the report."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.denoising", description=__doc__)
    parser.add_argument("meshes", nargs="*", help=f"some of {PAIR}, {TUNED + HELD_OUT}")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--levels", type=float, nargs="+", default=LEVELS)
    parser.add_argument("--folder", type=Path, help="where what was measured is kept")
    parser.add_argument("--further", type=Path, help="where the meshes of CGAL's data are")
    parser.add_argument("--no-more", action="store_true", help="tell what the folder has")
    parser.add_argument("--output", type=Path, default=REPORT)
    parser.add_argument("--faces", type=int, help="time a mesh of so many, and nothing else")
    parser.add_argument("--spikes", type=float, default=0.0, help="share of its vertices that are")
    asked = parser.parse_args(arguments)
    if asked.faces:
        print(time_of(asked.faces, asked.spikes))
        return
    meshes = Path(os.environ.get(FOLDER_VARIABLE, ""))
    if asked.folder:
        asked.folder.mkdir(parents=True, exist_ok=True)
    cases: list[Case] = []
    odd: list[OddCase] = []
    little: dict[str, Facts] = {}
    missing = []
    for name in asked.meshes or (PAIR, *TUNED, *HELD_OUT):
        if not is_there(name, meshes):
            missing.append(name)
            continue
        print(name, flush=True)
        found = measured(
            name, meshes, asked.folder, asked.seeds, asked.levels, more=not asked.no_more
        )
        if not found[0]:
            missing.append(name)
        cases += found[0]
        odd += found[1]
        little |= found[2]
    further: list[Case] = []
    if asked.further:
        for name in (f"{one}.off" for one in FURTHER):
            if not is_there(name, asked.further):
                missing.append(name)
                continue
            print(name, flush=True)
            found = measured(
                name,
                asked.further,
                asked.folder,
                1,
                asked.levels,
                more=not asked.no_more,
                odd_kinds=(),
            )
            further += found[0]
            little |= found[2]
    asked.output.write_text(written(cases, odd, missing, further, little))
    print(f"wrote {asked.output}")


if __name__ == "__main__":
    main()
