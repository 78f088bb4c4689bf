"""Writing OBJ: vertices, their colours, texture coordinates and triangles."""

from __future__ import annotations

from typing import IO

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats
from beltrami.errors import DimensionError
from beltrami.io.text import write_rows
from beltrami.mesh.mesh import Mesh

MATERIAL = "texture"


def write_obj(
    file: IO[bytes], mesh: Mesh, vertices: Floats, uv: Floats | None = None, material: str = ""
) -> None:
    """Write an OBJ file with numbers that read back bit for bit.

    Texture coordinates are ``uv``, (n, 2) or (m, 3, 2), or else ``mesh.corner_uv``; equal ones
    are written once, a corner with NaN has none. The vertex data "color" goes along, (n, 3) or
    (n, 4), bytes as fractions of 255; other vertex data are left out. ``material`` is the name of
    an MTL file, whose material ``MATERIAL`` all faces get.

    Raises
    ------
    DimensionError
        If ``uv`` has another shape.

    Examples
    --------
    >>> import io
    >>> from beltrami.mesh.mesh import Mesh
    >>> mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> file = io.BytesIO()
    >>> write_obj(file, mesh, mesh.vertices)
    >>> file.getvalue().splitlines()[-1]
    b'f 1 2 3'
    """
    if material:
        file.write(f"mtllib {material}\n".encode())
    rows = np.hstack([vertices, vertex_colours(mesh)])
    write_rows(file, "v" + " %r" * rows.shape[1], rows)
    corner_uv = corner_texture(mesh, uv)
    if corner_uv is None:
        write_rows(file, "f %d %d %d", mesh.faces + 1)
        return
    points, turns = _shared(corner_uv)
    write_rows(file, "vt %r %r", points)
    if material:
        file.write(f"usemtl {MATERIAL}\n".encode())
    both = np.stack([mesh.faces + 1, turns + 1], axis=2).reshape(-1, 6)
    textured = np.asarray((turns >= 0).all(axis=1))
    edges = np.flatnonzero(np.diff(textured)) + 1
    for block, first in zip(np.split(both, edges), [0, *edges.tolist()], strict=True):
        if len(block) and textured[first]:
            write_rows(file, "f %d/%d %d/%d %d/%d", block)
        else:
            for face in block.tolist():
                corners = zip(face[::2], face[1::2], strict=True)
                words = (f"{i}/{t}" if t > 0 else f"{i}" for i, t in corners)
                file.write(f"f {' '.join(words)}\n".encode("ascii"))


def material_text(picture: str) -> bytes:
    """Return an MTL file: the material ``MATERIAL``, with the colours of a picture file."""
    return f"newmtl {MATERIAL}\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd {picture}\n".encode()


def vertex_colours(mesh: Mesh) -> Floats:
    """Return the vertex data "color" as fractions, (n, 3) or (n, 4); (n, 0) if there are none."""
    colour = mesh.vertex_data.get("color")
    if colour is None or colour.ndim != 2 or colour.shape[1] not in (3, 4):
        return np.empty((mesh.n_vertices, 0))
    if colour.dtype.kind not in "uif" or not np.isfinite(colour).all():
        return np.empty((mesh.n_vertices, 0))
    return colour / 255.0 if colour.dtype == np.uint8 else colour.astype(np.float64)


def corner_texture(mesh: Mesh, uv: Floats | None) -> Floats | None:
    """Return the texture coordinates (m, 3, 2): ``uv``, or else those of the mesh."""
    if uv is None:
        return mesh.corner_uv
    if uv.shape == (mesh.n_vertices, 2):
        return uv[mesh.faces]
    if uv.shape == (mesh.n_faces, 3, 2):
        return uv
    raise DimensionError(
        f"uv have the shape {uv.shape} where ({mesh.n_vertices}, 2) or ({mesh.n_faces}, 3, 2) is "
        "needed",
        remedy="Give one row for each vertex, or one for each corner of each face.",
    )


def _shared(corner_uv: Floats) -> tuple[Floats, NDArray[np.int64]]:
    """Label the different points in the order of first use; -1 where one is not finite."""
    flat = np.ascontiguousarray(corner_uv).reshape(-1, 2)
    kept = np.isfinite(flat).all(axis=1)
    keys = np.ascontiguousarray(flat[kept]).view("V16").ravel()
    _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.int64)
    order = np.argsort(first)
    rank[order] = np.arange(len(first))
    turns = np.full(len(flat), -1)
    turns[kept] = rank[inverse.ravel()]
    return flat[kept][np.sort(first)], turns.reshape(-1, 3)
