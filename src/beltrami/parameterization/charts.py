"""Charts: parts of a surface in the plane, as they are wanted for an atlas."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami.mesh.cut import Cut
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology
from beltrami.mesh.tree_cotree import cut_to_disk
from beltrami.parameterization.cells import Neighbours, halved, into_disks
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.components import Request, map_component, settle
from beltrami.parameterization.disk_cells import segment_into_disks
from beltrami.parameterization.distortion import measured
from beltrami.parameterization.parameterize import DEFAULT_WEIGHTS
from beltrami.parameterization.reweighting import Step

_APART = 4.0  # gaps in space that are far apart
_PIECES = 10_000  # of a boundary edge, at most
_HOPEFUL = 1.5  # factor of a distortion that goes down when a rough map is made to the last


class Asked(NamedTuple):
    """What a chart has to be: as little distorted, and parts of it so far from each other."""

    method: str
    seams: int
    max_distortion: float
    gap: float


class Chart(NamedTuple):
    """Faces of the surface, and a mesh of their own in the plane.

    ``corners`` are the faces in vertices of the chart, ``origin`` those of the surface that these
    are copies of, ``uv`` where they lie.
    """

    faces: Integers
    corners: Integers
    origin: Integers
    uv: Floats


def map_chart(
    part: Mesh, faces: Integers, origin: Integers, mesh: Mesh, asked: Asked
) -> list[Chart] | None:
    """Return the charts of a disk, or None if it has to be cut; a single face always is one.

    A chart that is good without a seam gets none. Maps are made roughly, and to the last only if
    that can make good ones of them.
    """
    whole = cut_to_disk(part)
    hopeless = _HOPEFUL * asked.max_distortion
    known: Step | None = None
    for seams in sorted({0, asked.seams}):
        weights = DEFAULT_WEIGHTS.get(asked.method, ())
        circle = ("circle", "arclength", None, 0.0)
        wanted = Request(asked.method, weights, *circle, seams, cut=True, draw=False, rough=True)
        all_faces = np.ones(part.n_faces, np.bool_)
        at = np.zeros((whole.mesh.n_vertices, 2))
        found = map_component(whole, at, all_faces, wanted, known)
        cut, uv, known = found.cut, found.uv, found.first
        made = _charts(cut, uv, faces, origin, mesh.n_faces)
        if max((_distortion(chart, mesh) for chart in made), default=0.0) > hopeless:
            continue
        if asked.method == "free":
            uv = settle(cut.mesh, uv, None)
            made = _charts(cut, uv, faces, origin, mesh.n_faces)
        if _good(made, mesh, asked) and certify(cut.mesh.topology, uv).is_bijective:
            return made
    return made if len(faces) == 1 else None


def _good(charts: list[Chart], mesh: Mesh, asked: Asked) -> bool:
    """Whether distortion and padding of charts are as they were asked for."""
    return all(
        _distortion(chart, mesh) <= asked.max_distortion
        and not _comes_near_itself(chart, mesh, asked.gap)
        for chart in charts
    )


def _charts(cut: Cut, uv: Floats, faces: Integers, origin: Integers, m: int) -> list[Chart]:
    """Leave out the faces that fill holes; a chart for each piece of what remains."""
    real = np.flatnonzero(faces < m)
    if not len(real):
        return []
    used, corners = np.unique(cut.mesh.faces[real], return_inverse=True)
    pieces = Topology(corners.reshape(-1, 3)).components("edges")
    made = []
    for piece in range(int(pieces.max()) + 1):
        own = real[pieces == piece]
        used, corners = np.unique(cut.mesh.faces[own], return_inverse=True)
        copied = origin[cut.vertex_map[used]]
        made.append(Chart(faces[own], corners.reshape(-1, 3), copied, uv[used]))
    return made


def _distortion(chart: Chart, mesh: Mesh) -> float:
    part = Mesh(mesh.vertices[chart.origin], chart.corners)
    return measured(part, chart.uv).symmetric_dirichlet


def halves(part: Mesh) -> Integers:
    """Part a disk into two, or more where halves are no disks; it has two faces at least."""
    labels = segment_into_disks(part, 2).labels
    if labels.any():
        return labels
    near = Neighbours.of(part)
    return into_disks(halved(labels, near, np.ones(1, np.bool_)), part.topology, near)[0]


def _comes_near_itself(chart: Chart, mesh: Mesh, gap: float) -> bool:
    """Whether parts of the boundary that are far apart on the surface nearly meet in the plane.

    A filter would mix their texels. Both sides of a seam may be near to each other: they are the
    same points.
    """
    if gap == 0:
        return False
    from scipy.spatial import cKDTree  # slow to load

    edges = Topology(chart.corners).boundary_edges
    uv = chart.uv * np.sqrt(mesh.face_areas[chart.faces].sum() / area_of(chart.uv[chart.corners]))
    a, b = uv[edges[:, 0]], uv[edges[:, 1]]
    pieces = np.ceil(np.linalg.norm(b - a, axis=1) / (gap / 2)).astype(np.int64)
    pieces = np.clip(pieces, 1, _PIECES)
    edge = np.repeat(np.arange(len(edges)), pieces)
    turn = np.arange(len(edge)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    t = (turn / pieces[edge])[:, None]
    flat = a[edge] + t * (b - a)[edge]
    x, y = (mesh.vertices[chart.origin[edges[:, end]]] for end in (0, 1))
    there = x[edge] + t * (y - x)[edge]
    pairs = cKDTree(flat).query_pairs(gap, output_type="ndarray")
    far = np.linalg.norm(there[pairs[:, 0]] - there[pairs[:, 1]], axis=1) > _APART * gap
    return bool(far.any())


def area_of(corners: Floats) -> float:
    """Return the area of triangles (m, 3, 2) of the plane."""
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return float(np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2)
