"""Surfaces of the suite of maps: shapes that need no file, files that are mended, parts of both."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.packages import package

Array = NDArray[Any]


def read(path: Path, **repairs: bool) -> Any:
    """Read a file, and mend what no map could bear."""
    bt = package("beltrami")
    mend = {"remove_unreferenced": True, "remove_degenerate_faces": True, **repairs}
    mesh = bt.repair(bt.read_mesh(path), **mend).mesh
    return bt.Mesh(mesh.vertices, mesh.faces)


def part(mesh: Any, faces: Array) -> Any:
    """Return these faces with the vertices that they use, in space."""
    used, local = np.unique(faces, return_inverse=True)
    x = np.zeros((len(used), 3))
    x[:, : mesh.vertices.shape[1]] = mesh.vertices[used]
    return package("beltrami").Mesh(x, local.reshape(-1, 3))


def largest(mesh: Any) -> Any:
    """Return the component with the most faces."""
    labels = mesh.components()
    return part(mesh, mesh.faces[labels == np.bincount(labels).argmax()])


def within(mesh: Any, f: Array, level: float) -> Any:
    """Return the largest piece of the faces where a function is below a level."""
    return largest(part(mesh, mesh.faces[(f[mesh.faces] < level).all(axis=1)]))


def disk_of(mesh: Any) -> Any:
    """Cut to disks and return the largest."""
    return largest(package("beltrami").cut_to_disk(mesh).mesh)


def subdivide(mesh: Any, steps: int) -> Any:
    """Divide each face into four, again and again; the shape remains."""
    return package("beltrami.mesh.shapes.subdivide").subdivide(mesh, steps)


def less_one(mesh: Any) -> Any:
    return part(mesh, mesh.faces[1:])


def closed(mesh: Any) -> Any:
    """Close each boundary loop with a fan of faces around its middle."""
    x, faces = [mesh.vertices], [mesh.faces]
    for q, loop in enumerate(mesh.boundary_loops):
        x.append(mesh.vertices[loop].mean(axis=0)[None])
        tip = np.full(len(loop), mesh.n_vertices + q)
        faces.append(np.stack([np.roll(loop, -1), loop, tip], axis=1))
    return package("beltrami").Mesh(np.concatenate(x), np.concatenate(faces))


def moved(mesh: Any, change: Callable[[Array, Array, Array], tuple[Array, Array, Array]]) -> Any:
    """Return a mesh, of which the positions (x, y, z) are changed."""
    x = np.zeros((mesh.n_vertices, 3))
    x[:, : mesh.vertices.shape[1]] = mesh.vertices
    return package("beltrami").Mesh(np.stack(change(*x.T), axis=1), mesh.faces)


def around(mesh: Any, radius: float) -> Any:
    """Return what is nearer to vertex 0 than this part of the size of the mesh."""
    size = float(np.ptp(mesh.vertices, axis=0).max())
    return within(mesh, package("beltrami").geodesic_distance(mesh, 0), radius * size)


def below(mesh: Any, level: float) -> Any:
    """Return what lies below a level of the last axis, 0 in the middle and 1 at the top."""
    z = mesh.vertices[:, 2] - mesh.vertices[:, 2].mean()
    return within(mesh, z, level * float(np.abs(z).max()))


def bump() -> Any:
    return moved(
        package("beltrami").shapes.grid(40, 40),
        lambda x, y, _: (x, y, 0.8 * np.exp(-6 * ((x - 0.2) ** 2 + y**2))),
    )


def waves() -> Any:
    return moved(
        package("beltrami").shapes.disk(30),
        lambda x, y, _: (x, y, 0.15 * np.sin(9 * x) * np.cos(7 * y + 2 * x)),
    )


def scroll() -> Any:
    """Roll up a long strip: it can be laid out without any distortion."""

    def rolled(x: Array, y: Array, _: Array) -> tuple[Array, Array, Array]:
        turn = np.sqrt(1 + 4 * (x - x.min()))
        return turn * np.cos(6 * turn), turn * np.sin(6 * turn), y

    return moved(package("beltrami").shapes.grid(160, 16, 10.0, 6.0), rolled)


def radial(subdivisions: int, radius: Callable[[Array], Array]) -> Any:
    """Return a sphere whose points lie at a radius that depends on the direction."""
    ball = package("beltrami").shapes.icosphere(subdivisions)
    u = ball.vertices
    return package("beltrami").Mesh(u * radius(u)[:, None], ball.faces)


def hedgehog() -> Any:
    """Put narrow spikes on a sphere, around the corners of an icosahedron."""
    tips = package("beltrami").shapes.icosphere(0).vertices
    return radial(5, lambda u: 1 + 1.5 * np.exp(-40 * (1 - (u @ tips.T))).sum(axis=1))


def rough() -> Any:
    noise = np.random.default_rng(7)
    return radial(4, lambda u: 1 + 0.04 * noise.standard_normal(len(u)))


def dumbbell() -> Any:
    return radial(5, lambda u: 0.15 + u[:, 2] ** 2)


def tube(rings: int) -> Any:
    """Return a closed tube of 12 vertices around; the faces are near to equilateral."""
    shapes = package("beltrami").shapes
    return shapes.cylinder(12, rings, height=rings * np.pi / 6, caps=True)


def plate() -> Any:
    """Return a square plate with 36 square holes."""
    grid = package("beltrami").shapes.grid(38, 38)
    centre = grid.vertices[grid.faces].mean(axis=1)
    cell = np.floor((centre - grid.vertices.min(axis=0)) / np.ptp(grid.vertices, axis=0) * 38)
    hollow = (np.isin(cell % 6, (3, 4)) & (cell < 38)).all(axis=1)
    return part(grid, grid.faces[~hollow])


def blocks(full: Array) -> Any:
    """Return the surface of the cubes of a grid that are full; they touch along faces only."""
    full = np.pad(full, 1)
    sides = []
    for axis in range(3):
        for way in (-1, 1):
            cells = np.argwhere(full & ~np.roll(full, -way, axis))
            u, v = np.eye(3, dtype=np.int64)[[(axis + 1) % 3, (axis + 2) % 3]]
            if way < 0:
                u, v = v, u
            start = cells + np.eye(3, dtype=np.int64)[axis] * (way > 0)
            sides.append(np.stack([start, start + u, start + u + v, start + v], axis=1))
    corners = np.concatenate(sides)
    x, number = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    quads = number.reshape(-1, 4)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return package("beltrami").Mesh(x.astype(np.float64), faces)


def sponge(level: int) -> Any:
    """Return Menger's sponge: of genus 5, 81, ..."""
    grid = np.indices((3**level,) * 3)
    full = np.ones(grid.shape[1:], np.bool_)
    for k in range(level):
        full &= (grid // 3**k % 3 == 1).sum(axis=0) < 2
    return blocks(full)


def frame() -> Any:
    """Return the edges of a cube, three cubes thick: of genus 5."""
    ends = (np.indices((12, 12, 12)) < 3) | (np.indices((12, 12, 12)) > 8)
    return blocks(ends.sum(axis=0) > 1)
