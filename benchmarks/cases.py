"""The meshes: ``bt.shapes.blob``, which anyone can make, and igea where there is a folder."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.packages import package

FOLDER_VARIABLE = "BELTRAMI_MESHES"
QUICK_SIZE = 10_000
IGEA = 134_345  # vertices

Arrays = tuple[NDArray[np.float64], NDArray[np.int64]]


@dataclass(frozen=True)
class Case:
    """A named mesh, as two arrays that are made once and kept in the folder of this run.

    The processes that measure the memory read them from there.
    """

    name: str
    folder: Path
    make: Callable[[], Arrays]

    @cached_property
    def _arrays(self) -> Arrays:
        path = self.folder / f"{self.name.replace(' ', '_')}.npz"
        if not path.exists():
            vertices, faces = self.make()
            np.savez(path, vertices=vertices, faces=faces)
        with np.load(path) as stored:
            return stored["vertices"], stored["faces"]

    @property
    def vertices(self) -> NDArray[np.float64]:
        """(n, 3) positions, as a user has them: writable, C-ordered."""
        return self._arrays[0]

    @property
    def faces(self) -> NDArray[np.int64]:
        """(m, 3) indices."""
        return self._arrays[1]


def cases(size: int, folder: Path, quick: bool = False) -> list[Case]:
    """Return the meshes of about this many vertices (one empty case if 0).

    ``quick`` takes one small blob instead.
    """
    if size == 0:
        return [Case("no mesh", folder, no_mesh)]
    if quick:
        return [small(folder)]
    found = [Case(f"blob {size // 1000}k", folder, lambda: blob(size))]
    meshes = os.environ.get(FOLDER_VARIABLE)
    if meshes and size < 100_000:
        found.append(Case("bunny 35k", folder, lambda: bunny(Path(meshes) / "bun_zipper.ply")))
    elif meshes:
        path = Path(meshes) / "igea.ply"
        times = round(math.log(size / IGEA, 4))
        found.append(Case(f"igea {size // 1000}k", folder, lambda: igea(path, times)))
    return found


def small(folder: Path) -> Case:
    """Return the mesh to try and to warm up with."""
    return Case(f"blob {QUICK_SIZE // 1000}k", folder, lambda: blob(QUICK_SIZE))


def no_mesh() -> Arrays:
    return np.zeros((0, 3)), np.zeros((0, 3), np.int64)


def blob(size: int) -> Arrays:
    return plain(package("beltrami").shapes.blob(size))


def igea(path: Path, times: int) -> Arrays:
    """Read the scan of 134k vertices, and subdivide it so many times."""
    vertices, faces = plain(package("beltrami").read_mesh(path))
    for _ in range(times):
        vertices, faces = subdivided(vertices, faces)
    return vertices, faces


def bunny(path: Path) -> Arrays:
    """Read the scan, less the vertices that no face uses."""
    bt = package("beltrami")
    return plain(bt.repair(bt.read_mesh(path), remove_unreferenced=True).mesh)


def plain(mesh: Any) -> Arrays:
    return np.array(mesh.vertices, dtype=np.float64), np.array(mesh.faces, dtype=np.int64)


def subdivided(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> Arrays:
    """Cut each face into four at the midpoints of its sides; the old vertices come first."""
    n = len(vertices)
    sides = np.sort(np.roll(faces, -1, axis=1)[..., None] * [1, 0] + faces[..., None] * [0, 1])
    keys = sides[..., 0] * n + sides[..., 1]  # side c runs from corner c to corner c + 1
    unique, number = np.unique(keys, return_inverse=True)
    middle = n + number.reshape(faces.shape)
    midpoints = (vertices[unique // n] + vertices[unique % n]) / 2
    i, j, k = faces.T
    ij, jk, ki = middle.T
    small = np.stack([i, ij, ki, ij, j, jk, ki, jk, k, ij, jk, ki], axis=1)
    return np.concatenate([vertices, midpoints]), small.reshape(-1, 3)
