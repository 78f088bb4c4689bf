"""From a mesh to the objects of other libraries."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami._optional import require
from beltrami.errors import DimensionError, check_name

if TYPE_CHECKING:
    from beltrami.mesh.mesh import Mesh

_SHOWN_AS = "beltrami mesh"  # its name in polyscope: the next one takes its place


def export(mesh: Mesh, target: str) -> Any:
    """Build the object of another library: vertices, faces and data, unchanged in order.

    Nothing is shared, so that what is theirs can be changed. Planar meshes get z = 0, but for
    meshio and arrays.

    ============= ================================ ============================================
    target        what comes                       and with it
    ============= ================================ ============================================
    "arrays"      (vertices, faces)                nothing
    "trimesh"     trimesh.Trimesh                  data, as vertex_attributes; "color" is shown
    "pyvista"     pyvista.PolyData                 data, as point_data
    "meshio"      meshio.Mesh                      data, as point_data
    "open3d"      open3d.t.geometry.TriangleMesh   data, in the map ``vertex``; corner_uv
    "polyscope"   polyscope.SurfaceMesh            data, as quantities; corner_uv
    ============= ================================ ============================================

    In open3d "normal" and "color" are called "normals" and "colors", and ``to_legacy()`` makes
    the older kind of mesh, which has no place for other functions. polyscope is initialised if it
    was not, has the mesh as "beltrami mesh", and opens its window with ``polyscope.show()``.

    Raises
    ------
    UnknownNameError
        If ``target`` is not in ``TARGETS``.
    MissingExtraError
        If that library is not installed.
    DimensionError
        If it needs points in space, and the mesh has more than three coordinates.
    """
    make = _MAKERS[check_name("target", target, TARGETS)]
    data = {name: values.copy() for name, values in mesh.vertex_data.items()}
    return make(mesh, mesh.faces.copy(), data)


def in_three(mesh: Mesh, library: str) -> Floats:
    """Copy the positions, with z = 0 if the mesh is planar."""
    if mesh.dimension > 3:
        raise DimensionError(
            f"{library} needs points in space, and these have {mesh.dimension} coordinates",
            remedy="Keep three of them: mesh.with_vertices(mesh.vertices[:, :3]).",
        )
    return np.pad(mesh.vertices, ((0, 0), (0, 3 - mesh.dimension)))


def _arrays(mesh: Mesh, faces: Integers, _data: dict[str, NDArray[Any]]) -> Any:
    return mesh.vertices.copy(), faces


def _trimesh(mesh: Mesh, faces: Integers, data: dict[str, NDArray[Any]]) -> Any:
    trimesh = require("trimesh", "io", "an object of trimesh")
    return trimesh.Trimesh(
        in_three(mesh, "trimesh"),
        faces,
        process=False,  # or it merges vertices
        vertex_colors=_colours(data),
        vertex_attributes=data,
    )


def _meshio(mesh: Mesh, faces: Integers, data: dict[str, NDArray[Any]]) -> Any:
    meshio = require("meshio", "io", "an object of meshio")
    return meshio.Mesh(mesh.vertices.copy(), [("triangle", faces)], point_data=data)


def _pyvista(mesh: Mesh, faces: Integers, data: dict[str, NDArray[Any]]) -> Any:
    pyvista = require("pyvista", "view", "an object of pyvista")
    found = pyvista.PolyData.from_regular_faces(in_three(mesh, "pyvista"), faces)
    for name, values in data.items():
        found.point_data[name] = _common(values)
    return found


def _open3d(mesh: Mesh, faces: Integers, data: dict[str, NDArray[Any]]) -> Any:
    open3d = require("open3d", "view", "an object of open3d")
    tensor = open3d.core.Tensor
    found = open3d.t.geometry.TriangleMesh(tensor(in_three(mesh, "open3d")), tensor(faces))
    for name, values in data.items():
        found.vertex[OPEN3D_NAMES.get(name, name)] = tensor(_common(values))
    if mesh.corner_uv is not None:
        found.triangle["texture_uvs"] = tensor(mesh.corner_uv.copy())
    return found


def _polyscope(mesh: Mesh, faces: Integers, data: dict[str, NDArray[Any]]) -> Any:
    polyscope = require("polyscope", "view", "a mesh in polyscope")
    if not polyscope.is_initialized():
        polyscope.init()
    found = polyscope.register_surface_mesh(_SHOWN_AS, in_three(mesh, "polyscope"), faces)
    for name, values in data.items():
        columns = np.asarray(values, np.float64).reshape(len(values), -1)
        if name == "color" and columns.shape[1] in (3, 4):
            found.add_color_quantity(name, _unit_colours(values)[:, :3])
        elif columns.shape[1] == 3:
            found.add_vector_quantity(name, columns)
        else:
            for k, column in enumerate(columns.T):
                label = f"{name}_{k}" if values.ndim == 2 else name
                found.add_scalar_quantity(label, column)
    if mesh.corner_uv is not None:
        corners = mesh.corner_uv.reshape(-1, 2)
        found.add_parameterization_quantity("uv", corners, defined_on="corners")
    return found


def _common(values: NDArray[Any]) -> NDArray[Any]:
    """Make floats of 2 or 16 bytes, which C++ libraries do not know, common ones."""
    odd = values.dtype.kind == "f" and values.dtype.itemsize not in (4, 8)
    return values.astype(np.float64) if odd else values


def _colours(data: dict[str, NDArray[Any]]) -> NDArray[Any] | None:
    """Return the data "color" as bytes, if there are any."""
    given = data.get("color")
    if given is None or given.ndim != 2 or given.shape[1] not in (3, 4):
        return None
    return np.rint(255 * _unit_colours(given)).astype(np.uint8)


def _unit_colours(given: NDArray[Any]) -> Floats:
    """Colours in [0, 1], from bytes or from such numbers."""
    scale = 255 if given.dtype.kind in "iu" else 1
    return np.clip(np.nan_to_num(np.asarray(given, np.float64) / scale), 0, 1)


OPEN3D_NAMES = {"normal": "normals", "color": "colors"}
_MAKERS: dict[str, Callable[[Mesh, Integers, dict[str, NDArray[Any]]], Any]] = {
    "arrays": _arrays,
    "trimesh": _trimesh,
    "pyvista": _pyvista,
    "meshio": _meshio,
    "open3d": _open3d,
    "polyscope": _polyscope,
}
TARGETS = tuple(_MAKERS)
