"""Holes filled for the time of a map: a surface with many boundaries without a cut (l. 657)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Floats, Integers, read_only
from beltrami.mesh.cut import Cut, cut_along
from beltrami.mesh.mesh import Mesh

_LIFT = 0.05  # of the middle of a filling out of its hole, over the length around


@dataclass(frozen=True, eq=False)
class Filling:
    """A surface all but one of whose boundary loops are closed, in each component.

    Attributes
    ----------
    mesh
        The faces of the surface, then the fillings: fans around new vertices, which come last.
    whole : Cut
        The surface itself, cut apart where it is not a manifold.
    """

    mesh: Mesh
    whole: Cut


def fill_holes(mesh: Mesh) -> Filling | None:
    """Close all boundary loops of each component but its longest; None if there are none.

    The new vertex of a fan lies at the middle of its loop, a little off the plane of the loop, so
    that no face of it is flat.
    """
    whole = cut_along(mesh, np.zeros(mesh.topology.n_edges, np.bool_))
    topology = whole.mesh.topology
    label = np.empty(topology.n_vertices, np.int64)
    label[topology.faces.ravel()] = np.repeat(topology.components(), 3)
    x = np.zeros((topology.n_vertices, max(3, mesh.dimension)))
    x[:, : mesh.dimension] = whole.mesh.vertices
    points, fans, seen = [x], [topology.faces], set()
    for loop in topology.boundary_loops:  # the longest first
        if int(label[loop[0]]) not in seen:
            seen.add(int(label[loop[0]]))
            continue
        middle = topology.n_vertices + len(points) - 1
        points.append(_middle(x[loop])[None])
        fans.append(np.stack([np.roll(loop, -1), loop, np.full(len(loop), middle)], axis=1))
    if len(fans) == 1:
        return None
    return Filling(Mesh(np.concatenate(points), np.concatenate(fans)), whole)


def _middle(x: Floats) -> Floats:
    """Return the mean of a loop of points, lifted along the axis in which they vary least."""
    mean = x.mean(axis=0)
    around = np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1).sum()
    axis = np.linalg.eigh((x - mean).T @ (x - mean))[1][:, 0]
    return np.asarray(mean + _LIFT * around * axis)


def emptied(filling: Filling, current: Cut, uv: Floats) -> tuple[Cut, Floats]:
    """Take the fillings out of a cut of the filled surface, and of its map.

    The first copy of each vertex keeps its number, the others come at the end.
    """
    whole = filling.whole
    m, n = whole.mesh.n_faces, whole.mesh.n_vertices
    faces = current.mesh.faces[:m]
    kept, local = np.unique(faces, return_inverse=True)
    before = current.vertex_map[kept]
    _, first = np.unique(before, return_index=True)
    again = np.setdiff1d(np.arange(len(kept)), first)
    order = np.concatenate([first, again])
    number = np.empty(len(kept), np.int64)
    number[order] = np.arange(len(kept))
    chain: Integers = whole.vertex_map[before[order]]
    source = whole.mesh
    data = {name: values[before[order]] for name, values in source.vertex_data.items()}
    opened = Mesh(
        source.vertices[before[order]], number[local].reshape(-1, 3), data, source.corner_uv
    )
    edges = current.edges[(current.edges < n).all(axis=1)]
    inner = source.topology.half_edges.edge_face_count == 2
    keys = source.edges[inner] @ [n, 1]
    edges = edges[np.isin(np.sort(edges, axis=1) @ [n, 1], keys)]
    cut = np.concatenate([whole.edges, np.sort(whole.vertex_map[edges], axis=1)])
    return Cut(opened, read_only(chain), read_only(cut)), uv[kept[order]]
