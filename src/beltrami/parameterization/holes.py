"""Holes: filled for as long as a map is made, so that no cut has to lead to them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Booleans, Floats, Integers, read_only
from beltrami.mesh.cut import Cut, cut_along
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology

HOLES = ("cut", "fill")
_HEIGHT = 0.01  # of the tip above a hole, over its length: no fan has a face without area


@dataclass(frozen=True, eq=False)
class Filled:
    """A surface with a fan of faces over each hole.

    Attributes
    ----------
    mesh : Mesh
        The vertices and faces of ``apart`` first. It has one coordinate more, which is 0 but for
        the tips of the fans: a fan has area whatever the shape of the hole.
    apart : Cut
        The surface, cut apart where it is not a manifold.
    """

    mesh: Mesh
    apart: Cut

    @classmethod
    def without_any(cls, mesh: Mesh) -> Filled:
        """Fill nothing, but cut the surface apart where it is not a manifold."""
        apart = cut_along(mesh, np.zeros(mesh.topology.n_edges, np.bool_))
        return cls(apart.mesh, apart)


def fill_holes(mesh: Mesh) -> Filled:
    """Fill all boundary loops but the longest of each component.

    Examples
    --------
    >>> from beltrami.mesh.shapes import cylinder
    >>> filled = fill_holes(cylinder(6, 2))
    >>> filled.mesh.euler_characteristic, len(filled.mesh.boundary_loops), filled.mesh.dimension
    (1, 1, 4)
    """
    apart = cut_along(mesh, np.zeros(mesh.topology.n_edges, np.bool_))
    x, faces = apart.mesh.vertices, apart.mesh.faces
    label = np.empty(len(x), np.int64)
    label[faces.ravel()] = np.repeat(apart.mesh.components(), 3)
    loops = apart.mesh.boundary_loops
    lengths = [_length(x[loop]) for loop in loops]
    longest: dict[int, int] = {}
    for q, loop in enumerate(loops):
        own = int(label[loop[0]])
        if own not in longest or lengths[q] > lengths[longest[own]]:
            longest[own] = q
    tips: list[Floats] = []
    fans = [faces]
    for q, loop in enumerate(loops):
        if q == longest[int(label[loop[0]])]:
            continue
        tip = np.full(len(loop), len(x) + len(tips))
        fans.append(np.stack([np.roll(loop, -1), loop, tip], axis=1))
        tips.append(np.append(x[loop].mean(axis=0), _HEIGHT * lengths[q]))
    lifted = np.hstack([x, np.zeros((len(x), 1))])
    return Filled(Mesh(np.vstack([lifted, *tips]), np.concatenate(fans)), apart)


def _length(loop: Floats) -> float:
    return float(np.linalg.norm(np.roll(loop, -1, axis=0) - loop, axis=1).sum())


def emptied(filled: Filled, mesh: Mesh, current: Cut, f: Floats) -> tuple[Cut, Floats]:
    """Take the fans out of a cut of the filled surface and of a function on it.

    The first copy of each vertex keeps its number, the others come at the end. Pieces that only a
    fan held together have no vertex in common: they are components of their own.
    """
    apart = filled.apart
    n, m = apart.mesh.n_vertices, apart.mesh.n_faces
    real = Topology(current.mesh.faces[:m], current.mesh.n_vertices)
    pieces = real.components("edges")
    count = int(pieces.max()) + 1
    keys, local = np.unique(real.faces * count + pieces[:, None], return_inverse=True)
    used = keys // count
    before = current.vertex_map[used]
    _, first = np.unique(before, return_index=True)
    order = np.concatenate([first, np.setdiff1d(np.arange(len(used)), first)])
    number = np.empty(len(used), np.int64)
    number[order] = np.arange(len(used))
    vertex_map = apart.vertex_map[before[order]]
    data = {name: values[vertex_map] for name, values in mesh.vertex_data.items()}
    faces = number[local].reshape(-1, 3)
    opened = Mesh(mesh.vertices[vertex_map], faces, data, mesh.corner_uv)
    inner = current.edges[_both_sides_are_real(current.edges, apart.mesh, n)]
    edges = np.concatenate([apart.edges, np.sort(apart.vertex_map[inner], axis=1)])
    return Cut(opened, read_only(vertex_map), read_only(edges)), f[used[order]]


def _both_sides_are_real(edges: Integers, mesh: Mesh, n: int) -> Booleans:
    """Say which edges are inner edges of the surface: not of a fan, and not of the rim of one."""
    rim = mesh.topology.boundary_edges
    on_rim = np.isin(edges[:, 0] * n + edges[:, 1], rim[:, 0] * n + rim[:, 1])
    return np.asarray((edges < n).all(axis=1) & ~on_rim)
