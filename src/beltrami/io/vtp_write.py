"""Writing VTK's XML files of surfaces: raw bytes after the elements, as ParaView reads fastest."""

from __future__ import annotations

from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats
from beltrami.errors import MeshError
from beltrami.io.vtk_xml import TYPES
from beltrami.mesh.mesh import Mesh

_NAMES = {kind: name for name, kind in TYPES.items()}
_TURNS = "texture coordinates"


def vtp_bytes(mesh: Mesh, vertices: Floats) -> bytes:
    r"""Return a file with the vertex data, and texture coordinates if no vertex has two of them.

    Truth values are written as bytes, numbers of other lengths than VTK has as doubles or single.

    Raises
    ------
    MeshError
        If the name of vertex data is empty or has signs that XML has not, or there are no columns.

    Examples
    --------
    >>> mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> vtp_bytes(mesh, mesh.vertices)[:46]
    b'<?xml version="1.0"?>\n<VTKFile type="PolyData"'
    """
    data = {name: common(array) for name, array in mesh.vertex_data.items()}
    data = {name: array for name, array in data.items() if array.dtype.kind in "iuf"}
    for name, array in data.items():
        _require_holdable(name, array.shape[1:])
    uv = _of_vertices(mesh)
    turns = ""
    if uv is not None:
        name = _TURNS + "'" * sum(key.startswith(_TURNS) for key in data)
        data[name], turns = uv, f" TCoords={quoteattr(name)}"
    arrays = _Arrays()
    kind = np.int32 if max(mesh.n_vertices, 3 * mesh.n_faces) < 2**31 else np.int64
    ends = 3 * np.arange(1, mesh.n_faces + 1, dtype=kind)
    head = "\n".join([
        '<?xml version="1.0"?>',
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">',
        "<PolyData>",
        f'<Piece NumberOfPoints="{mesh.n_vertices}" NumberOfPolys="{mesh.n_faces}">',
        "<Points>", arrays.element("Points", vertices), "</Points>",
        f"<PointData{turns}>",
        *(arrays.element(name, array) for name, array in data.items()),
        "</PointData>",
        "<Polys>",
        arrays.element("connectivity", mesh.faces.astype(kind).ravel()),
        arrays.element("offsets", ends),
        "</Polys>", "</Piece>", "</PolyData>", '<AppendedData encoding="raw">', "_",
    ])  # fmt: skip
    return b"".join([head.encode(), *arrays.parts, b"\n</AppendedData>\n</VTKFile>\n"])


class _Arrays:
    """The arrays after the elements: each the number of its bytes, and these."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self._place = 0

    def element(self, name: str, array: NDArray[Any]) -> str:
        """Put an array to the others, and return the element that says where it is."""
        content = array.astype(array.dtype.newbyteorder("<")).tobytes()
        start = self._place
        self.parts += [np.uint64(len(content)).astype("<u8").tobytes(), content]
        self._place += 8 + len(content)
        width = array.shape[1] if array.ndim == 2 else 1
        label = quoteattr(name, {"\t": "&#9;", "\n": "&#10;", "\r": "&#13;"})
        return (
            f'<DataArray type="{_NAMES[array.dtype.str[1:]]}" Name={label} '
            f'NumberOfComponents="{width}" format="appended" offset="{start}"/>'
        )


def common(array: NDArray[Any]) -> NDArray[Any]:
    """Return the array in a type that VTK has: truth values as bytes, as in PLY.

    Examples
    --------
    >>> common(np.array([True])).dtype, common(np.zeros(1, np.float16)).dtype
    (dtype('uint8'), dtype('float32'))
    """
    kind = array.dtype
    if kind.kind == "b":
        return array.astype(np.uint8)
    if kind.kind == "f" and kind.itemsize not in (4, 8):
        return array.astype(np.float32 if kind.itemsize < 4 else np.float64)
    return array


def _require_holdable(name: str, columns: tuple[int, ...]) -> None:
    """Refuse what would not come back."""
    if not name or any(not _is_of_xml(ord(sign)) for sign in name):
        raise MeshError(
            f"{name!r} cannot be the name of vertex data in a .vtp file",
            remedy="Give it a name of letters with mesh.with_data.",
        )
    if columns == (0,):
        raise MeshError(
            f"a .vtp file has no functions of 0 columns, as {name!r} is",
            remedy="Write .ply, or other columns.",
        )


def _is_of_xml(sign: int) -> bool:
    """Whether XML 1.0 has this sign, as it is or by its number."""
    return sign in (9, 10, 13) or 32 <= sign < 0xD800 or 0xE000 <= sign < 0xFFFE or sign > 0xFFFF


def _of_vertices(mesh: Mesh) -> Floats | None:
    """Return the texture coordinates (n, 2), if there are some, and one pair for each vertex."""
    if mesh.corner_uv is None:
        return None
    uv = np.zeros((mesh.n_vertices, 2))
    uv[mesh.faces.ravel()] = mesh.corner_uv.reshape(-1, 2)
    return uv if np.array_equal(uv[mesh.faces], mesh.corner_uv, equal_nan=True) else None
