"""atlas: charts with little distortion for any surface, packed in one square."""

from __future__ import annotations

import numbers

import numpy as np

from beltrami._arrays import Booleans, Integers, read_only, whole
from beltrami._kinds import require_kind
from beltrami._progress import Progress
from beltrami.errors import MeshError, check_name, shown
from beltrami.mesh.cut import Cut
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology
from beltrami.operators.soundness import refuse_unreferenced, require_sound
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.charts import Asked, Chart, area_of, halves, map_chart
from beltrami.parameterization.disk_cells import segment_into_disks
from beltrami.parameterization.holes import HOLES, Filled, fill_holes
from beltrami.parameterization.packing import outline, pack
from beltrami.parameterization.parameterization import certified
from beltrami.parameterization.parameterize import METHODS, in_words
from beltrami.parameterization.texture_atlas import TextureAtlas

_FILL = 0.35  # of the square, at least: for the size of a texel before charts are packed
_EXACT = 2.0**24  # multiples of its inverse in [0, 1] are exact in single precision


def atlas(
    mesh: Mesh,
    count: int = 1,
    *,
    max_distortion: float = 1.1,
    method: str = "free",
    cells: str = "farthest",
    holes: str = "fill",
    seams: int = 1,
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
    holes
        ``"fill"``: charts may have the holes of the surface, which are closed while they are
        mapped; ``"cut"``: each chart is a disk.
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
    require_sound(require_mesh(mesh, "an atlas"))
    if not mesh.topology.referenced.all():
        refuse_unreferenced(mesh.topology)
    if not (isinstance(max_distortion, numbers.Real) and max_distortion > 1):
        raise MeshError(f"max_distortion is a number above 1, not {shown(max_distortion)}")
    require_kind("strict", strict, ("bool",))
    require_kind("progress", progress, ("Progress", "None"))
    whole("size", size, least=16, most=65536)
    whole("padding", padding, least=0, most=size // 4)
    whole("the number of charts", count, least=1, most=mesh.n_faces)
    whole("the number of seams", seams, least=0)
    check_name("treatment of holes", holes, HOLES)
    check_name("method of parameterisation", method, METHODS)
    filled = fill_holes(mesh) if holes == "fill" else Filled.without_any(mesh)
    first = segment_into_disks(filled.mesh, count, method=cells).labels
    gap = 2 * padding * np.sqrt(mesh.area / _FILL) / size
    asked = Asked(method, seams, float(max_distortion), gap)
    origin = np.full(filled.mesh.n_vertices, -1)  # the tips of fillings are of no vertex
    origin[: len(filled.apart.vertex_map)] = filled.apart.vertex_map
    charts: list[Chart] = []
    waiting = [np.flatnonzero(first == cell) for cell in range(int(first.max()) + 1)]
    mapped = 0
    while waiting:
        if progress is not None:
            progress(mapped, mesh.n_faces)
        faces = waiting.pop()
        number, corners = np.unique(filled.mesh.faces[faces], return_inverse=True)
        part = Mesh(filled.mesh.vertices[number], corners.reshape(-1, 3))
        made = map_chart(part, faces, origin[number], mesh, asked)
        if made is None:
            half = halves(part)
            waiting += [faces[half == q] for q in range(int(half.max()) + 1)]
        else:
            charts += made
            mapped += sum(len(chart.faces) for chart in made)
    charts.sort(key=lambda chart: int(chart.faces[0]))
    words = f"atlas of {len(charts)} charts: {in_words(method, None, 0)}"
    return _assembled(mesh, charts, size, padding, words, strict=strict)


def _assembled(
    mesh: Mesh, charts: list[Chart], size: int, padding: int, words: str, *, strict: bool
) -> TextureAtlas:
    """Pack the charts, and make one map of them."""
    outlines = []
    for chart in charts:
        scale = np.sqrt(mesh.face_areas[chart.faces].sum() / area_of(chart.uv[chart.corners]))
        edges = Topology(chart.corners).boundary_edges
        outlines.append(outline(chart.uv * scale, edges))
    packed = pack(outlines, size, padding)
    starts = np.cumsum([0, *(len(points) for points in packed)])
    faces = np.empty((mesh.n_faces, 3), np.int64)
    labels = np.empty(mesh.n_faces, np.int64)
    for label, (start, chart) in enumerate(zip(starts[:-1], charts, strict=True)):
        faces[chart.faces] = chart.corners + start
        labels[chart.faces] = label
    vertex_map = np.concatenate([chart.origin for chart in charts])
    data = {name: values[vertex_map] for name, values in mesh.vertex_data.items()}
    opened = Mesh(mesh.vertices[vertex_map], faces, data)
    cut = Cut(opened, read_only(vertex_map), read_only(_cut_edges(mesh, faces)))
    uv = np.concatenate(packed)
    rounded = np.rint(uv * _EXACT) / _EXACT
    if certify(opened.topology, rounded).is_bijective:
        uv = rounded
    found = certified(mesh, cut, uv, words, strict=strict)
    return TextureAtlas(read_only(uv[faces]), read_only(labels), found, size, padding)


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
