"""glTF, read through trimesh: all the surfaces of a scene, each where it stands in it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._optional import require
from beltrami.io.light import colours_of
from beltrami.io.weld import alike


class Surface(NamedTuple):
    """Vertices, faces, and what is told of each vertex or corner; NaN where nothing is."""

    vertices: Floats
    faces: Integers
    normal: Floats
    color: Floats
    corner_uv: Floats


def read_scene(place: Path) -> Surface:
    """Return the surfaces of a file side by side.

    trimesh would join them by itself, but joins their textures to a new picture too, on which
    the coordinates of the file mean nothing.
    """
    trimesh = require("trimesh", "io", f"reading {place.suffix}")
    gltf = require("trimesh.exchange.gltf", "io", f"reading {place.suffix}")
    load = gltf.load_glb if place.suffix.lower() == ".glb" else gltf.load_gltf
    with place.open("rb") as file:
        told = load(file, resolver=trimesh.resolvers.FilePathResolver(str(place)), process=False)
    graph = trimesh.load_scene(told).graph
    found: list[Surface] = []
    count = 0
    for node in graph.nodes_geometry:
        turn, name = graph[node]
        if "faces" not in told["geometry"][name]:  # points, or lines
            continue
        surface = _moved(_welded(_surface(told["geometry"][name])), turn)
        found.append(surface._replace(faces=surface.faces + count))
        count += len(surface.vertices)
    width = max((s.color.shape[1] for s in found), default=0)
    parts = [s._replace(color=_widened(s.color, width)) for s in found] or [_NOTHING]
    return Surface(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))


def _surface(told: dict[str, Any]) -> Surface:
    """Take what trimesh found in a primitive, before it makes a mesh of it.

    A mesh of trimesh would round colours to eight bits, and make up normals that are not told.
    """
    x, faces = np.asarray(told["vertices"], np.float64), np.asarray(told["faces"], np.int64)
    n = len(x)
    if (faces < 0).any() or (faces >= n).any():
        raise ValueError("a face names a vertex that is not there")
    visual = told.get("visual")
    coordinates = getattr(visual, "uv", None)
    if coordinates is None or np.shape(coordinates) != (n, 2):
        coordinates = np.full((n, 2), np.nan)
    colours = told.get("vertex_colors", getattr(visual, "vertex_attributes", {}).get("color"))
    normals = told.get("vertex_normals")
    if normals is None or np.shape(normals) != (n, 3):
        normals = np.full((n, 3), np.nan)
    uv = np.where(np.isfinite(coordinates), coordinates, np.nan)
    return Surface(x, faces, np.asarray(normals, np.float64), _colours(colours, n), uv[faces])


def _colours(told: Any, n: int) -> Floats:
    """Return sRGB values in [0, 1], (n, 3) or (n, 4), of linear light; (n, 0) without any."""
    light = np.empty((n, 0)) if told is None else np.asarray(told)
    if light.shape not in ((n, 3), (n, 4)):
        return np.empty((n, 0))
    whole = light.dtype.kind == "u"
    return colours_of(light / np.iinfo(light.dtype).max if whole else light.astype(np.float64))


def _welded(surface: Surface) -> Surface:
    """Join vertices that differ in their texture coordinates only.

    A file has them once for each side of a seam, as it has one index for all that it tells of a
    vertex. The surface itself has no seam there.
    """
    if np.isnan(surface.corner_uv).all():
        return surface
    first, labels = alike(np.hstack([surface.vertices, surface.normal, surface.color]))
    return Surface(
        surface.vertices[first],
        labels[surface.faces],
        surface.normal[first],
        surface.color[first],
        surface.corner_uv,
    )


def _moved(surface: Surface, turn: Floats) -> Surface:
    """Put a surface in its place; a mirror turns its faces, which stay outside."""
    linear = turn[:3, :3]
    if (turn == np.eye(4)).all():
        return surface
    x = surface.vertices @ linear.T + turn[:3, 3]
    signed = np.linalg.det(linear)
    normal = surface.normal
    if signed != 0:  # as a plane is moved: by the transposed inverse
        normal = normal @ np.linalg.inv(linear)
        length = np.linalg.norm(normal, axis=1, keepdims=True)
        normal = np.divide(normal, length, out=np.zeros_like(normal), where=length != 0)
    moved = surface._replace(vertices=x, normal=normal)
    if signed >= 0:
        return moved
    return moved._replace(faces=moved.faces[:, ::-1], corner_uv=moved.corner_uv[:, ::-1])


def _widened(color: Floats, width: int) -> Floats:
    """Return colours of this width: NaN where there are none, opaque where nothing else is told."""
    n, found = color.shape
    if found == 3 < width:
        return np.hstack([color, np.ones((n, 1))])
    return color if found == width else np.full((n, width), np.nan)


_NOTHING = Surface(
    np.zeros((0, 3)),
    np.zeros((0, 3), np.int64),
    np.zeros((0, 3)),
    np.zeros((0, 0)),
    np.zeros((0, 3, 2)),
)
