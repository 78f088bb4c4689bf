"""Disks to map to the plane: natural ones, cut surfaces, spheres less one triangle, tubes."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.cases import FOLDER_VARIABLE
from benchmarks.packages import package

NATURAL = ("camel-head.off", "face.obj", "circle.obj")
CUT = (
    "torus.obj",
    "fertility.off",
    "spot_triangulated.obj",
    "beetle.obj",
    "halftunnel.off",
    "featuretype.STL",
    "Fandisk0.3/Original.obj",
    "bun_zipper.ply",
    "armadillo.obj",
)
SPHERES = (
    "spot_triangulated.obj",
    "spot_control_mesh.obj",
    "Fandisk0.3/Noisy.obj",
    "armadillo.obj",
)
TUBES = (30, 60, 120, 240, 480)  # rings of 12 vertices

Array = NDArray[Any]


def suite(largest: int, names: Sequence[str] = ()) -> Iterator[tuple[str, str, Any]]:
    """Yield (group, name, disk) of these names, all if none; none with more vertices than this."""
    for group, name, make in _recipes():
        if names and name not in names:
            continue
        mesh = make()
        if mesh.n_vertices <= largest:
            yield group, name, mesh


def _recipes() -> Iterator[tuple[str, str, Callable[[], Any]]]:
    shapes = package("beltrami").shapes
    folder = Path(os.environ.get(FOLDER_VARIABLE, ""))
    files = os.environ.get(FOLDER_VARIABLE) is not None
    yield "natural", "bump", lambda: bump(shapes.grid(40, 40))
    yield "natural", "cap", lambda: below(shapes.icosphere(4), 0.5)
    yield "natural", "half a blob", lambda: below(shapes.blob(6000), 0.0)
    for name in NATURAL if files else ():
        yield "natural", name, lambda name=name: read(folder / name)
    closed: dict[str, Callable[[], Any]] = {
        "cube": lambda: shapes.cube(16),
        "blob 1500": lambda: shapes.blob(1500),
        "blob 8000": lambda: shapes.blob(8000),
    }
    yield "cut", "torus", lambda: disk_of(shapes.torus(48, 24))
    yield "cut", "cylinder", lambda: disk_of(shapes.cylinder(40, 30))
    for name, make in closed.items():
        yield "cut", name, lambda make=make: disk_of(make())
    for name in CUT if files else ():
        yield "cut", name, lambda name=name: disk_of(read(folder / name))
    yield "one triangle", "icosphere", lambda: less_one(shapes.icosphere(4))
    for name, make in closed.items():
        yield "one triangle", name, lambda make=make: less_one(make())
    for name in SPHERES if files else ():
        yield "one triangle", name, lambda name=name: less_one(read(folder / name))
    for rings in TUBES:
        yield "tube", f"{rings} rings", lambda rings=rings: tube(rings)


def read(path: Path) -> Any:
    bt = package("beltrami")
    mesh = bt.repair(
        bt.read_mesh(path), remove_unreferenced=True, remove_degenerate_faces=True
    ).mesh
    return bt.Mesh(mesh.vertices, mesh.faces)


def part(mesh: Any, faces: Array) -> Any:
    """Return these faces with the vertices that they use, in space."""
    used, local = np.unique(faces, return_inverse=True)
    x = np.zeros((len(used), 3))
    x[:, : mesh.vertices.shape[1]] = mesh.vertices[used]
    return package("beltrami").Mesh(x, local.reshape(-1, 3))


def bump(mesh: Any) -> Any:
    x, y = mesh.vertices.T[:2]
    height = 0.8 * np.exp(-6 * ((x - 0.2) ** 2 + y**2))
    return package("beltrami").Mesh(np.stack([x, y, height], axis=1), mesh.faces)


def below(mesh: Any, level: float) -> Any:
    """Return the largest piece of the faces whose corners lie below a level of the last axis."""
    x = mesh.vertices[:, 2] - mesh.vertices[:, 2].mean()
    scale = np.abs(x).max()
    return disk_of(part(mesh, mesh.faces[(x[mesh.faces] < level * scale).all(axis=1)]))


def disk_of(mesh: Any) -> Any:
    """Cut to disks and return the largest."""
    mesh = package("beltrami").cut_to_disk(mesh).mesh
    labels = mesh.components()
    return part(mesh, mesh.faces[labels == np.bincount(labels).argmax()])


def less_one(mesh: Any) -> Any:
    return part(mesh, mesh.faces[1:])


def tube(rings: int) -> Any:
    shapes = package("beltrami").shapes
    return less_one(shapes.cylinder(12, rings, height=rings * np.pi / 6, caps=True))
