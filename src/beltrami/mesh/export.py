"""From a mesh to the objects of other libraries."""

from __future__ import annotations

from typing import Any

from beltrami._arrays import Floats, Integers
from beltrami._optional import require
from beltrami.errors import check_name

TARGETS = ("arrays", "trimesh", "pyvista", "meshio", "open3d")


def export(vertices: Floats, faces: Integers, target: str) -> Any:
    """Build the object of another library from vertices and faces, unchanged in order.

    Raises
    ------
    UnknownNameError
        If ``target`` is not one of "arrays", "trimesh", "pyvista", "meshio", "open3d".
    MissingExtraError
        If that library is not installed.
    """
    check_name("target", target, TARGETS)
    x, f = vertices.copy(), faces.copy()  # theirs to change
    if target == "arrays":
        return x, f
    if target == "trimesh":
        trimesh = require("trimesh", "io", "an object of trimesh")
        return trimesh.Trimesh(x, f, process=False)
    if target == "meshio":
        return require("meshio", "io", "an object of meshio").Mesh(x, [("triangle", f)])
    if target == "pyvista":
        pyvista = require("pyvista", "view", "an object of pyvista")
        return pyvista.PolyData.from_regular_faces(x, f)
    open3d = require("open3d", "view", "an object of open3d")
    return open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(x), open3d.utility.Vector3iVector(f)
    )
