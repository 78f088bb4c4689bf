"""From the objects of other libraries to a mesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami.errors import MeshError
from beltrami.mesh.export import OPEN3D_NAMES
from beltrami.mesh.mesh import Mesh

_OURS = {theirs: ours for ours, theirs in OPEN3D_NAMES.items()}
_VTK = {1: "vertex", 3: "line", 5: "triangle", 9: "quad"}  # its numbers for kinds of cells


def as_mesh(source: Any) -> Mesh:
    """Make a mesh of a (vertices, faces) pair or of another library's triangle mesh.

    Accepted are a Mesh itself, pairs, and whatever has ``vertices`` and ``faces`` (trimesh),
    ``points`` and ``regular_faces`` (pyvista), ``points`` and ``cells_dict`` (meshio, grids of
    pyvista), ``vertices`` and ``triangles`` (open3d, both of its kinds) or ``v`` and ``t`` (LaPy);
    and a surface mesh of polyscope, which has single precision and gives no data back. The order
    of vertices and faces is kept; quads among ``cells_dict`` are cut in two and come last, points
    and lines are no faces.

    Functions on the vertices come along as ``vertex_data``: ``vertex_attributes`` and colours of
    trimesh, ``point_data``, the ``vertex`` map of open3d ("normals" and "colors" become "normal"
    and "color"). Texture coordinates become ``corner_uv``. What holds no real numbers, or has more
    than two axes, stays behind.

    Raises
    ------
    MeshError
        If the object is none of these, or holds no triangles.

    Examples
    --------
    >>> as_mesh(([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]))
    <Mesh: 3 vertices in R², 1 faces>
    """
    if isinstance(source, Mesh):
        return source
    if isinstance(source, tuple | list) and len(source) == 2:
        return Mesh(source[0], source[1])
    if _has(source, "vertex", "triangle", "to_legacy"):
        return _of_tensors(source)
    if _has(source, "vertices", "faces"):
        return _of_trimesh(source)
    if _has(source, "vertices", "triangles"):
        return _of_open3d(source)
    if _has(source, "v", "t"):
        return Mesh(source.v, source.t)
    if _has(source, "points", "cells_dict"):
        return _mesh(source.points, _triangles(source.cells_dict), _data_of(source))
    if _has(source, "points", "faces"):
        return _mesh(source.points, _regular_faces(source), _data_of(source))
    if _has(source, "get_buffer", "n_corners"):
        return _of_polyscope(source)
    raise MeshError(
        f"cannot make a mesh of an object of type {type(source).__name__}",
        remedy="Give a pair (vertices, faces); read_mesh reads a file."
        + (" Of a scene, give scene.to_mesh()." if hasattr(source, "to_mesh") else ""),
    )


def _has(source: Any, *names: str) -> bool:
    return all(hasattr(source, name) for name in names)


def _mesh(x: Any, faces: Any, data: Mapping[str, Any], uv: Any = None) -> Mesh:
    """Make the mesh, with the data that are functions on its vertices."""
    vertices = np.asarray(x)
    arrays = {str(name): np.asarray(values) for name, values in data.items()}
    kept = {
        name: array
        for name, array in arrays.items()
        if array.dtype.kind in "biuf" and array.ndim in (1, 2) and len(array) == len(vertices)
    }
    return Mesh(vertices, faces, kept, uv)


def _data_of(source: Any) -> Mapping[str, Any]:
    return getattr(source, "point_data", {})


def _of_trimesh(source: Any) -> Mesh:
    faces = np.asarray(source.faces)
    data = dict(getattr(source, "vertex_attributes", {}))
    visual: Any = getattr(source, "visual", None)
    uv = None
    kind = getattr(visual, "kind", None)
    if kind == "vertex":
        data.setdefault("color", visual.vertex_colors)
    if kind == "texture" and getattr(visual, "uv", None) is not None:
        uv = np.asarray(visual.uv)[faces]
    return _mesh(source.vertices, faces, data, uv)


def _of_open3d(source: Any) -> Mesh:
    """Convert the older kind of open3d, whose vectors become arrays."""
    pairs = (("normal", "vertex_normals"), ("color", "vertex_colors"))
    data = {ours: getattr(source, theirs) for ours, theirs in pairs if hasattr(source, theirs)}
    faces = np.asarray(source.triangles)
    uv = np.asarray(getattr(source, "triangle_uvs", ()))
    whole = len(uv) == 3 * len(faces) > 0
    return _mesh(source.vertices, faces, data, uv.reshape(-1, 3, 2) if whole else None)


def _of_tensors(source: Any) -> Mesh:
    """Convert the newer kind of open3d, whose maps can be asked for more than positions."""
    vertex = {name: source.vertex[name].cpu().numpy() for name in source.vertex}
    triangle = {name: source.triangle[name].cpu().numpy() for name in source.triangle}
    x = vertex.pop("positions", np.zeros((0, 3)))
    data = {_OURS.get(name, name): values for name, values in vertex.items()}
    faces = triangle.get("indices", np.zeros((0, 3), np.int64))
    return _mesh(x, faces, data, triangle.get("texture_uvs"))


def _of_polyscope(source: Any) -> Mesh:
    positions, corners = (
        source.get_buffer(name) for name in ("vertexPositions", "triangleVertexInds")
    )
    x = np.array([positions.get_value(i).as_tuple() for i in range(positions.size())], np.float32)
    f = np.array([corners.get_value(i) for i in range(corners.size())], np.int64)
    return Mesh(x.reshape(-1, 3), f.reshape(-1, 3))


def _regular_faces(source: Any) -> NDArray[Any]:
    """Return the faces of pyvista, if all of them are triangles."""
    reason: ValueError | None = None
    try:
        faces = np.asarray(source.regular_faces)
    except ValueError as cause:  # faces of several kinds
        faces, reason = np.zeros((1, 0)), cause
    if faces.shape == (0,):
        return np.zeros((0, 3), np.int64)
    if faces.ndim != 2 or faces.shape[1] != 3:
        raise MeshError(
            "this object of pyvista has faces that are no triangles",
            remedy="Give mesh.triangulate().",
        ) from reason
    return faces


def _triangles(cells: Mapping[Any, Any]) -> NDArray[Any]:
    """Collect the triangles and the halves of the quads of meshio; refuse other faces."""
    blocks = {_VTK.get(kind, kind): block for kind, block in cells.items()}
    unknown = set(blocks) - {"triangle", "quad", "line", "vertex"}
    if unknown or not set(blocks) & {"triangle", "quad"}:
        raise MeshError(f"triangles or quads are needed, and this object has {list(blocks)}")
    quads = np.asarray(blocks.get("quad", np.zeros((0, 4), np.int64)))
    halves = quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    return np.concatenate([blocks.get("triangle", halves[:0]), halves])
