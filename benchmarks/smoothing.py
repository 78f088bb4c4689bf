"""The smoothing methods beside those of peers: error and time, at defaults and at the best.

python -m benchmarks.smoothing [mesh ...] [--seeds 3] [--level 0.2]

Meshes and noise are those of ``benchmarks.noisy_meshes``. For each filter: the errors at its
defaults, the least of each at any parameter, found knowing the truth, both with 95 % confidence
over the seeds ("Fandisk0.3" has one, as published), and the CPU time of all threads of one call
with defaults, from arrays.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.cases import FOLDER_VARIABLE
from benchmarks.noisy_meshes import FILES, PAIR, SHAPES, errors, noisy, truth_of
from benchmarks.packages import package
from benchmarks.smoothers import DEFAULT, own, peers

CLOSED = ("blob", "cube", "spot", "fertility", "fandisk", "sphere", "torus")
_CALLS = 3  # of which the fastest counts
Errors = list[tuple[float, float]]


def measure(truth: Any, meshes: list[Any]) -> list[tuple[str, Errors, Errors, float]]:
    """Return each filter, its errors at defaults and least errors for each mesh, and seconds."""
    defaults: dict[str, Errors] = {}
    best: dict[str, Errors] = {}
    seconds: dict[str, float] = {}
    for mesh in meshes:
        found: dict[str, Errors] = {}
        for name, value, call in (*own(mesh), *peers(mesh)):
            vertices = np.asarray(call(), dtype=np.float64)
            if not np.isfinite(vertices).all():
                continue
            both = errors(truth, vertices)
            found.setdefault(name, []).append(both)
            if value == DEFAULT:
                defaults.setdefault(name, []).append(both)
                seconds.setdefault(name, fastest(call))
        for name, tried in found.items():
            least = tuple(np.min(tried, axis=0).tolist())
            best.setdefault(name, []).append((least[0], least[1]))
    return [(name, defaults[name], best[name], seconds[name]) for name in defaults]


def fastest(call: Callable[[], Any]) -> float:
    """Return the least CPU time of some calls."""
    times = []
    for _ in range(_CALLS):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return min(times)


def told(values: Errors) -> list[str]:
    """Write the mean angle and distance, with confidence intervals where there are seeds."""
    mean, spread = np.mean(values, axis=0), np.std(values, axis=0, ddof=len(values) > 1)
    half = 1.96 * spread / np.sqrt(len(values))
    if len(values) == 1:
        return [f"{mean[0]:.2f}°", f"{mean[1]:.3f}"]
    return [f"{mean[0]:.2f}° ± {half[0]:.2f}", f"{mean[1]:.3f} ± {half[1]:.3f}"]


def main() -> None:
    """Print a table for each mesh."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.smoothing", description=__doc__)
    parser.add_argument("meshes", nargs="*", help=f"some of {PAIR}, {CLOSED}, or any of denoising")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--level", type=float, default=0.2, help="of noise, in mean edges")
    asked = parser.parse_args()
    folder = Path(os.environ.get(FOLDER_VARIABLE, ""))
    bt = package("beltrami")
    for name in asked.meshes or (PAIR, *CLOSED):
        if name == PAIR and (folder / PAIR).exists():
            truth, one = (bt.read_mesh(folder / PAIR / f"{x}.obj") for x in ("Original", "Noisy"))
            level, meshes = 0.3, [one]
        elif name in SHAPES or (name in FILES and (folder / FILES[name]).exists()):
            level, truth = asked.level, truth_of(name, folder)
            meshes = [noisy(truth, level, seed) for seed in range(asked.seeds)]
        else:
            print(f"{name} is not there: {FOLDER_VARIABLE} names the folder of meshes\n")
            continue
        before = told([errors(truth, mesh.vertices) for mesh in meshes])
        print(f"\n{name}, {truth.n_vertices} vertices, noise of {level:g} mean edges: "
              f"{before[0]}, {before[1]}\n")  # fmt: skip
        print("| filter | defaults: angle | distance | best: angle | distance | CPU, defaults |")
        print("|---|---|---|---|---|---|")
        for filter_, plain, least, seconds in measure(truth, meshes):
            cells = [filter_, *told(plain), *told(least), f"{1000 * seconds:.1f} ms"]
            print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
