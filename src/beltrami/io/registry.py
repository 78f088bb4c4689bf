"""read_mesh and write_mesh: the format is told by the suffix."""

from __future__ import annotations

import gzip
import os
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import DROP, Floats, as_floats, require_finite
from beltrami._kinds import checked
from beltrami.errors import (
    DimensionError,
    EmptyMeshError,
    FileFormatError,
    MeshError,
    check_name,
)
from beltrami.io import extras
from beltrami.io.atomic import replacing
from beltrami.io.glb_write import glb_bytes, write_glb
from beltrami.io.obj import read_obj
from beltrami.io.obj_write import corner_texture, material_text, write_obj
from beltrami.io.off import read_off
from beltrami.io.off_write import write_off
from beltrami.io.picture import Picture, png_bytes
from beltrami.io.ply import read_ply
from beltrami.io.ply_write import write_ply
from beltrami.io.source import POINTS_ONLY, Source, load
from beltrami.io.stl import read_stl, write_stl
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh

READERS: dict[str, Callable[[Source], Mesh]] = {
    ".obj": read_obj,
    ".off": read_off,
    ".ply": read_ply,
    ".stl": read_stl,
}
WRITERS: dict[str, Callable[[IO[bytes], Mesh, Floats], None]] = {
    ".obj": write_obj,
    ".off": write_off,
    ".ply": write_ply,
    ".stl": write_stl,
    ".glb": write_glb,
}
TEXTURED = (".obj", ".glb")
_FLOAT32_MAX = float(np.finfo(np.float32).max)


@checked
def read_mesh(
    path: str | os.PathLike[str],
    format: str | None = None,  # noqa: A002 - the public name
    *,
    max_bytes: int | None = None,
) -> Mesh:
    r"""Read a triangle mesh from a file.

    OBJ, OFF, PLY, STL and VTK's surfaces (``.vtp``, and legacy ``.vtk``) are read here, checked
    byte by byte; the extra ``io`` adds GIFTI, FreeSurfer, glTF, other VTK files and more. Any of
    them may be compressed, as in ``mesh.obj.gz``. Polygons are cut into triangles from their
    first corner. The vertices stay in the order of the file, and nothing is merged, except what a
    format has to part: in STL exactly equal corners are one vertex, in glTF vertices that differ
    only in their texture coordinates.

    Parameters
    ----------
    path
        The file.
    format
        A suffix such as ``".obj"`` where the name of the file does not tell; upper case, or the
        dot left out, make no difference.
    max_bytes
        What a compressed file may unpack to; by default 256 MiB, or 100 times its size if that
        is more, so that a few bytes cannot fill the memory.

    Returns
    -------
    Mesh
        With ``vertex_data`` (PLY, VTK, COFF, NOFF, coloured OBJ, glTF's normals and colours, as
        sRGB values in [0, 1]) and ``corner_uv`` (OBJ, PLY, VTK, glTF).

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    UnknownNameError
        If the suffix is not known; it lists those that are.
    FileFormatError
        If the file is not what its format promises; it names the line or the byte. Also if it
        unpacks to more than ``max_bytes``.
    MissingExtraError
        If the format needs a package that is not installed.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     place = pathlib.Path(folder, "triangle.off")
    ...     _ = place.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    ...     read_mesh(place).faces.tolist()
    [[0, 1, 2]]
    """
    if Path(path).is_dir():
        raise FileFormatError(path, "expected a file, found a directory. Name a file in it")
    if format is None and Path(path).suffix.lower() == ".xyz":
        raise FileFormatError(path, f"expected a format with faces{POINTS_ONLY}")
    suffix = suffix_of(path, format, (*READERS, *extras.READERS))
    if suffix in READERS:
        return READERS[suffix](load(path, max_bytes))
    return extras.read(path, suffix, max_bytes)


