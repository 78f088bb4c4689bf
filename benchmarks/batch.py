"""Many dirty meshes: one worker against two, what scheduling costs, what a million would take.

python -m benchmarks.batch [--meshes 1000] [--workers 1 2] [--folder FOLDER] [--seed 7]

The meshes are blobs of 1,000 to 8,000 vertices, each scaled and roughened in its own way, with
defects: stray vertices, faces twice, faces without area, faces turned over, cracks. One in
a hundred is cut off in the middle of the file, and has to fail.
"""

from __future__ import annotations

import argparse
import json
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.threads import one_thread

STEPS = "repair, laplacian, spectrum k=64, descriptors count=16"
SIZES = (1_000, 2_000, 3_000, 5_000, 8_000)
CUT_OFF = 100  # one in so many


@dataclass(frozen=True)
class Run:
    """A run, and where its time went, in seconds.

    ``busy`` is the processor in the steps; ``of_client`` in the process of the client and of the
    scheduler, ``of_workers`` in the workers, what they need to start included.
    """

    workers: int
    done: int
    failed: int
    wall: float
    busy: float
    of_client: float
    of_workers: float
    steps: dict[str, float]

    @property
    def meshes(self) -> int:
        """How many meshes."""
        return self.done + self.failed

    @property
    def overhead(self) -> float:
        """Seconds of the processor for each mesh that are not of its steps: all processes."""
        return (self.of_workers + self.of_client - self.busy) / self.meshes


def dirty(mesh: Any, random: Any) -> Any:
    """Return a mesh of its own, with a handful of every defect."""
    import numpy as np

    import beltrami as bt

    n, m = mesh.n_vertices, mesh.n_faces
    rough = 0.02 * mesh.edge_lengths.mean() * random.normal(size=(n, 3))
    x = mesh.vertices * random.uniform(0.5, 2.0, 3) + rough
    faces = mesh.faces.copy()
    turned = random.choice(m, 5, replace=False)
    faces[turned] = faces[turned][:, ::-1]
    torn = random.choice(m, 5, replace=False)  # these get vertices of their own, at the same places
    x = np.concatenate([x, x[faces[torn].ravel()]])
    faces[torn] = n + np.arange(15).reshape(5, 3)
    twice = faces[random.choice(m, 3, replace=False)]
    flat = np.repeat(random.choice(n, 3, replace=False)[:, None], 3, axis=1)
    stray = random.normal(size=(5, 3))
    return bt.Mesh(np.concatenate([x, stray]), np.concatenate([faces, twice, flat]))


def write_meshes(folder: Path, count: int, seed: int) -> None:
    """Write the meshes, as binary PLY; those of earlier runs with the same seed stay."""
    import numpy as np

    import beltrami as bt

    blobs = [bt.shapes.blob(size) for size in SIZES]
    for i in range(count):
        path = folder / f"{seed}-{i:06}.ply"
        if path.exists():
            continue
        random = np.random.default_rng([seed, i])
        mesh = dirty(blobs[i % len(blobs)], random)
        content = ply(mesh)
        path.write_bytes(content[: len(content) // 2] if i % CUT_OFF == CUT_OFF - 1 else content)


def ply(mesh: Any) -> bytes:
    """Return a binary PLY file: bytes, to be cut off."""
    import numpy as np

    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {mesh.n_vertices}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {mesh.n_faces}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.empty(mesh.n_faces, dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, mesh.faces
    return head.encode() + mesh.vertices.astype("<f8").tobytes() + faces.tobytes()


def run(folder: Path, out: Path, workers: int) -> Run:
    """Run the pipeline, and add up what the manifest says of the time."""
    import beltrami as bt

    before = spent()
    found = bt.run_batch(str(folder), STEPS, out, workers=workers)
    client, children = (now - then for now, then in zip(spent(), before, strict=True))
    lines = [json.loads(line) for line in (out / found.manifest).read_text("utf-8").splitlines()]
    steps: dict[str, float] = {}
    for line in lines[1:]:
        for label, seconds in line.get("seconds", {}).items():
            steps[label] = steps.get(label, 0.0) + seconds
    state = found.state
    busy = sum(steps.values())
    counts = max(workers, 1), state.done, state.failed
    return Run(*counts, state.seconds, busy, client, children, steps)


def spent() -> tuple[float, float]:
    """Return the seconds of the processor of this process, and of its children that have ended."""
    times = os.times()
    return times.user + times.system, times.children_user + times.children_system


def report(runs: list[Run], again: Run) -> str:
    """Return the tables."""
    lines = [
        "| workers | meshes/s | done | failed | wall, s | CPU in the steps, s | of workers, s | "
        "of client and scheduler, s | CPU beside the steps, ms/mesh |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for one in runs:
        rate = one.meshes / one.wall
        lines.append(
            f"| {one.workers} | {rate:.2f} | {one.done} | {one.failed} | {one.wall:.1f} | "
            f"{one.busy:.1f} | {one.of_workers:.1f} | {one.of_client:.1f} | "
            f"{1000 * one.overhead:.1f} |"
        )
    first, last = runs[0], runs[-1]
    meshes = first.meshes
    known = 1000 * again.wall / meshes
    lines += [
        "",
        f"{last.workers} workers are {first.wall / last.wall:.2f} times as fast as "
        f"{first.workers}. Where all is known already, a run takes {known:.1f} ms/mesh.",
        "",
        "| step | ms/mesh |",
        "|---|---|",
    ]
    lines += [f"| {label} | {1000 * s / meshes:.1f} |" for label, s in first.steps.items()]
    hours = 1e6 * (first.busy / meshes + first.overhead) / 3600
    lines += ["", f"A million such meshes: {hours:.0f} hours of one core, {hours / 64:.1f} of 64."]
    return "\n".join(lines)


def main(arguments: list[str] | None = None) -> None:
    one_thread()
    parser = argparse.ArgumentParser(prog="python -m benchmarks.batch")
    parser.add_argument("--meshes", type=int, default=1000)
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--folder", type=Path, help="where the meshes are kept")
    parser.add_argument("--seed", type=int, default=7)
    asked = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as place:
        folder = asked.folder or Path(place, "meshes")
        folder.mkdir(parents=True, exist_ok=True)
        write_meshes(folder, asked.meshes, asked.seed)
        runs = [run(folder, Path(place, f"out-{count}"), count) for count in asked.workers]
        again = run(folder, Path(place, f"out-{asked.workers[-1]}"), asked.workers[-1])
        print(report(runs, again))


if __name__ == "__main__":
    main()
