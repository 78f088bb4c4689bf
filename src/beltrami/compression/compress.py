"""compress: a mesh as few bytes, verified by decoding."""

from __future__ import annotations

import os
from collections.abc import Mapping

import numpy as np

from beltrami._arrays import DROP, Floats, Integers, require_finite, whole
from beltrami._kinds import checked
from beltrami._progress import Progress
from beltrami.compression.attributes import Attributes, check_errors, encode_attributes
from beltrami.compression.choosing import MODES, Wish, encode_wish
from beltrami.compression.connectivity import Connectivity, encode_connectivity
from beltrami.compression.container import (
    CONNECTIVITY,
    GRID,
    KEEPS_ORDER,
    ORDER,
    PREDICTED,
    PREDICTED_UV,
    PREDICTS,
    PROGRESSIVE,
    SPECTRUM,
    Section,
    pack,
)
from beltrami.compression.contents import describe
from beltrami.compression.decompress import decompress
from beltrami.compression.geometry import MOST_COORDINATES
from beltrami.compression.grid import MOST_BITS
from beltrami.compression.numbers import EFFORTS
from beltrami.compression.ordering import encode_order
from beltrami.errors import BeltramiError, DimensionError, MeshError, check_name
from beltrami.io.atomic import replacing
from beltrami.mesh.door import require_mesh, topology_of
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology

_BITS = 14


@checked
def compress(
    mesh: Mesh,
    path: str | os.PathLike[str] | None = None,
    *,
    max_error: float | None = None,
    bits: int | None = None,
    mode: str = "auto",
    terms: int | None = None,
    effort: str = "best",
    keep_order: bool = False,
    function_errors: Mapping[str, float] | None = None,
    uv_error: float | None = None,
    verify: bool = True,
    progress: Progress | None = None,
) -> bytes:
    """Compress a mesh, with a bound of the error: x -> Q(x), then bits (section 3.3.6).

    The faces come back exactly, up to the numbering: face by face the same three vertices in the
    same direction, whatever the faces are. Vertices are numbered as they are met on a walk over
    the surface, which ``vertex_order`` tells; with ``keep_order`` they keep their numbers, faces
    do not. Which corner of a face comes first is not kept. Functions on the vertices and texture
    coordinates come back exactly, unless an error is allowed for them; like positions they are
    predicted from those around, where that is shorter.

    Positions are rounded to a grid. Each vertex is predicted from those before it by local
    systems of Laplacians and of parallelograms, which depend on the faces and on positions that
    the decoder knows too; what is left is coded.

    Parameters
    ----------
    mesh
        Any mesh of finite positions; in n dimensions three coordinates are coded at a time.
    path
        Where to write the bytes, if anywhere: whole or not at all.
    max_error
        No vertex moves farther than that, in the unit of the mesh.
    bits
        1 to 30: the grid has 2^bits points along the longest side of the bounding box. 14 if
        neither is given. A vertex moves at most half the diagonal of a cell.
    mode
        ``"grid"``: the points of the grid. ``"smooth"``: whole steps of the grid from where each
        vertex is expected, then moved to where the surface is smooth; fewer bytes for the same
        error where cells are not small beside the edges, but a vertex can be a whole diagonal of a
        cell off: the file says how much at most. ``"spectral"``: the codec of the chapter,
        coefficients in the eigenvectors of Laplacians that the faces alone give, rounded to
        multiples of the step of the grid, then smoothed in the same way; few bytes for a coarse
        shape, and any beginning of the file is a coarser one (``decompress(..., partial=True)``).
        ``"auto"``: with ``max_error`` the one that takes the fewest bytes, else ``"grid"``. The
        bound is kept in any case. Meshes of at most 4000 vertices are written in every mode, and
        the shortest is taken; of larger ones a twentieth of the vertices is, at least 2000, and all
        in the mode that took the fewest bytes for these: so it may miss the shortest one by a few
        percent where two modes come near each other. Where the grid takes more than 1.5 bytes for
        each vertex, the other modes, which were never seen to win there, are not tried.
    terms
        With ``"spectral"``, no more than that many of the lowest frequencies of each block of at
        most 500 vertices (with the effort ``"fast"`` 250), the M of definition 21.
    effort
        ``"best"``, or ``"fast"``: about half the time, for some percent more bytes.
    keep_order
        Keep the numbers of the vertices; at most log2(n) bits for each.
    function_errors
        For functions of floating-point numbers, by name: how far the values at a vertex may move
        (by the norm, where there are several). The others come back bit by bit.
    uv_error
        How far texture coordinates may move; without, they come back bit by bit.
    verify
        Decode the bytes and compare before they are returned.
    progress
        Called with (vertices coded, n).

    Returns
    -------
    bytes
        A file as docs/format.md describes it.

    Raises
    ------
    NonFiniteError
        If a position is not finite.
    MeshError
        If the bound cannot be kept: finer than 2^-30 of the extent, or than the coordinates; or
        is one of what the mesh does not have.
    UnknownNameError
        If the mode or the effort does not exist.

    Notes
    -----
    In O(n + m): on the grid about 30 microseconds per vertex with the best effort, 10 with the
    fast one, and as much again to verify (``python -m benchmarks.compression`` measures them).
    ``"spectral"`` makes a basis of each block: about 70, 35 with the fast effort. With
    ``max_error`` every mode writes all vertices once: ``"smooth"`` at a step that residuals
    rounded with care always keep the bound at, ``"spectral"`` at the step that suits a sample (and
    one a third larger, in the same basis), with corrections of the vertices beyond the bound.
    Meshes of less than about ten thousand vertices take more for each, as their samples are no
    small part of them. The first call in a new installation compiles.

    References
    ----------
    Karni and Gotsman (2000), Spectral compression of mesh geometry. Touma and Gotsman (1998),
    Triangle mesh compression. Alliez and Desbrun (2001), Valence-driven connectivity encoding.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> sphere = icosphere(3)
    >>> data = compress(sphere, max_error=1e-3)
    >>> len(data) < 1100, decompress(data).n_vertices
    (True, 642)
    """
    require_mesh(mesh)
    check_name("mode", mode, MODES)
    check_name("effort", effort, EFFORTS)
    _check(mesh, max_error, bits)
    check_errors(mesh.vertex_data, function_errors or {})
    if uv_error is not None and mesh.corner_uv is None:
        raise MeshError("uv_error belongs to texture coordinates, and the mesh has none")
    terms = None if terms is None else whole("the number of terms", terms, 1, mesh.n_vertices)
    if terms is not None and mode != "spectral":
        raise MeshError(f"the mode {mode!r} has no terms: they belong to the mode 'spectral'")
    if max_error is None and bits is None:
        bits = _BITS
    wish = Wish(max_error, bits, mode, effort, terms)
    payload, found = encode_connectivity(mesh.topology)
    x = mesh.vertices[found.vertices]
    positions = encode_wish(x, found.faces, wish, progress)
    sections = [Section(CONNECTIVITY, payload), positions]
    if keep_order:
        order = Section(ORDER, encode_order(found.vertices))
        sections.insert(2 if positions.kind == GRID else 1, order)
    functions = {name: values[found.vertices] for name, values in mesh.vertex_data.items()}
    uv = None if mesh.corner_uv is None else _corners(mesh.corner_uv, mesh.topology, found)
    others = encode_attributes(functions, uv, found, effort, function_errors or {}, uv_error)
    data = pack(_features(positions, others, keep_order), sections + others.sections)
    if verify:
        _verify(data, mesh, found, others, max_error, keep_order)
    if path is not None:
        with replacing(path) as file:
            file.write(data)
    return data


