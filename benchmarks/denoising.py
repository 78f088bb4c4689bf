"""Denoising without a parameter, against peers at the best parameter that knowing the truth finds.

python -m benchmarks.denoising [mesh ...] [--seeds 3]
python -m benchmarks.denoising --faces 1000000    the time of one large mesh alone

Noise is white, along the normals, of 0.1, 0.2 and 0.3 mean edge lengths; "Fandisk0.3" is a noisy
mesh with its truth, as published. Errors are the mean angle of the normals of the faces, in
degrees, and the root mean square distance of the vertices, in mean edge lengths. Meshes that the
constants of ``denoise`` were chosen on, and meshes that they were not, are told apart.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.cases import FOLDER_VARIABLE, plain, subdivided
from benchmarks.packages import package
from benchmarks.smoothers import peers

LEVELS = (0.1, 0.2, 0.3)
PAIR = "Fandisk0.3"
TUNED = ("blob", "cube", "spot", "fertility", "fandisk", "sphere", "torus", "camel", "pial",
         "ellipsoid")  # fmt: skip
HELD_OUT = ("bumps", "octahedron", "can", "saddle",
            "beetle", "face", "conte69", "bunny", "armadillo")  # fmt: skip
FILES = {
    "spot": "spot_triangulated.obj",
    "fertility": "fertility.off",
    "fandisk": "Fandisk0.3/Original.obj",
    "torus": "torus.obj",
    "camel": "camel-head.off",
    "bunny": "bun_zipper.ply",
    "pial": "pial_left.gii.gz",
    "armadillo": "armadillo.obj",
    "beetle": "beetle.obj",
    "face": "face.obj",
    "conte69": "conte69_32k_lh.gii",
}
SHAPES: dict[str, Callable[[Any], Any]] = {
    "blob": lambda shapes: shapes.blob(8000),
    "cube": lambda shapes: shapes.cube(32),
    "sphere": lambda shapes: shapes.icosphere(5),
    "ellipsoid": lambda shapes: _stretched(shapes.icosphere(4)),
    "bumps": lambda shapes: _bumpy(shapes.icosphere(5)),
    "octahedron": lambda shapes: _cut_in_four(shapes.octahedron(), 5),
    "can": lambda shapes: shapes.cylinder(90, 40, caps=True),
    "saddle": lambda shapes: _bent(shapes.grid(60, 60, dimension=3)),
}


def _stretched(sphere: Any) -> Any:
    return sphere.with_vertices(sphere.vertices * [1, 1.7, 0.6])


def _cut_in_four(mesh: Any, times: int) -> Any:
    arrays = plain(mesh)
    for _ in range(times):
        arrays = subdivided(*arrays)
    return package("beltrami").Mesh(*arrays)


def _bent(grid: Any) -> Any:
    x, y, _ = grid.vertices.T
    height = (x - x.mean()) ** 2 - (y - y.mean()) ** 2
    return grid.with_vertices(np.stack([x, y, height], axis=1))


def _bumpy(sphere: Any) -> Any:
    x, y, z = 5 * sphere.vertices.T
    height = np.sin(x + 1) * np.sin(y) + np.cos(y - z)
    return sphere.with_vertices(sphere.vertices * (1 + 0.06 * height)[:, None])


def truth_of(name: str, folder: Path) -> Any:
    bt = package("beltrami")
    if name in SHAPES:
        return SHAPES[name](bt.shapes)
    read = bt.read_mesh(folder / FILES[name])
    fixed = bt.repair(read, remove_unreferenced=True, remove_degenerate_faces=True).mesh
    return bt.Mesh(fixed.vertices, fixed.faces)


def noisy(truth: Any, level: float, seed: int) -> Any:
    sigma = level * truth.edge_lengths.mean()
    noise = np.random.default_rng([seed, int(1000 * level)]).normal(0, sigma, truth.n_vertices)
    return truth.with_vertices(truth.vertices + noise[:, None] * truth.vertex_normals)


def errors(truth: Any, vertices: Any) -> tuple[float, float]:
    """Mean angle of the normals in degrees, and distance of the vertices in mean edges."""
    normals = truth.with_vertices(vertices).face_normals
    cosine = np.clip(np.einsum("ij,ij->i", normals, truth.face_normals), -1, 1)
    away = ((vertices - truth.vertices) ** 2).sum(axis=1)
    angle = float(np.degrees(np.arccos(cosine)).mean())
    return angle, float(np.sqrt(away.mean()) / truth.edge_lengths.mean())


def row(name: str, level: float, truth: Any, meshes: list[Any]) -> tuple[str, Any]:
    """Measure one mesh and level over the seeds; the line, and the two ratios of each seed."""
    bt = package("beltrami")
    ours, ratios, seconds, chosen = [], [], 0.0, ("", "")
    for mesh in meshes:
        start = time.process_time()
        found = bt.denoise(mesh)
        seconds += (time.process_time() - start) / len(meshes)
        ours.append(errors(truth, found.mesh.vertices))
        tried = []
        for peer, value, call in peers(mesh):
            vertices = np.asarray(call(), dtype=np.float64)
            if np.isfinite(vertices).all():
                tried.append((*errors(truth, vertices), f"{peer} {value}"))
        by_angle, by_distance = min(tried), min(tried, key=lambda one: one[1])
        ratios.append((ours[-1][0] / by_angle[0], ours[-1][1] / by_distance[1]))
        chosen = f"{by_angle[0]:.2f}° {by_angle[2]}", f"{by_distance[1]:.3f} {by_distance[2]}"
    start_errors = errors(truth, meshes[0].vertices)
    mean = np.mean(ours, axis=0)
    spread = np.std(ratios, axis=0) * 1.96 / np.sqrt(len(ratios))
    ratio = np.mean(ratios, axis=0)
    text = (
        f"| {name} {level:g} | {start_errors[0]:.1f}° {start_errors[1]:.2f} | {mean[0]:.2f}° "
        f"{mean[1]:.3f} | {chosen[0]} | {chosen[1]} | {ratio[0]:.2f} ± {spread[0]:.2f} | "
        f"{ratio[1]:.2f} ± {spread[1]:.2f} | {seconds:.1f} s |"
    )
    return text, ratio


def time_of(faces: int) -> None:
    """Print the CPU time and the errors of a shape of at least so many faces."""
    bt = package("beltrami")
    arrays = plain(bt.shapes.blob(30_000))
    while len(arrays[1]) < faces:
        arrays = subdivided(*arrays)
    truth = bt.Mesh(*arrays)
    mesh = noisy(truth, 0.2, 0)
    start = time.process_time()
    found = bt.denoise(mesh)
    seconds = time.process_time() - start
    angle, distance = errors(truth, found.mesh.vertices)
    print(f"{truth.n_faces} faces: {seconds:.1f} s, {angle:.2f}°, {distance:.3f}")


def main() -> None:
    """Print the table, mesh by mesh, and the medians."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.denoising", description=__doc__)
    parser.add_argument("meshes", nargs="*", help=f"some of {PAIR}, {TUNED + HELD_OUT}")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--faces", type=int, help="time a mesh of so many, and nothing else")
    asked = parser.parse_args()
    if asked.faces:
        time_of(asked.faces)
        return
    folder = Path(os.environ.get(FOLDER_VARIABLE, ""))
    known = [
        name for name in (*TUNED, *HELD_OUT) if name in SHAPES or (folder / FILES[name]).exists()
    ]
    bt = package("beltrami")
    print("| mesh, noise | noisy | denoise, blind | best peer by angle | best peer by distance "
          "| ratio of angles | ratio of distances | CPU |")  # fmt: skip
    print("|---|---|---|---|---|---|---|---|")
    if (folder / PAIR).exists() and (not asked.meshes or PAIR in asked.meshes):
        truth, mesh = (bt.read_mesh(folder / PAIR / f"{one}.obj") for one in ("Original", "Noisy"))
        print(row(PAIR, 0.3, truth, [mesh])[0], flush=True)
    for kind, group in (("tuned on", TUNED), ("held out", HELD_OUT)):
        ratios = []
        for name in [one for one in group if one in known and one in (asked.meshes or known)]:
            truth = truth_of(name, folder)
            for level in LEVELS:
                meshes = [noisy(truth, level, seed) for seed in range(asked.seeds)]
                text, ratio = row(name, level, truth, meshes)
                ratios.append(ratio)
                print(text, flush=True)
        if ratios:
            middle, worst = np.median(ratios, axis=0), np.max(ratios, axis=0)
            print(f"\n{kind}: angles {middle[0]:.2f} median, {worst[0]:.2f} worst; distances "
                  f"{middle[1]:.2f} median, {worst[1]:.2f} worst\n", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
