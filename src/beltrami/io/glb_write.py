"""Writing GLB, the binary form of glTF 2.0: one mesh with normals, colours and a texture."""

from __future__ import annotations

import json
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers, require_finite
from beltrami.io.light import light_of
from beltrami.io.obj_write import vertex_colours
from beltrami.io.picture import Picture, png_bytes
from beltrami.mesh.mesh import Mesh

_FLOAT, _UNSIGNED = 5126, 5125  # types of components
_KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_OF_VERTICES, _OF_INDICES = 34962, 34963  # what a part of the buffer is for
_JSON, _BINARY = 0x4E4F534A, 0x004E4942
_LARGEST = float(np.finfo(np.float32).max)


def glb_bytes(
    mesh: Mesh, vertices: Floats, uv: Floats | None = None, texture: Picture | None = None
) -> bytes:
    r"""Return the bytes of a GLB file, in single precision.

    Without normals a viewer has to show each face flat (glTF 2.0, 3.7.2.1): the vertex data
    "normal" go along, or else the normals of the vertices of ``mesh``, alike on both sides of a
    seam. So do the vertex data "color", as the linear light that glTF asks for; but not with a
    texture, which they would darken. A vertex has a copy for each place that it has on the
    texture; :math:`v` runs downwards in the file. The material is matt, and seen from both sides
    where the surface has a boundary.

    Parameters
    ----------
    vertices
        (n, 3) within the range of single precision.
    uv
        (m, 3, 2) texture coordinates; NaN becomes 0.

    Raises
    ------
    NonFiniteError
        If texture coordinates are beyond single precision.

    Examples
    --------
    >>> mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> whole = glb_bytes(mesh, mesh.vertices)
    >>> whole[:4], int.from_bytes(whole[8:12], "little") == len(whole)
    (b'glTF', True)
    """
    copies, faces, turns = _opened(mesh, uv)
    file = _File()
    attributes = {
        "POSITION": file.add(vertices[copies], bounds=True),
        "NORMAL": file.add(_normals(mesh, vertices)[copies]),
    }
    colours = vertex_colours(mesh)
    if turns is not None:
        attributes["TEXCOORD_0"] = file.add(np.stack([turns[:, 0], 1 - turns[:, 1]], axis=1))
    if texture is None and colours.shape[1]:
        attributes["COLOR_0"] = file.add(light_of(colours)[copies])
    look: dict[str, Any] = {"metallicFactor": 0.0, "roughnessFactor": 1.0}
    rest: dict[str, Any] = {}
    if texture is not None:
        look["baseColorTexture"] = {"index": 0}
        rest = {
            "textures": [{"source": 0}],
            "images": [{"bufferView": file.part(png_bytes(texture)), "mimeType": "image/png"}],
        }
    material = {"pbrMetallicRoughness": look, "doubleSided": bool(mesh.topology.on_boundary.any())}
    primitive = {"attributes": attributes, "indices": file.add(faces.ravel()), "material": 0}
    return file.whole(meshes=[{"primitives": [primitive]}], materials=[material], **rest)


def write_glb(file: IO[bytes], mesh: Mesh, vertices: Floats) -> None:
    """Write a GLB file, with the texture coordinates of the mesh if it has any."""
    file.write(glb_bytes(mesh, vertices, mesh.corner_uv))


class _File:
    """The parts of a file, as they come: a list of descriptions, and the bytes."""

    def __init__(self) -> None:
        self._views: list[dict[str, int]] = []
        self._accessors: list[dict[str, Any]] = []
        self._content = bytearray()

    def part(self, content: bytes, **of: int) -> int:
        """Add bytes, and some more up to a multiple of four; return the number of the part."""
        self._views.append(
            {"buffer": 0, "byteOffset": len(self._content), "byteLength": len(content), **of}
        )
        self._content += content + b"\0" * (-len(content) % 4)
        return len(self._views) - 1

    def add(self, array: Floats | Integers, *, bounds: bool = False) -> int:
        """Add an array of numbers, in 32 bits; return its number."""
        flat = array.ndim == 1
        held: NDArray[Any] = array.astype("<u4" if flat else "<f4")
        accessor: dict[str, Any] = {
            "bufferView": self.part(held.tobytes(), target=_OF_INDICES if flat else _OF_VERTICES),
            "componentType": _UNSIGNED if flat else _FLOAT,
            "count": len(held),
            "type": _KINDS[1 if flat else held.shape[1]],
        }
        if bounds:  # which positions must have, as they are held
            accessor |= {"min": held.min(axis=0).tolist(), "max": held.max(axis=0).tolist()}
        self._accessors.append(accessor)
        return len(self._accessors) - 1

    def whole(self, **rest: Any) -> bytes:
        """Return a file with a scene of the first mesh."""
        told = {
            "asset": {"version": "2.0", "generator": "beltrami"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            **rest,
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._content)}],
        }
        text = json.dumps(told, separators=(",", ":"), allow_nan=False).encode("ascii")
        text += b" " * (-len(text) % 4)
        length = 12 + 8 + len(text) + 8 + len(self._content)
        pairs = ((_JSON, text), (_BINARY, bytes(self._content)))
        chunks = (_words(len(part), kind) + part for kind, part in pairs)
        return b"glTF" + _words(2, length) + b"".join(chunks)


def _words(*numbers: int) -> bytes:
    return np.array(numbers, "<u4").tobytes()


def _opened(mesh: Mesh, uv: Floats | None) -> tuple[Integers, Integers, Floats | None]:
    """Return the vertex of each copy, the faces in copies, and the place of each on the texture."""
    if uv is None:
        return np.arange(mesh.n_vertices), mesh.faces, None
    turns = np.where(np.isnan(uv), 0.0, uv).reshape(-1, 2)
    held = np.where(np.abs(turns) <= _LARGEST, turns, np.inf)
    require_finite(held, "the texture coordinates, rounded to the 32 bits of GLB,")
    corners = np.column_stack([mesh.faces.ravel(), turns])
    found, turn = np.unique(corners, axis=0, return_inverse=True)
    return found[:, 0].astype(np.int64), turn.reshape(-1, 3), found[:, 1:]


def _normals(mesh: Mesh, vertices: Floats) -> Floats:
    """Return normals (n, 3) of length 1; upwards where there are none, as at points of no face."""
    normals = mesh.vertex_data.get("normal")
    if normals is None or normals.shape != (mesh.n_vertices, 3) or normals.dtype.kind not in "iuf":
        normals = Mesh(vertices, mesh.topology).vertex_normals
    held = normals.astype(np.float64)
    length = np.linalg.norm(held, axis=1)
    known = np.isfinite(length) & (length > 0)
    scaled = held / np.where(known, length, 1.0)[:, None]
    return np.where(known[:, None], scaled, [0.0, 0.0, 1.0])