@checked
def write_mesh(
    path: str | os.PathLike[str],
    mesh: Mesh,
    uv: ArrayLike | None = None,
    texture: Picture | None = None,
) -> None:
    """Write a mesh to a file: wholly, or on any error or interrupt not at all.

    What a format cannot hold is left out: OBJ keeps coordinates, texture coordinates and the
    vertex data "color"; OFF coordinates, "color" and "normal"; PLY coordinates, all numeric
    vertex data, with their types, and texture coordinates; VTP too, but texture coordinates only
    if no vertex has two pairs of them; STL only coordinates, rounded to 32 bits, as in GIFTI and
    FreeSurfer's files (``lh.pial`` ...); GLB, in 32 bits too, what OBJ keeps, and normals, so that
    viewers shade it smoothly (see ``glb_bytes``). Everything else reads back bit for bit. A flat
    mesh (d = 2) is written with z = 0.

    Parameters
    ----------
    path
        The file; its suffix is the format, ``.gz`` after it compresses.
    mesh
        The mesh, finite and with faces: what is written can be read.
    uv
        Texture coordinates (n, 2), or (m, 3, 2) for each corner, instead of ``mesh.corner_uv``:
        only for OBJ, PLY and GLB, which holds them in single precision, and needs a copy of each
        vertex for each of its coordinates.
    texture
        A picture to go with them, a file or an array: see ``render``. GLB holds it; with
        ``a.obj`` the files ``a.mtl`` and ``a.png`` are written.

    Raises
    ------
    UnknownNameError
        If the suffix is not known, or cannot hold ``uv`` or ``texture``.
    MeshError, FileFormatError
        If there is a texture but no coordinates, or it is no picture; or if the name of vertex
        data, or the number of their columns, is none that VTK's formats have.
    DimensionError
        If the vertices have more than three coordinates, or ``uv`` another shape.
    EmptyMeshError
        If there are no faces.
    NonFiniteError
        If a coordinate is NaN or infinite, or too large for 32 bits where the format has those.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> mesh = Mesh([[0.1, 0], [1, 0], [0, 1]], [[0, 1, 2]])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_mesh(pathlib.Path(folder, "flat.ply"), mesh)
    ...     read_mesh(pathlib.Path(folder, "flat.ply")).vertices[0].tolist()
    [0.1, 0.0, 0.0]
    """
    suffix = suffix_of(path, None, (*WRITERS, *extras.WRITERS))
    vertices = _writable(mesh, suffix)
    material = ""
    turns = None if uv is None else as_floats(uv)
    if turns is not None or texture is not None:
        holding = TEXTURED if texture is not None else (*TEXTURED, ".ply")
        check_name("format for texture coordinates", suffix, holding)
        corner_texture(mesh, turns)  # before anything is written
    if texture is not None:
        if turns is None and mesh.corner_uv is None:
            raise MeshError(
                "a texture without texture coordinates",
                remedy="Write parameterize(mesh).textured or atlas(mesh).mesh.",
            )
        corner_texture(mesh, turns)  # before anything is written
        if suffix == ".obj":
            material = _write_material(Path(path), texture)
    with replacing(path) as whole:
        if Path(path).suffix.lower() == ".gz":
            with gzip.GzipFile("", "wb", fileobj=whole, mtime=0) as file:
                _write(file, mesh, vertices, suffix, turns, texture, material)
        else:
            _write(whole, mesh, vertices, suffix, turns, texture, material)


def _write_material(path: Path, texture: Picture) -> str:
    """Write the picture and the material beside an OBJ file; return the name of the latter."""
    stem = path.with_suffix("") if path.suffix.lower() == ".gz" else path
    picture, material = stem.with_suffix(".png"), stem.with_suffix(".mtl")
    with replacing(picture) as file:
        file.write(png_bytes(texture))
    with replacing(material) as file:
        file.write(material_text(picture.name))
    return material.name


def suffix_of(path: str | os.PathLike[str], form: str | None, known: tuple[str, ...]) -> str:
    """Return the suffix in lower case, without ``.gz``, if it is known.

    Examples
    --------
    >>> suffix_of("a.OBJ.gz", None, (".obj",)), suffix_of("a", "obj", (".obj",))
    ('.obj', '.obj')
    """
    if form is not None:
        return check_name("format", "." + str(form).lower().lstrip("."), known)
    place = Path(os.fspath(path).lower())
    if place.suffix == ".gz":
        place = place.with_suffix("")
    return check_name("file format", place.suffix, known)


def _write(
    file: Any,
    mesh: Mesh,
    vertices: Floats,
    suffix: str,
    uv: Floats | None,
    texture: Picture | None,
    material: str,
) -> None:
    if suffix == ".obj":
        write_obj(file, mesh, vertices, uv, material)
    elif suffix == ".glb":
        file.write(glb_bytes(mesh, vertices, corner_texture(mesh, uv), texture))
    elif suffix == ".ply" and uv is not None:
        turns = corner_texture(mesh, uv)
        write_ply(file, Mesh(mesh.vertices, mesh.topology, mesh.vertex_data, turns), vertices)
    elif suffix in WRITERS:
        WRITERS[suffix](file, mesh, vertices)
    else:
        file.write(extras.encode(mesh, vertices, suffix))


def _writable(mesh: Mesh, suffix: str) -> Floats:
    """Return the vertices as (n, 3), checked."""
    n, d = require_mesh(mesh, "a file").vertices.shape
    if d > 3:
        raise DimensionError(
            f"the vertices have {d} coordinates, and a file holds 3",
            remedy="Choose three of them with mesh.with_vertices(mesh.vertices[:, :3]).",
        )
    if mesh.n_faces == 0:
        raise EmptyMeshError("a mesh without faces cannot be written", remedy="Add faces.")
    require_finite(mesh.vertices, "the coordinates", DROP)
    if suffix in (".stl", ".glb", *extras.SINGLE):
        small = np.where(np.abs(mesh.vertices) <= _FLOAT32_MAX, mesh.vertices, np.inf)
        require_finite(small, f"the coordinates, rounded to the 32 bits of {suffix[1:].upper()},")
    return mesh.vertices if d == 3 else np.hstack([mesh.vertices, np.zeros((n, 3 - d))])
