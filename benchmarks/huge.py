"""One huge mesh: time and peak memory of each stage, on one core.

python -m benchmarks.huge [--faces 10000000] [--spectrum 0] [--modes 32] [--folder FOLDER]

A wavy sphere of about so many faces is written as binary PLY, and then, in a process of its own,
read, diagnosed, smoothed (10 rounds of averaging) and rendered. ``--spectrum`` is the number of
vertices of another one, of which the first modes are computed. The peaks are of the whole process.
"""

from __future__ import annotations

import argparse
import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks.fresh import ROOT
from benchmarks.memory import forget_peak, status
from benchmarks.threads import one_thread


def write_sphere(path: Path, faces: int) -> None:
    """Write a sphere of rings with waves on it, ring by ring, so that it needs no memory."""
    import numpy as np

    around = max(3, round(math.sqrt(faces)))
    rings = max(1, round(faces / (2 * around)))
    n, m = around * rings + 2, 2 * around * rings
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {n}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {m}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    kind = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
    turn = np.arange(around)
    after = (turn + 1) % around
    phi = 2 * np.pi * turn / around

    def rows(*corners: Any) -> bytes:
        block = np.empty(len(corners[0]), kind)
        block["count"], block["corners"] = 3, np.stack(corners, axis=1)
        return block.tobytes()

    with path.open("wb") as file:
        file.write(head.encode())
        for ring in range(rings):
            theta = math.pi * (ring + 1) / (rings + 1)
            radius = 1 + 0.05 * np.sin(9 * phi) * math.sin(theta) ** 2 * math.cos(7 * theta)
            x = radius * math.sin(theta) * np.cos(phi)
            y = radius * math.sin(theta) * np.sin(phi)
            z = radius * math.cos(theta)
            file.write(np.stack([x, y, z], axis=1).astype("<f8").tobytes())
        file.write(np.array([[0, 0, 1.0], [0, 0, -1.0]]).astype("<f8").tobytes())
        top, bottom, last = n - 2, n - 1, around * (rings - 1)
        file.write(rows(np.full(around, top), turn, after))
        for ring in range(rings - 1):
            low = around * ring
            high = low + around
            file.write(rows(low + turn, high + turn, high + after))
            file.write(rows(low + turn, high + after, low + after))
        file.write(rows(np.full(around, bottom), last + after, last + turn))


def stage(name: str, work: Callable[[], Any]) -> Any:
    """Do one stage, and print its line."""
    forget_peak()
    start, cpu = time.perf_counter(), time.process_time()
    result = work()
    wall, spent = time.perf_counter() - start, time.process_time() - cpu
    peak, held = status("VmHWM") / 1e9, status("VmRSS") / 1e9
    print(f"| {name} | {wall:.1f} | {spent:.1f} | {peak:.2f} | {held:.2f} |", flush=True)
    return result


def process(path: Path, picture: Path) -> None:
    """Read, diagnose, smooth and draw."""
    import beltrami as bt

    warm_up(bt, picture)
    mesh = stage("read", lambda: bt.read_mesh(path))
    print(f"| {mesh.n_vertices} vertices, {mesh.n_faces} faces | | | | |")
    diagnosis = stage("diagnose", lambda: bt.diagnose(mesh))
    if not diagnosis.is_clean:
        raise RuntimeError(diagnosis.report())
    smooth = stage("smooth", lambda: bt.smooth_mesh(mesh, steps=10))
    stage("render", lambda: bt.render(smooth, path=picture))


def spectrum(path: Path, modes: int) -> None:
    """Read, make the pair, find the first modes."""
    import beltrami as bt

    bt.fourier_basis(bt.laplacian(bt.shapes.blob(3000)), modes)
    mesh = stage("read", lambda: bt.read_mesh(path))
    print(f"| {mesh.n_vertices} vertices, {modes} modes | | | | |")
    pair = stage("laplacian", lambda: bt.laplacian(mesh))
    basis = stage("spectrum", lambda: bt.fourier_basis(pair, modes))
    print(f"| residuals up to {basis.residuals.max():.1e} | | | | |")


def warm_up(bt: Any, picture: Path) -> None:
    """Compile and load everything on a small mesh, which is no part of the times."""
    small = picture.with_suffix(".ply")
    write_sphere(small, 2000)
    mesh = bt.read_mesh(small)
    bt.diagnose(mesh)
    bt.render(bt.smooth_mesh(mesh, steps=10), path=picture)


def main(arguments: list[str] | None = None) -> None:
    one_thread()
    parser = argparse.ArgumentParser(prog="python -m benchmarks.huge")
    parser.add_argument("--faces", type=int, default=10_000_000)
    parser.add_argument("--spectrum", type=int, default=0)
    parser.add_argument("--modes", type=int, default=32)
    parser.add_argument("--folder", type=Path)
    parser.add_argument("--inside", choices=("process", "spectrum"), help=argparse.SUPPRESS)
    asked = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as place:
        folder = asked.folder or Path(place)
        if asked.inside == "process":
            process(folder / "huge.ply", Path(place, "picture.png"))
        elif asked.inside == "spectrum":
            spectrum(folder / "huge.ply", asked.modes)
        else:
            everything(folder, asked.faces, asked.spectrum, asked.modes)


def everything(folder: Path, faces: int, vertices: int, modes: int) -> None:
    """Write each mesh, and start the process that works on it."""
    print(
        "| stage | wall, s | CPU, s | peak, GB | held after, GB |\n|---|---|---|---|---|",
        flush=True,
    )
    for what, size in (("process", faces), ("spectrum", 2 * vertices)):
        if size:
            write_sphere(folder / "huge.ply", size)
            command = [sys.executable, "-m", "benchmarks.huge", "--inside", what]
            command += ["--modes", str(modes), "--folder", str(folder.resolve())]
            subprocess.run(command, check=True, cwd=ROOT, env=dict(os.environ))
            (folder / "huge.ply").unlink()


if __name__ == "__main__":
    main()
