"""glTF, read through trimesh: all the surfaces of a scene, each where it stands in it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._optional import require


def read_scene(place: Path) -> tuple[Floats, Integers, Floats | None]:
    """Return vertices, faces, and (n, 2) texture coordinates, NaN for a surface without any.

    trimesh would join the surfaces by itself, but joins their textures to a new picture too, on
    which the coordinates of the file mean nothing.
    """
    trimesh = require("trimesh", "io", f"reading {place.suffix}")
    scene = trimesh.load_scene(place, process=False)
    points, corners, turns, count = [], [], [], 0
    for node in scene.graph.nodes_geometry:
        turn, name = scene.graph[node]
        surface = scene.geometry[name]
        if not isinstance(surface, trimesh.Trimesh):
            continue
        x, faces = np.asarray(surface.vertices), np.asarray(surface.faces, np.int64)
        if (faces < 0).any() or (faces >= len(x)).any():
            raise ValueError("a face names a vertex that is not there")
        mirrored = np.linalg.det(turn[:3, :3]) < 0
        points.append(x if (turn == np.eye(4)).all() else x @ turn[:3, :3].T + turn[:3, 3])
        corners.append((faces[:, ::-1] if mirrored else faces) + count)
        turns.append(_coordinates(surface, len(x)))
        count += len(x)
    if not points:
        return np.zeros((0, 3)), np.zeros((0, 3), np.int64), None
    uv = np.concatenate(turns)
    known = bool(np.isfinite(uv).any())
    return np.concatenate(points), np.concatenate(corners), uv if known else None


def _coordinates(surface: Any, n: int) -> Floats:
    uv = getattr(surface.visual, "uv", None)
    if uv is None or np.shape(uv) != (n, 2):
        return np.full((n, 2), np.nan)
    return np.asarray(uv, np.float64)
