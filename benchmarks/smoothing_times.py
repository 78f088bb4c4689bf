"""How long smoothing takes, beside every peer that has the method.

python -m benchmarks.smoothing_times [mesh ...] [--output BENCHMARKS-SMOOTHING.md]

The same rounds or steps for everybody, from arrays of vertices and faces to arrays of vertices;
what a library prepares is counted, because smoothing is called once. CPU seconds of all threads,
the median of some calls; everyone in each round, in another order each time. The rounds of 50 with
the operator given are in BENCHMARKS.md.
"""

from __future__ import annotations

from benchmarks.threads import one_thread

if __name__ == "__main__":
    one_thread()  # before numpy is loaded

import argparse
import os
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from benchmarks.cases import FOLDER_VARIABLE
from benchmarks.claims import Contender, Row
from benchmarks.harness import Measured, in_turn, untimed
from benchmarks.machine import facts
from benchmarks.noisy_meshes import PAIR, noisy, pair, truth_of
from benchmarks.packages import package, versions
from benchmarks.report import grid

MESHES = (PAIR, "blob 134k", "igea")
Call = Callable[[], Any]
HEAD = """# Benchmarks of smoothing

Written by `python -m benchmarks.smoothing_times --output BENCHMARKS-SMOOTHING.md` with one thread.
The same rounds or steps for everybody, from arrays of vertices and faces to arrays of vertices;
what a library prepares is counted, because smoothing is called once. CPU seconds, everyone once
in each round, the rounds in different orders. Below 1 we are the fastest. Filters of normals differ
in their weights (bilateral here, "two steps" in PyMeshLab): the number of rounds is the same, not
the result.
"""


def mesh_of(name: str, folder: Path) -> Any:
    """Return a noisy mesh."""
    bt = package("beltrami")
    if name == PAIR:
        return pair(folder)[1]
    if name == "igea":
        read = bt.read_mesh(folder / "igea.ply")
        return noisy(bt.Mesh(read.vertices, read.faces), 0.2, 0)
    if name.startswith("blob"):
        return noisy(bt.shapes.blob(134_000), 0.2, 0)
    return noisy(truth_of(name, folder), 0.2, 0)


def contenders(mesh: Any) -> Iterator[tuple[str, str, Call]]:
    """Yield (work, library, call), ours first in each work."""
    bt, trimesh = package("beltrami"), package("trimesh")
    pyvista, pymeshlab, igl = package("pyvista"), package("pymeshlab"), package("igl")
    smoothing = package("trimesh.smoothing")
    V, F = np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64)
    edge = float(mesh.edge_lengths.mean())

    def ours(method: str, **options: Any) -> Any:
        return bt.smooth_mesh(bt.Mesh(V, F), method, **options).vertices

    def of_trimesh(name: str, **options: Any) -> Any:
        one = trimesh.Trimesh(V.copy(), F.copy(), process=False)
        return np.array(getattr(smoothing, name)(one, **options).vertices)

    def of_pyvista(name: str, **options: Any) -> Any:
        return np.array(getattr(pyvista.PolyData.from_regular_faces(V, F), name)(**options).points)

    def of_pymeshlab(name: str, **options: Any) -> Any:
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(V, F.astype(np.int32)))
        getattr(meshes, f"apply_coord_{name}_smoothing")(**options)
        return meshes.current_mesh().vertex_matrix()

    def of_igl(times: int) -> Any:
        L, M = igl.cotmatrix(V, F), igl.massmatrix(V, F, igl.MASSMATRIX_TYPE_VORONOI)
        solver = package("scipy.sparse.linalg").splu((M - edge**2 / times * L).tocsc())
        X = V
        for _ in range(times):
            X = solver.solve(M @ X)
        return X

    yield "averaging, 10 rounds", "beltrami", partial(ours, "averaging", steps=10)
    yield ("averaging, 10 rounds", "trimesh",
           partial(of_trimesh, "filter_laplacian", iterations=10, lamb=1.0,
                   volume_constraint=False))  # fmt: skip
    yield ("averaging, 10 rounds", "PyVista",
           partial(of_pyvista, "smooth", n_iter=10, relaxation_factor=1.0))  # fmt: skip
    yield ("averaging, 10 rounds", "PyMeshLab",
           partial(of_pymeshlab, "laplacian", stepsmoothnum=10, cotangentweight=False))  # fmt: skip
    yield "Taubin, 10 pairs of rounds", "beltrami", partial(ours, "taubin", steps=10)
    yield ("Taubin, 10 pairs of rounds", "trimesh",
           partial(of_trimesh, "filter_taubin", iterations=20))  # fmt: skip
    yield ("Taubin, 10 pairs of rounds", "PyMeshLab",
           partial(of_pymeshlab, "taubin", stepsmoothnum=10))  # fmt: skip
    yield "windowed sinc, degree 20", "beltrami", partial(ours, "windowed_sinc", steps=20)
    yield "windowed sinc, degree 20", "PyVista", partial(of_pyvista, "smooth_taubin", n_iter=20)
    flow = {"time": edge**2}
    yield "implicit fairing, 1 step", "beltrami", partial(ours, "implicit", steps=1, **flow)
    yield "implicit fairing, 1 step", "libigl, SuperLU", partial(of_igl, 1)
    yield "implicit fairing, 10 steps", "beltrami", partial(ours, "implicit", steps=10, **flow)
    yield "implicit fairing, 10 steps", "libigl, SuperLU", partial(of_igl, 10)
    work = "normals, 20 rounds, then positions, 20"
    yield work, "beltrami, bilateral", partial(ours, "bilateral_normals", steps=20)
    yield (work, "PyMeshLab, two steps",
           partial(of_pymeshlab, "two_steps", stepsmoothnum=1, stepnormalnum=20,
                   stepfitnum=20))  # fmt: skip


