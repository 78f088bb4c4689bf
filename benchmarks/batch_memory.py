"""Estimates of memory beside what the steps of a batch need: python -m benchmarks.batch_memory.

python -m benchmarks.batch_memory [--vertices 150000] [step ...]

Each step runs on a closed surface in a process that has run it before on a small one; the peak is
that of the process. An estimate has to be above the measured number, and not above three times it
where that is much.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass

from benchmarks.memory import forget_peak, status
from benchmarks.threads import one_thread

STEPS = (
    "diagnose",
    "repair",
    "smooth",
    "smooth method=implicit time=0.001",
    "smooth method=curvature_flow time=0.001 steps=2",
    "smooth method=bilateral_normals",
    "denoise",
    "integrate",
    "curvature",
    "laplacian",
    "laplacian weights=intrinsic_delaunay",
    "spectrum k=16",
    "spectrum k=100",
    "spectrum k=64, descriptors",
    "compress",
    "write",
    "parameterize",
)


@dataclass(frozen=True)
class Measured:
    """Bytes of the whole process at the peak, and what was estimated."""

    step: str
    peak: int
    estimate: int

    @property
    def ratio(self) -> float:
        """How much is estimated for each byte that is needed."""
        return self.estimate / self.peak


def measure(step: str, vertices: int) -> Measured:
    """Run a step on a small and on a large blob."""
    import tempfile
    from pathlib import Path

    import beltrami as bt
    from beltrami.batch.pipeline import as_pipeline
    from beltrami.batch.verb import Scene, Size

    pipeline = as_pipeline(step)
    with tempfile.TemporaryDirectory() as folder:
        for size in (1000, vertices):
            mesh = bt.shapes.blob(size)
            scene = Scene(bt.Mesh(mesh.vertices, mesh.faces))
            forget_peak()
            for one in pipeline.steps:
                told = one.verb.run(scene, one.options)
                if told.write is not None:
                    told.write(Path(folder, f"whole{told.suffix}"))
                scene = told.scene
            peak = status("VmHWM")
    return Measured(step, peak, pipeline.estimate(Size(mesh.n_vertices, mesh.n_faces))[0])


def main(arguments: Sequence[str] | None = None) -> None:
    one_thread()
    parser = argparse.ArgumentParser(prog="python -m benchmarks.batch_memory")
    parser.add_argument("steps", nargs="*", default=STEPS)
    parser.add_argument("--vertices", type=int, default=150_000)
    asked = parser.parse_args(arguments)
    print("| step | peak, MB | estimate, MB | ratio |\n|---|---|---|---|", flush=True)
    for step in asked.steps:
        one = measure(step, asked.vertices)
        print(
            f"| {step} | {one.peak / 1e6:.0f} | {one.estimate / 1e6:.0f} | {one.ratio:.2f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
