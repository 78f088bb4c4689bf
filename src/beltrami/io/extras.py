"""Formats read and written by other packages: GIFTI, FreeSurfer, glTF, VTK and others."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami._optional import require
from beltrami.errors import FileFormatError, MeshError, MissingExtraError
from beltrami.io.faces import fan, first_outside
from beltrami.io.gltf import read_scene
from beltrami.io.packed_inside import require_room
from beltrami.io.source import Source, plain_file
from beltrami.io.unpacking import Room, room_of
from beltrami.io.vtk_polydata import PolyData, is_polydata, read_polydata
from beltrami.io.vtp import read_vtp
from beltrami.io.vtp_write import common, vtp_bytes
from beltrami.mesh.mesh import Mesh

_MESHIO = (".vtk", ".vtu", ".msh", ".mesh", ".inp")
_GLTF = (".glb", ".gltf")
_UV = "texture coordinates of corners"  # among the vertex data, until the mesh is made
_FREESURFER = (
    ".pial", ".white", ".inflated", ".sphere", ".reg", ".orig", ".smoothwm", ".nofix", ".graymid",
    ".midthickness",
)  # fmt: skip
SINGLE = (".gii", *_FREESURFER)  # what holds coordinates of 32 bits


def read(path: str | os.PathLike[str], suffix: str, max_bytes: int | None = None) -> Mesh:
    """Read a mesh through the package for this suffix.

    Raises
    ------
    FileFormatError
        If the package cannot read the file, or what it read is no mesh of finite numbers.
    MissingExtraError
        If the package is not installed.
    """
    place = Path(path)
    with plain_file(place, suffix, max_bytes) as plain:
        room = room_of(place, place.stat().st_size, max_bytes)
        try:
            vertices, faces, data = READERS[suffix](plain, room)
        except MissingExtraError:
            raise
        except FileFormatError as error:  # of a copy, perhaps
            raise FileFormatError(place, error.problem, line=error.line, byte=error.byte) from error
        except (Exception, SystemExit) as cause:  # the packages raise anything on a broken file
            reason = f"{type(cause).__name__}: {cause}"
            raise FileFormatError(place, f"expected a {suffix} file ({reason})") from cause
    return _checked(place, np.asarray(vertices, np.float64), np.asarray(faces), data)


def _checked(place: Path, vertices: Any, faces: Any, data: dict[str, Any]) -> Mesh:
    if vertices.ndim != 2 or len(vertices) == 0 or len(faces) == 0:
        raise FileFormatError(place, "expected vertices and triangles or polygons, found none")
    if not np.isfinite(vertices).all():
        row = int(np.flatnonzero(~np.isfinite(vertices).all(axis=1))[0])
        raise FileFormatError(place, f"expected finite coordinates, found NaN in vertex {row}")
    corners = faces.astype(np.int64).reshape(-1, 3)
    outside = int(first_outside(corners.ravel(), len(vertices)))
    if outside >= 0:
        raise FileFormatError(place, f"expected indices of vertices in triangle {outside // 3}")
    uv = data.pop(_UV, None)
    kept = {name: a for name, a in data.items() if a.dtype.kind in "biuf" and a.ndim in (1, 2)}
    kept = {name: a for name, a in kept.items() if len(a) == len(vertices)}
    return Mesh(vertices, corners, kept, uv)


def _read_gifti(place: Path, room: Room) -> Any:
    nibabel = require("nibabel", "io", "reading GIFTI")
    require_room(place, ".gii", room)
    points, triangles = nibabel.load(place).agg_data(("pointset", "triangle"))
    return points, triangles, {}


def _read_freesurfer(place: Path, _room: Room) -> Any:
    freesurfer = require("nibabel.freesurfer", "io", "reading FreeSurfer surfaces")
    return (*freesurfer.read_geometry(place), {})


def _read_vtk(place: Path, room: Room) -> Any:
    source = Source(place)
    if not is_polydata(source):
        return _read_meshio(place, room)
    return _parts(read_polydata(source))


def _read_vtp(place: Path, room: Room) -> Any:
    return _parts(read_vtp(Source(place), room))


def _parts(found: PolyData) -> Any:
    if found.uv is None or found.uv.shape != (len(found.points), 2):
        return found.points, found.faces, found.data
    uv = np.where(np.isfinite(found.uv), found.uv, np.nan)[found.faces]
    return found.points, found.faces, {**found.data, _UV: uv}


def _read_meshio(place: Path, room: Room) -> Any:
    meshio = require("meshio", "io", f"reading {place.suffix}")
    require_room(place, place.suffix.lower(), room)
    found = _by_meshio(meshio, place)
    blocks = [b.data for b in found.cells if b.type in ("triangle", "quad", "polygon")]
    pieces = [
        fan(np.concatenate(b).astype(np.int64), np.array([len(c) for c in b])) for b in blocks
    ]
    faces = np.concatenate(pieces) if pieces else np.zeros((0, 3), np.int64)
    return found.points, faces, found.point_data


def _by_meshio(meshio: Any, place: Path) -> Any:
    """Read in the first of the formats of this suffix that fits; ``meshio.read`` would print."""
    reasons = []
    for name in meshio.extension_to_filetypes[place.suffix.lower()]:
        try:
            return getattr(meshio, name).read(str(place))
        except meshio.ReadError as error:
            reasons.append(f"{name}: {error}")
    raise FileFormatError(place, f"expected a {place.suffix} file ({'; '.join(reasons)})")


def _read_gltf(place: Path, _room: Room) -> Any:
    found = read_scene(place)
    told = {"normal": found.normal, "color": found.color, _UV: found.corner_uv}
    known = {name: array for name, array in told.items() if np.isfinite(array).any()}
    return found.vertices, found.faces, known


def encode(mesh: Mesh, vertices: Floats, suffix: str) -> bytes:
    """Return the bytes of a file of this format."""
    return WRITERS[suffix](mesh, vertices, suffix)


def _encode_gifti(mesh: Mesh, vertices: Floats, _suffix: str) -> bytes:
    gifti = require("nibabel.gifti", "io", "writing GIFTI")
    points = gifti.GiftiDataArray(
        vertices.astype(np.float32), intent="NIFTI_INTENT_POINTSET", datatype="NIFTI_TYPE_FLOAT32"
    )
    triangles = gifti.GiftiDataArray(
        mesh.faces.astype(np.int32), intent="NIFTI_INTENT_TRIANGLE", datatype="NIFTI_TYPE_INT32"
    )
    return bytes(gifti.GiftiImage(darrays=[points, triangles]).to_bytes())


def _encode_freesurfer(mesh: Mesh, vertices: Floats, suffix: str) -> bytes:
    freesurfer = require("nibabel.freesurfer", "io", "writing FreeSurfer surfaces")
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder, "lh" + suffix)
        freesurfer.write_geometry(place, vertices, mesh.faces, create_stamp="created by beltrami")
        return place.read_bytes()


def _encode_vtp(mesh: Mesh, vertices: Floats, _suffix: str) -> bytes:
    return vtp_bytes(mesh, vertices)


def _encode_meshio(mesh: Mesh, vertices: Floats, suffix: str) -> bytes:
    meshio = require("meshio", "io", f"writing {suffix}")
    data = {name: common(array) for name, array in mesh.vertex_data.items()}
    for name, array in data.items():
        _require_holdable(name, array.shape[1:], suffix)
    found = meshio.Mesh(np.array(vertices), [("triangle", np.array(mesh.faces))], point_data=data)
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder, "mesh" + suffix)
        found.write(place)
        return place.read_bytes()


def _require_holdable(name: str, columns: tuple[int, ...], suffix: str) -> None:
    """Refuse what meshio would write so that it does not come back."""
    unfit = "\t\r\n" + (" " if suffix == ".vtk" else '<&"')
    if not name or any(sign in name for sign in unfit):
        raise MeshError(
            f"{name!r} cannot be the name of vertex data in a {suffix} file",
            remedy="Give it a name of letters with mesh.with_data.",
        )
    if columns == (0,) or (columns == (2,) and suffix == ".vtk"):
        raise MeshError(
            f"a {suffix} file has no functions of {columns[0]} columns, as {name!r} is",
            remedy="Write .ply, or other columns.",
        )


READERS: dict[str, Callable[[Path, Room], Any]] = {
    ".gii": _read_gifti,
    **dict.fromkeys(_FREESURFER, _read_freesurfer),
    **dict.fromkeys(_MESHIO, _read_meshio),
    ".vtk": _read_vtk,
    ".vtp": _read_vtp,
    **dict.fromkeys(_GLTF, _read_gltf),
}
WRITERS: dict[str, Callable[[Mesh, Floats, str], bytes]] = {
    ".gii": _encode_gifti,
    **dict.fromkeys(_FREESURFER, _encode_freesurfer),
    ".vtk": _encode_meshio,
    ".vtp": _encode_vtp,
    ".vtu": _encode_meshio,
}
