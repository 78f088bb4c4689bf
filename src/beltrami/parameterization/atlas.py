"""atlas: charts with little distortion for any surface, packed in one square."""

from __future__ import annotations

import numbers
from typing import NamedTuple

import numpy as np

from beltrami._arrays import Booleans, Floats, Integers, read_only, whole
from beltrami._progress import Progress
from beltrami.errors import MeshError, shown
from beltrami.mesh.cut import Cut, cut_along
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.cells import Neighbours, halved, into_disks
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.disk_cells import segment_into_disks
from beltrami.parameterization.packing import outline, pack
from beltrami.parameterization.parameterization import Parameterization, certified
from beltrami.parameterization.parameterize import parameterize
from beltrami.parameterization.texture_atlas import TextureAtlas

_FILL = 0.35  # of the square, at least: for the size of a texel before charts are packed
_APART = 4.0  # gaps in space that are far apart
_PIECES = 10_000  # of a boundary edge, at most
_EXACT = 2.0**24  # multiples of its inverse in [0, 1] are exact in single precision


class _Chart(NamedTuple):
    """Faces of the surface, the vertices they name, and the map of their mesh."""

    faces: Integers
    number: Integers
    map: Parameterization


def atlas(
    mesh: Mesh,
    count: int = 1,
    *,
    max_distortion: float = 1.1,
    method: str = "free",
    cells: str = "farthest",
    seams: int = 2,
    size: int = 1024,
    padding: int = 2,
    strict: bool = True,
    progress: Progress | None = None,
) -> TextureAtlas:
    r"""Part a surface into charts with little distortion, and pack them in the unit square.

    The surface is parted into disks (``segment_into_disks``), each is mapped (``parameterize``)
    and cut in two if it folds or is distorted too much, and so on: a single face is mapped
    without distortion, so this ends. Charts get the area that they have on the surface, so that
    texels are alike everywhere. Whether the whole is a bijection (no face turned over, no chart
    on another) is decided exactly at the end, of the coordinates that are returned.

    Chapter items: P69, P71.

    Parameters
    ----------
    mesh
        Any oriented surface, of several components too.
    count
        How many charts to begin with, of all components together. There are more where the
        distortion asks for it.
    max_distortion
        Of each chart, the largest mean symmetric Dirichlet energy (1 for isometries): 1.1 gives
        few charts, 1.01 some times as many with texels that are hardly stretched.
    method
        Of ``parameterize``: ``"free"`` has the least distortion by far.
    cells
        Of ``segment_into_disks``: ``"farthest"`` or ``"spectral"``, for the first charts.
    seams
        Of ``parameterize``: up to so many cuts into a chart before it is cut in two.
    size, padding
        Texels along a side of the square, and texels kept free around each chart, so that
        filters do not reach from one to another. A chart with parts that would come nearer to
        each other than twice the padding is cut, too.
    strict
        Raise if the result is not a bijection; False returns it all the same, and says so.
    progress
        Called with the number of faces that are mapped, and of all.

    Returns
    -------
    TextureAtlas
        Coordinates are rounded to multiples of 2⁻²⁴ where that folds nothing: they are then the
        same, and proven, in files of single precision.

    Raises
    ------
    EmptyMeshError, NonFiniteError, DegenerateFaceError, UnreferencedVertexError
        If the mesh is not sound.
    NotOrientableError
        If neighbouring faces disagree on the outside.
    MeshError
        If an option is out of its range, or the charts do not fit with their padding.
    FoldedMapError
        With the faces, if doubles in the unit square cannot tell their corners apart.

    Notes
    -----
    Cost: each round of cuts maps all faces that are not yet in a chart.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> ball = atlas(icosphere(3))
    >>> ball.count, ball.is_bijective, round(ball.distortion.symmetric_dirichlet, 1)
    (2, True, 1.0)
    """
    if not (isinstance(max_distortion, numbers.Real) and max_distortion > 1):
        raise MeshError(f"max_distortion is a number above 1, not {shown(max_distortion)}")
    whole("size", size, least=16, most=65536)
    whole("padding", padding, least=0, most=size // 4)
    first = segment_into_disks(mesh, count, method=cells).labels
    apart = cut_along(mesh, np.zeros(mesh.topology.n_edges, np.bool_))
    gap = 2 * padding * np.sqrt(mesh.area / _FILL) / size
    charts: list[_Chart] = []
    waiting = [np.flatnonzero(first == cell) for cell in range(int(first.max()) + 1)]
    mapped = 0
    while waiting:
        if progress is not None:
            progress(mapped, mesh.n_faces)
        faces = waiting.pop()
        number, corners = np.unique(apart.mesh.faces[faces], return_inverse=True)
        part = Mesh(apart.mesh.vertices[number], corners.reshape(-1, 3))
        found = parameterize(part, method, seams=seams, strict=False)
        good = found.is_bijective and found.distortion.symmetric_dirichlet <= max_distortion
        if len(faces) == 1 or (good and not _comes_near_itself(found, gap)):
            charts.append(_Chart(faces, number, found))
            mapped += len(faces)
        else:
            halves = _halves(part)
            waiting += [faces[halves == half] for half in range(int(halves.max()) + 1)]
    charts.sort(key=lambda chart: int(chart.faces[0]))
    return _assembled(mesh, apart, charts, size, padding, strict=strict)


def _halves(part: Mesh) -> Integers:
    """Part a disk into two, or more where halves are no disks; it has two faces at least."""
    labels = segment_into_disks(part, 2).labels
    if labels.any():
        return labels
    near = Neighbours.of(part)
    return into_disks(halved(labels, near, np.ones(1, np.bool_)), part.topology, near)[0]


def _comes_near_itself(found: Parameterization, gap: float) -> bool:
    """Whether parts of the boundary that are far apart on the surface nearly meet in the plane.

    A filter would mix their texels. Both sides of a seam may be near to each other: they are the
    same points.
    """
    if gap == 0:
        return False
    from scipy.spatial import cKDTree  # slow to load

    edges = found.mesh.topology.boundary_edges
    a, b = (found.uv[edges[:, end]] / found.distortion.scale for end in (0, 1))
    pieces = np.ceil(np.linalg.norm(b - a, axis=1) / (gap / 2)).astype(np.int64)
    pieces = np.clip(pieces, 1, _PIECES)
    edge = np.repeat(np.arange(len(edges)), pieces)
    turn = np.arange(len(edge)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    t = (turn / pieces[edge])[:, None]
    flat = a[edge] + t * (b - a)[edge]
    x, y = (found.mesh.vertices[edges[:, end]] for end in (0, 1))
    there = x[edge] + t * (y - x)[edge]
    pairs = cKDTree(flat).query_pairs(gap, output_type="ndarray")
    far = np.linalg.norm(there[pairs[:, 0]] - there[pairs[:, 1]], axis=1) > _APART * gap
    return bool(far.any())


def _assembled(
    mesh: Mesh, apart: Cut, charts: list[_Chart], size: int, padding: int, *, strict: bool
) -> TextureAtlas:
    """Pack the charts, and make one map of them."""
    outlines = []
    for chart in charts:
        opened, uv = chart.map.mesh, chart.map.uv
        scale = np.sqrt(mesh.face_areas[chart.faces].sum() / _area(uv[opened.faces]))
        outlines.append(outline(uv * scale, opened.topology.boundary_edges))
    packed = pack(outlines, size, padding)
    starts = np.cumsum([0, *(len(points) for points in packed)])
    faces = np.empty((mesh.n_faces, 3), np.int64)
    labels = np.empty(mesh.n_faces, np.int64)
    origin = []
    for label, (start, chart) in enumerate(zip(starts[:-1], charts, strict=True)):
        faces[chart.faces] = chart.map.mesh.faces + start
        labels[chart.faces] = label
        origin.append(apart.vertex_map[chart.number[chart.map.vertex_map]])
    vertex_map = np.concatenate(origin)
    data = {name: values[vertex_map] for name, values in mesh.vertex_data.items()}
    opened = Mesh(mesh.vertices[vertex_map], faces, data)
    cut = Cut(opened, read_only(vertex_map), read_only(_cut_edges(mesh, faces)))
    uv = np.concatenate(packed)
    rounded = np.rint(uv * _EXACT) / _EXACT
    if certify(opened.topology, rounded).is_bijective:
        uv = rounded
    kinds = sorted({chart.map.method for chart in charts})
    found = certified(mesh, cut, uv, f"atlas of {len(charts)} charts: {kinds[0]}", strict=strict)
    return TextureAtlas(read_only(uv[faces]), read_only(labels), found, size, padding)


def _area(corners: Floats) -> float:
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return float(np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2)


def _cut_edges(mesh: Mesh, faces: Integers) -> Integers:
    """Return the edges of the mesh of several faces that have no longer the same two ends."""
    topology = mesh.topology
    sides = np.stack([topology.faces[:, [1, 2, 0]], topology.faces[:, [2, 0, 1]]], axis=2)
    copies = np.stack([faces[:, [1, 2, 0]], faces[:, [2, 0, 1]]], axis=2)
    turned = sides[..., :1] > sides[..., 1:]
    copies = np.where(turned, copies[..., ::-1], copies).reshape(-1, 2)
    edge = topology.face_edges.ravel()
    first = np.empty((topology.n_edges, 2), np.int64)
    first[edge] = copies
    cut: Booleans = np.zeros(topology.n_edges, np.bool_)
    cut[edge[(copies != first[edge]).any(axis=1)]] = True
    return topology.edges[cut]
