"""Files: the mesh in four formats, and back (formats by suffix)."""

from __future__ import annotations

import numpy as np

from beltrami.cli.chapters.chapter import Chapter, Stage
from beltrami.io.registry import read_mesh, write_mesh

FORMATS = {
    ".obj": "text, uv of the corners",
    ".off": "text, nothing but the mesh",
    ".ply": "binary, functions on the vertices",
    ".stl": "binary, float32 corners, welded on reading",
}


def files(stage: Stage) -> Chapter:
    """Write the mesh in each format, read it back, and compare."""
    rows = tuple((suffix, *_round_trip(stage, suffix), text) for suffix, text in FORMATS.items())
    return Chapter(
        "Files",
        "",
        ("Text and PLY give the same numbers back, bit for bit; STL has float32 ones.",),
        (("format", "bytes", "faces back", "largest difference", "holds"), *rows),
        files=tuple((f"mesh{suffix}", text) for suffix, text in FORMATS.items()),
    )


def _round_trip(stage: Stage, suffix: str) -> tuple[str, str, str]:
    path = stage.folder / f"mesh{suffix}"
    write_mesh(path, stage.mesh)
    back = read_mesh(path)
    space = np.zeros((stage.mesh.n_vertices, 3))
    space[:, : stage.mesh.dimension] = stage.mesh.vertices
    corners = back.vertices[back.faces] - space[stage.mesh.faces]
    difference = float(np.abs(corners).max())
    return str(path.stat().st_size), str(back.n_faces), f"{difference:.1e}"
