"""VTK's XML files of surfaces (.vtp), as ParaView, pyvista and VTK write them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Integers
from beltrami.io.faces import fan, first_outside, unroll
from beltrami.io.source import Source
from beltrami.io.unpacking import Room
from beltrami.io.vtk_polydata import PolyData
from beltrami.io.vtk_xml import TYPES, Element, VtkXml


def read_vtp(source: Source, room: Room) -> PolyData:
    r"""Read a surface: in text, base64 or raw bytes, within the elements or after them.

    Arrays may be compressed by zlib, LZMA or LZ4. Polygons are cut from their first corner,
    strips into their triangles; points and lines that are cells, data on cells, and arrays of
    texts or bits are left out. The pieces of a file stand one after the other, with the arrays
    that all of them have.

    Raises
    ------
    FileFormatError
        For what is no such file, or unpacks to more than there is room for.

    Examples
    --------
    >>> text = (
    ...     b'<VTKFile type="PolyData"><PolyData><Piece NumberOfPoints="3" NumberOfPolys="1">'
    ...     b'<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">'
    ...     b'0 0 0 1 0 0 0 1 0</DataArray></Points><Polys>'
    ...     b'<DataArray type="Int32" Name="connectivity" format="ascii">0 1 2</DataArray>'
    ...     b'<DataArray type="Int32" Name="offsets" format="ascii">3</DataArray>'
    ...     b'</Polys></Piece></PolyData></VTKFile>')
    >>> read_vtp(Source("a.vtp", np.frombuffer(text, np.uint8)), Room("a.vtp", 99)).faces.tolist()
    [[0, 1, 2]]
    """
    file = VtkXml(source, room)
    kind = file.root.attributes.get("type")
    if kind != "PolyData":
        raise file.wrong(f"expected the type PolyData, found {kind!r}")
    surfaces = [
        _piece(file, piece)
        for surface in file.root.named("PolyData")
        for piece in surface.named("Piece")
    ]
    if not surfaces:
        raise file.wrong("expected a Piece of PolyData, found none")
    return surfaces[0] if len(surfaces) == 1 else _side_by_side(surfaces)


def _piece(file: VtkXml, piece: Element) -> PolyData:
    n = file.whole(piece, "NumberOfPoints")
    points = np.zeros((0, 3))
    for array in _arrays(piece, "Points"):
        if file.whole(array, "NumberOfComponents", "1") != 3:
            raise file.wrong("expected 3 as NumberOfComponents of the points")
        points = file.array(array, 3 * n).reshape(n, 3).astype(np.float64)
    if len(points) != n:
        raise file.wrong(f"expected {n} points, found none")
    faces = [_faces(file, piece, name, n) for name in ("Polys", "Strips")]
    data, uv = _data(file, piece, n)
    return PolyData(points, np.concatenate(faces), data, uv)


def _arrays(piece: Element, name: str) -> list[Element]:
    return [array for part in piece.named(name) for array in part.named("DataArray")]


def _faces(file: VtkXml, piece: Element, name: str, n: int) -> Integers:
    count = file.whole(piece, f"NumberOf{name}")
    if count == 0:
        return np.zeros((0, 3), np.int64)
    found = {array.attributes.get("Name"): array for array in _arrays(piece, name)}
    if not {"offsets", "connectivity"} <= found.keys():
        raise file.wrong(f"expected the arrays offsets and connectivity in {name}")
    for array in (found["offsets"], found["connectivity"]):
        if "Int" not in array.attributes.get("type", ""):
            raise file.wrong(f"expected whole numbers as offsets and connectivity of {name}")
    ends = file.array(found["offsets"], count).astype(np.int64)
    sizes = np.diff(ends, prepend=0)
    if (sizes < 3).any():
        raise file.wrong(f"expected three corners or more in each of the {name}")
    corners = file.array(found["connectivity"], int(ends[-1])).astype(np.int64)
    if first_outside(corners, n) >= 0:
        raise file.wrong(f"expected indices of points, 0..{n - 1}, in the {name}")
    if name == "Polys":
        return fan(corners, sizes)
    return unroll(np.insert(corners, ends, -1))


def _data(
    file: VtkXml, piece: Element, n: int
) -> tuple[dict[str, NDArray[Any]], NDArray[Any] | None]:
    """Return the arrays on the points, and those that are coordinates of a texture."""
    data, uv = {}, None
    for part in piece.named("PointData"):
        texture = part.attributes.get("TCoords")
        for array in part.named("DataArray"):
            if array.attributes.get("type") not in TYPES:  # texts, or bits
                continue
            name = array.attributes.get("Name", "")
            width = file.whole(array, "NumberOfComponents", "1")
            values = file.array(array, n * width)
            if name == texture:
                uv = values.reshape(n, width)
            else:
                data[name] = values if width == 1 else values.reshape(n, width)
    return data, uv


def _side_by_side(surfaces: list[PolyData]) -> PolyData:
    starts = np.cumsum([0] + [len(surface.points) for surface in surfaces])
    faces = [s.faces + start for s, start in zip(surfaces, starts[:-1], strict=True)]
    names = [
        name
        for name, array in surfaces[0].data.items()
        if all(name in s.data and s.data[name].shape[1:] == array.shape[1:] for s in surfaces)
    ]
    turns = [s.uv for s in surfaces if s.uv is not None and s.uv.shape[1] == 2]
    return PolyData(
        np.concatenate([s.points for s in surfaces]),
        np.concatenate(faces),
        {name: np.concatenate([s.data[name] for s in surfaces]) for name in names},
        np.concatenate(turns) if len(turns) == len(surfaces) else None,
    )
