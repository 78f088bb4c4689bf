"""PLY: text or binary, polygons or strips, every property of the vertices kept."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers, read_only
from beltrami.errors import FileFormatError, MeshError
from beltrami.io import ply_texture
from beltrami.io.faces import fan, first_outside, unroll
from beltrami.io.ply_binary import read_binary
from beltrami.io.ply_data import grouped
from beltrami.io.ply_header import Element, read_header
from beltrami.io.ply_text import next_token, read_text
from beltrami.io.source import POINTS_ONLY, Source
from beltrami.mesh.mesh import Mesh

_NONE = np.zeros((0, 3), np.int64)
_LISTS = ("vertex_indices", "vertex_index")


def read_ply(source: Source) -> Mesh:
    r"""Read a PLY file; polygons are cut from their first corner, strips are unrolled.

    Scalar properties of the vertices become vertex data with the type they have in the file:
    red, green, blue and alpha together "color"; nx, ny, nz "normal"; name_0, name_1, ... "name".
    Texture coordinates become ``corner_uv``: the list texcoord of each face (MeshLab's, u and v
    of each corner), or else texture_u and texture_v, u and v, or s and t of the vertices. Other
    lists, properties of faces and elements are left out.

    Raises
    ------
    FileFormatError
        With the line or the byte, for what is no such file; also without vertices or faces.

    Examples
    --------
    >>> import numpy as np
    >>> text = (b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    ...         b"property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
    ...         b"end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    >>> read_ply(Source("triangle.ply", np.frombuffer(text, np.uint8))).faces.tolist()
    [[0, 1, 2]]
    """
    header = read_header(source)
    position = header.start
    vertices: NDArray[np.float64] | None = None
    data: dict[str, NDArray[Any]] = {}
    pieces: list[tuple[Integers, int]] = []
    turns: list[Floats | None] = []
    by_vertex: Floats | None = None
    for element in header.elements:
        first = position
        wanted = _wanted(source, element)
        textured = _textured(element)
        rows = (
            read_binary(source, position, element, header.order, wanted, textured)
            if header.order
            else read_text(source, position, element, wanted, textured)
        )
        position = rows.position
        if element.name == "vertex":
            scalars = dict(rows.scalars)
            by_vertex = ply_texture.of_vertices(scalars)
            vertices, data = _split(source, scalars, first)
        elif rows.corners is not None:
            pieces.append((_triangles(source, element, *rows.corners, first), first))
            sizes = rows.corners[1]
            turns.append(
                None
                if rows.turns is None
                else ply_texture.of_faces(sizes, element.rows, *rows.turns)
            )
    if not header.order:
        position = int(next_token(source.data, position))
    if position < len(source.data):
        raise source.at_byte(
            position,
            f"expected the end of the file after the last row, found "
            f"{len(source.data) - position} more bytes: the counts are wrong",
        )
    mesh = _assembled(source, vertices, data, pieces)
    uv = _joined(pieces, turns)
    if uv is None and by_vertex is not None:
        uv = by_vertex[mesh.faces]
    return mesh if uv is None else Mesh(mesh.vertices, mesh.topology, mesh.vertex_data, uv)


def ply_points(source: Source) -> Floats:
    """Read the vertices alone, (n, 3); nothing after them is looked at."""
    header = read_header(source)
    position = header.start
    for element in header.elements:
        rows = (
            read_binary(source, position, element, header.order, None, None)
            if header.order
            else read_text(source, position, element, None, None)
        )
        if element.name == "vertex" and element.rows:
            return _split(source, rows.scalars, position)[0]
        position = rows.position
    raise FileFormatError(source.path, "expected vertices (an element 'vertex'), found none")


def _textured(element: Element) -> str | None:
    """Return the name of the list of texture coordinates of a face."""
    for p in element.properties:
        if element.name == "face" and p.name in ply_texture.LISTS and p.length is not None:
            return p.name if p.type[0] == "f" else None
    return None


def _joined(pieces: list[tuple[Integers, int]], turns: list[Floats | None]) -> Floats | None:
    """Return the texture coordinates of all pieces, NaN for those that have none."""
    if all(uv is None for uv in turns):
        return None
    return np.concatenate(
        [
            np.full((len(faces), 3, 2), np.nan) if uv is None else uv
            for (faces, _), uv in zip(pieces, turns, strict=True)
        ]
    )


def _wanted(source: Source, element: Element) -> str | None:
    """Return the name of the list of vertices of a face or a strip."""
    if element.name not in ("face", "tristrips"):
        return None
    for p in element.properties:
        if p.name in _LISTS and p.length is not None:
            if p.type[0] == "f":
                raise FileFormatError(
                    source.path, f"expected an integer type for the list {p.name!r}, found a float"
                )
            return p.name
    return None


def _split(
    source: Source, scalars: dict[str, NDArray[Any]], first: int
) -> tuple[NDArray[np.float64], dict[str, NDArray[Any]]]:
    """Part the coordinates of the vertices, checked, from their data."""
    for axis in "xyz":
        if axis not in scalars:
            raise FileFormatError(source.path, f"expected a property {axis!r} of the vertices")
    with np.errstate(invalid="ignore", over="ignore"):
        vertices = _side_by_side(*(scalars[axis] for axis in "xyz"))
        total = vertices.sum()  # one pass: NaN or infinite if a coordinate is, or if it overflows
    if not np.isfinite(total) and not np.isfinite(vertices).all():
        row = int(np.flatnonzero(~np.isfinite(vertices).all(axis=1))[0])
        raise source.at_byte(
            first,
            f"expected finite coordinates, found NaN or infinity in vertex {row} "
            "(counted from 0; the vertices start at this byte)",
        )
    rest = {name: column for name, column in scalars.items() if name not in ("x", "y", "z")}
    return vertices, grouped(rest)


def _side_by_side(x: NDArray[Any], y: NDArray[Any], z: NDArray[Any]) -> NDArray[np.float64]:
    """Return (n, 3) float64; in one go where the columns lie next to each other in the file."""
    size = x.itemsize
    places = [column.__array_interface__["data"][0] for column in (x, y, z)]
    alike = x.dtype == y.dtype == z.dtype and x.strides == y.strides == z.strides
    if alike and places == [places[0] + c * size for c in range(3)] and x.strides[0] >= 3 * size:
        rows = np.lib.stride_tricks.as_strided(x, (len(x), 3), (x.strides[0], size))
        return rows.astype(np.float64)
    return np.stack([x, y, z], axis=1).astype(np.float64)


def _triangles(
    source: Source, element: Element, values: Integers, lengths: Integers | int, first: int
) -> Integers:
    if element.name == "tristrips":
        return unroll(values.ravel())
    if isinstance(lengths, int):
        if lengths == 3:
            return values.reshape(-1, 3)
        values, lengths = values.ravel(), np.full(element.rows, lengths)
    if len(lengths) and lengths.min() < 3:
        row = int(np.argmax(lengths < 3))
        raise source.at_byte(
            first,
            f"expected three corners or more, found {lengths[row]} in face {row} "
            "(counted from 0; the faces start at this byte)",
        )
    if len(lengths) and lengths.max() == 3:
        return values.reshape(-1, 3)
    return fan(values, lengths)


def _assembled(
    source: Source,
    vertices: NDArray[np.float64] | None,
    data: dict[str, NDArray[Any]],
    pieces: list[tuple[Integers, int]],
) -> Mesh:
    if vertices is None or len(vertices) == 0:
        raise FileFormatError(source.path, "expected vertices (an element 'vertex'), found none")
    faces = pieces[0][0] if len(pieces) == 1 else np.concatenate([_NONE, *(p for p, _ in pieces)])
    if len(faces) == 0:
        raise FileFormatError(
            source.path,
            "expected faces (an element 'face' or 'tristrips' with a list "
            f"'vertex_indices'), found none{POINTS_ONLY}",
        )
    if isinstance(faces.base, np.ndarray):
        faces.base.flags.writeable = False
    try:
        return Mesh(read_only(vertices), read_only(faces), data)
    except MeshError as cause:  # the mesh checks the indices; here we say where they stand
        raise _outside(source, len(vertices), pieces) or cause from cause


def _outside(source: Source, n: int, pieces: list[tuple[Integers, int]]) -> FileFormatError | None:
    """Make the error for the first index of a vertex that does not exist."""
    for faces, first in pieces:
        place = int(first_outside(faces.reshape(-1), n))
        if place >= 0:
            return source.at_byte(
                first,
                f"expected indices of vertices, 0..{n - 1}, found {faces.reshape(-1)[place]} in "
                f"triangle {place // 3} (counted from 0; the faces start at this byte)",
            )
    return None
