"""Repair: only what is asked for, in a fixed order, with maps from old to new."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Booleans, Integers, as_indices, read_only
from beltrami._kinds import checked
from beltrami.errors import MeshError
from beltrami.mesh.door import require_mesh
from beltrami.mesh.duplicates import duplicate_faces, merge_targets
from beltrami.mesh.geometry import degenerate_faces, face_vectors
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology


@dataclass(frozen=True, eq=False)
class Repair:
    """A repaired mesh, and what became of the old one.

    Attributes
    ----------
    mesh
        The repaired mesh.
    vertex_map
        (n,) int: the new number of each old vertex; -1 where it was dropped. Of a vertex that
        was split, the number of the first copy.
    face_map
        (m,) int: the new number of each old face; -1 where it was dropped.
    vertex_origin
        (new n,) int: the old vertex that each new one was; data are carried over by it.
    done
        One line for each repair that changed something, or could not.
    """

    mesh: Mesh
    vertex_map: Integers
    face_map: Integers
    vertex_origin: Integers
    done: tuple[str, ...]


@checked
def repair(
    mesh: Mesh,
    *,
    remove_vertices: ArrayLike = (),
    remove_non_finite: bool = False,
    merge_duplicate_vertices: bool = False,
    tolerance: float = 0.0,
    remove_degenerate_faces: bool = False,
    remove_duplicate_faces: bool = False,
    split_non_manifold: bool = False,
    orient: bool = False,
    keep_largest_component: bool = False,
    remove_unreferenced: bool = False,
) -> Repair:
    """Repair what is asked for, in the order of the parameters, and nothing else.

    Parameters
    ----------
    mesh
        Any mesh.
    remove_vertices
        Drop these vertices (indices or a mask), and their faces: a part of no interest, or
        where a function has no values. Neighbours that lose their last face stay.
    remove_non_finite
        Drop vertices with a NaN or infinite coordinate, and their faces.
    merge_duplicate_vertices
        Weld vertices at the same place into the first of them.
    tolerance
        How near is the same place, as a fraction of the diagonal of the bounding box; 0 is
        exactly equal.
    remove_degenerate_faces
        Drop faces that name a vertex twice or have no area (at most 1e-12 (longest edge)²).
    remove_duplicate_faces
        Keep one of the faces with the same three vertices.
    split_non_manifold
        Give each fan of faces its own copy of a vertex; edges of more than two faces are cut.
    orient
        Turn faces until neighbours agree; closed components then have their normals outwards,
        but for cavities: those that are consistent, within the box of another closed one.
    keep_largest_component
        Keep the component (through common vertices) with the most faces.
    remove_unreferenced
        Drop vertices in no face; those that other repairs leave alone too.

    Raises
    ------
    MeshError
        If ``tolerance`` is negative, or given without ``merge_duplicate_vertices``, or a vertex
        to remove does not exist.

    Notes
    -----
    Vertex data and texture coordinates are carried over. The order of vertices and faces is
    kept; copies made by splitting come last. Cost: O(n log n + m).

    Examples
    --------
    >>> stray = Mesh([[0, 0], [5, 5], [1, 0], [0, 1]], [[0, 2, 3]])
    >>> fixed = repair(stray, remove_unreferenced=True)
    >>> fixed.mesh.faces.tolist(), fixed.vertex_map.tolist(), fixed.done
    ([[0, 1, 2]], [0, -1, 1, 2], ('removed 1 unreferenced vertex',))
    """
    require_mesh(mesh, "repair")
    if not 0 <= tolerance <= 0.1 or (tolerance > 0 and not merge_duplicate_vertices):
        raise MeshError(
            f"tolerance is a fraction of the diagonal, at most 0.1 and not {tolerance}, "
            "and goes with merge_duplicate_vertices=True"
        )
    unwanted = as_indices(remove_vertices, mesh.n_vertices, "vertices to remove")
    steps: list[tuple[bool, Callable[[_Work], str]]] = [
        (len(unwanted) > 0, lambda work: _remove_vertices(work, unwanted)),
        (remove_non_finite, _remove_non_finite),
        (merge_duplicate_vertices, lambda work: _merge(work, tolerance)),
        (remove_degenerate_faces, _remove_degenerate),
        (remove_duplicate_faces, _remove_duplicate_faces),
        (split_non_manifold, _split),
        (orient, _orient),
        (keep_largest_component, _keep_largest),
        (remove_unreferenced, _remove_unreferenced),
    ]
    work = _Work(mesh)
    done = [step(work) for asked, step in steps if asked]
    return work.result(tuple(line for line in done if line))


class _Work:
    """The mesh under repair: faces, where each vertex and face came from, where it went."""

    def __init__(self, mesh: Mesh) -> None:
        self.mesh = mesh
        self.faces = mesh.faces.copy()
        self.corner_uv = None if mesh.corner_uv is None else mesh.corner_uv.copy()
        self.origin = np.arange(mesh.n_vertices)
        self.vertex_map = np.arange(mesh.n_vertices)
        self.face_origin = np.arange(mesh.n_faces)

    @property
    def positions(self) -> np.ndarray:
        return self.mesh.vertices[self.origin]

    @property
    def topology(self) -> Topology:
        return Topology(self.faces, len(self.origin))

    def keep_faces(self, kept: Booleans) -> int:
        self.faces = self.faces[kept]
        self.face_origin = self.face_origin[kept]
        if self.corner_uv is not None:
            self.corner_uv = self.corner_uv[kept]
        return int(np.count_nonzero(~kept))

    def keep_vertices(self, kept: Booleans) -> int:
        number = np.where(kept, np.cumsum(kept) - 1, -1)
        self.faces = number[self.faces]
        self.origin = self.origin[kept]
        self.renumber(number)
        return int(np.count_nonzero(~kept))

    def renumber(self, number: Integers) -> None:
        """Follow old vertices to new numbers; -1, for those that are gone, stays -1."""
        self.vertex_map = np.append(number, -1)[self.vertex_map]

    def turn_faces(self, turned: Booleans) -> int:
        self.faces[turned] = self.faces[turned][:, [0, 2, 1]]
        if self.corner_uv is not None:
            self.corner_uv[turned] = self.corner_uv[turned][:, [0, 2, 1]]
        return int(np.count_nonzero(turned))

    def result(self, done: tuple[str, ...]) -> Repair:
        data = {name: values[self.origin] for name, values in self.mesh.vertex_data.items()}
        face_map = np.full(self.mesh.n_faces, -1)
        face_map[self.face_origin] = np.arange(len(self.face_origin))
        fixed = Mesh(self.positions, self.faces, data, self.corner_uv)
        maps = (read_only(self.vertex_map), read_only(face_map), read_only(self.origin))
        return Repair(fixed, *maps, done)


def _line(verb: str, count: int, one: str, many: str) -> str:
    return f"{verb} {count} {one if count == 1 else many}" if count else ""


def _remove_vertices(work: _Work, unwanted: Integers) -> str:
    wanted = np.ones(len(work.origin), np.bool_)
    wanted[unwanted] = False
    return _line("removed", _drop(work, wanted), "vertex as asked", "vertices as asked")


def _drop(work: _Work, kept: Booleans) -> int:
    """Keep only these vertices, and the faces all of whose vertices are among them."""
    work.keep_faces(np.asarray(kept[work.faces].all(axis=1)))
    return work.keep_vertices(kept)


def _remove_non_finite(work: _Work) -> str:
    count = _drop(work, np.isfinite(work.positions).all(axis=1))
    return _line("removed", count, "vertex that was not finite", "vertices that were not finite")


def _merge(work: _Work, tolerance: float) -> str:
    targets = merge_targets(work.positions, tolerance)
    kept = targets == np.arange(len(targets))
    work.faces = targets[work.faces]
    work.renumber(targets)
    count = work.keep_vertices(kept)
    return _line("merged", count, "duplicate vertex", "duplicate vertices")


def _remove_degenerate(work: _Work) -> str:
    kept = np.ones(len(work.faces), np.bool_)
    kept[degenerate_faces(work.positions, work.faces)] = False
    return _line("removed", work.keep_faces(kept), "degenerate face", "degenerate faces")


def _remove_duplicate_faces(work: _Work) -> str:
    kept = np.ones(len(work.faces), np.bool_)
    kept[duplicate_faces(work.faces)] = False
    return _line("removed", work.keep_faces(kept), "duplicate face", "duplicate faces")


def _split(work: _Work) -> str:
    """Give each fan a vertex: the first keeps the number, the others get copies at the end."""
    n = len(work.origin)
    roots = work.topology.fans.root.reshape(-1, 3)
    whole = roots[:, 0] >= 0
    fans, fan_of_corner = np.unique(roots[whole], return_inverse=True)
    vertex_of_fan = work.faces.ravel()[fans]
    _, first = np.unique(vertex_of_fan, return_index=True)
    extra = np.ones(len(fans), np.bool_)
    extra[first] = False
    number = np.where(extra, n + np.cumsum(extra) - 1, vertex_of_fan)
    work.faces[whole] = number[fan_of_corner].reshape(-1, 3)
    work.origin = np.concatenate([work.origin, work.origin[vertex_of_fan[extra]]])
    count = int(np.count_nonzero(extra))
    return _line("split off", count, "copy of a vertex", "copies of vertices")


def _orient(work: _Work) -> str:
    topology = work.topology
    turned = topology.orientation
    if turned is None:
        return "left the orientation alone: the surface is not orientable"
    labels = topology.components("edges")
    oriented = np.where(turned[:, None], work.faces[:, [0, 2, 1]], work.faces)
    outwards = turned ^ _to_turn(work, oriented, labels, turned)[labels]
    return _line("turned", work.turn_faces(outwards), "face", "faces")


def _to_turn(work: _Work, oriented: Integers, labels: Integers, turned: Booleans) -> Booleans:
    """Say which components to turn as a whole: those inside out that are no cavities."""
    inside_out, closed = _inside_out(work, oriented, labels)
    order = np.argsort(labels, kind="stable")
    starts = np.searchsorted(labels[order], np.arange(len(closed)))
    corners = work.positions[oriented[order]]
    low = np.minimum.reduceat(corners.min(axis=1), starts) if len(starts) else corners[:0, 0]
    high = np.maximum.reduceat(corners.max(axis=1), starts) if len(starts) else corners[:0, 0]
    mixed = np.bincount(labels, turned, len(closed)) > 0
    for c in np.flatnonzero(inside_out & ~mixed):
        around = closed & (low <= low[c]).all(axis=1) & (high >= high[c]).all(axis=1)
        inside_out[c] = np.count_nonzero(around) == 1  # itself
    return inside_out


def _inside_out(work: _Work, oriented: Integers, labels: Integers) -> tuple[Booleans, Booleans]:
    """Say which components are closed and enclose a negative volume, and which are closed."""
    count = int(labels.max(initial=-1)) + 1
    positions = work.positions
    if positions.shape[1] != 3:
        return np.zeros(count, np.bool_), np.zeros(count, np.bool_)
    closed = np.ones(count, np.bool_)
    closed[labels[(work.topology.twins < 0).any(axis=1)]] = False
    sums = np.bincount(labels, minlength=count)
    middle = positions[oriented].mean(axis=1)
    centre = np.stack([np.bincount(labels, middle[:, c], count) / sums for c in range(3)], axis=1)
    with np.errstate(invalid="ignore"):  # a component that is not finite has no inside
        moment = ((middle - centre[labels]) * face_vectors(positions, oriented)).sum(axis=1)
    return closed & (np.bincount(labels, moment, count) < 0), closed


def _keep_largest(work: _Work) -> str:
    labels = work.topology.components()
    if not len(labels):
        return ""
    sizes = np.bincount(labels)
    work.keep_faces(labels == sizes.argmax())
    return _line("removed", len(sizes) - 1, "smaller component", "smaller components")


def _remove_unreferenced(work: _Work) -> str:
    count = work.keep_vertices(work.topology.referenced)
    return _line("removed", count, "unreferenced vertex", "unreferenced vertices")