def vertex_order(mesh: Mesh | Topology) -> Integers:
    """Return the vertex of the mesh behind each vertex of its compressed file, (n,).

    ``decompress(compress(mesh)).vertices`` are near ``mesh.vertices[vertex_order(mesh)]``. It
    follows from the faces alone.

    Examples
    --------
    >>> vertex_order(Topology([[3, 1, 2], [2, 1, 4]], 5)).tolist()
    [3, 1, 2, 4, 0]
    """
    return encode_connectivity(topology_of(mesh))[1].vertices


def _check(mesh: Mesh, max_error: float | None, bits: int | None) -> None:
    """Raise if the mesh or the bound cannot be coded."""
    require_finite(mesh.vertices, "the mesh", DROP)
    if mesh.dimension > MOST_COORDINATES:
        raise DimensionError(f"positions of more than {MOST_COORDINATES} coordinates")
    if max_error is not None and bits is not None:
        raise MeshError("max_error and bits say the same thing: give one of them")
    if bits is not None and not 1 <= whole("bits", bits, least=0) <= MOST_BITS:
        raise MeshError(f"bits must be 1 to {MOST_BITS}, not {bits}")


def _features(positions: Section, others: Attributes, keep_order: bool) -> int:
    """Return the features that a reader must know."""
    features = KEEPS_ORDER if keep_order else 0
    features |= PROGRESSIVE if positions.kind == SPECTRUM else 0
    kinds = {section.kind for section in others.sections}
    return features | (PREDICTS if kinds & {PREDICTED, PREDICTED_UV} else 0)


def _corners(uv: Floats, topology: Topology, found: Connectivity) -> Floats:
    """Sort what the corners have as the file sorts faces and corners."""
    old = topology.faces[found.source]
    new = found.vertices[found.faces]
    turn = np.argmax((old == new[:, :1]), axis=1)  # improper faces are not turned
    proper = topology.face_edges[found.source, 0] >= 0
    turn[~proper] = 0
    columns = (turn[:, None] + np.arange(3)) % 3
    return uv[found.source][np.arange(len(old))[:, None], columns]


def _verify(
    data: bytes,
    mesh: Mesh,
    found: Connectivity,
    others: Attributes,
    max_error: float | None,
    keep_order: bool,
) -> None:
    """Decode, and raise unless everything is as it was promised."""
    decoded = decompress(data, max_vertices=1 << 40)
    x = mesh.vertices if keep_order else mesh.vertices[found.vertices]
    faces = found.vertices[found.faces] if keep_order else found.faces
    error = float(np.sqrt(((decoded.vertices - x) ** 2).sum(axis=1)).max()) if len(x) else 0.0
    rounding = 8 * np.finfo(np.float64).eps * float(abs(x).max()) if len(x) else 0.0
    bound = describe(data).max_error
    if max_error is not None and max_error < error <= bound + rounding:
        raise MeshError(
            f"the coordinates themselves are rounded by {rounding:.3g}, so that an error of "
            f"{max_error:.3g} cannot be kept",
            remedy="Allow a larger error, or move the mesh to the origin.",
        )
    same = np.array_equal(decoded.faces, faces) and error <= bound + rounding
    for name, values in others.functions.items():
        ordered = values.astype(values.dtype.newbyteorder("<"))
        back = decoded.vertex_data[name]
        same = (
            same and (back[found.vertices] if keep_order else back).tobytes() == ordered.tobytes()
        )
    if others.uv is not None:
        uv = decoded.corner_uv
        same = same and uv is not None and uv.tobytes() == others.uv.tobytes()
    if not same:
        raise BeltramiError(
            "decoding does not give the mesh back: please report this, it is a defect of beltrami"
        )