def table(mesh: Any, rounds: int) -> str:
    """Time everybody once in each round, the rounds in different orders; write the table."""
    works = list(contenders(mesh))
    everybody = [Contender(library, lambda _, call=call: call()) for _, library, call in works]
    for one in everybody:
        untimed(one)  # compiles
    row = Row("smoothing", "smoothing", lambda _: everybody, (), clock=process_time)
    found: dict[str, list[Measured]] = {}
    timed = in_turn(row, [Measured(one) for one in everybody], rounds)
    for (work, *_), one in zip(works, timed, strict=True):
        found.setdefault(work, []).append(one)
    rows = []
    for work, (mine, *others) in found.items():
        told = [f"{one.contender.name} {one.problem or f'{one.median:.4f}'}" for one in others]
        best = min((one for one in others if one.seconds), key=lambda one: one.median)
        ratio = f"{mine.median / best.median:.2f} x {best.contender.name}"
        rows.append([work, f"{mine.median:.4f}", ", ".join(told), ratio])
    return grid(("work", "ours, s", "peers, s", "ratio to the fastest"), rows)


def written(meshes: Sequence[str], rounds: int) -> Iterator[str]:
    """Yield the parts of the report, a table for each mesh."""
    yield f"{HEAD}\nMedians of {rounds} calls."
    for name in meshes:
        mesh = mesh_of(name, Path(os.environ.get(FOLDER_VARIABLE, "")))
        yield f"\n## {name}, {mesh.n_vertices:,} vertices\n\n{table(mesh, rounds)}"
    yield f"\n## Where and when\n\n{grid(('', ''), facts())}"
    yield f"\n## Versions\n\n{grid(('', ''), versions())}"


def main() -> None:
    """Print the report, or write it."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.smoothing_times",
                                     description=__doc__)  # fmt: skip
    parser.add_argument("meshes", nargs="*", default=MESHES)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--output", type=Path)
    asked = parser.parse_args()
    parts = []
    for part in written(asked.meshes, asked.rounds):
        print(part, flush=True)
        parts.append(part)
    if asked.output:
        asked.output.write_text("\n".join(parts) + "\n")


if __name__ == "__main__":
    main()
