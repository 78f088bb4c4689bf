"""Geodesics: distances along the surface, by two steps of linear algebra."""

from __future__ import annotations

import numpy as np

from beltrami.cli.chapters.chapter import Chapter, Stage, number
from beltrami.geodesics.distance import geodesic_distance
from beltrami.io.registry import write_mesh

LINES = 24


def geodesics(stage: Stage) -> Chapter:
    """Measure distances from the farthest tip, and compare them with paths along the edges."""
    mesh = stage.mesh
    source = int(np.linalg.norm(mesh.vertices - mesh.vertices.mean(axis=0), axis=1).argmax())
    heat = geodesic_distance(mesh, source)
    edges = geodesic_distance(mesh, source, method="edges")
    reached = np.isfinite(heat) & (edges > 0)
    far = int(np.where(reached, heat, 0).argmax())
    straight = np.linalg.norm(mesh.vertices - mesh.vertices[source], axis=1)
    rows = tuple(
        (name, number(values[far]), number(float((values[reached] / heat[reached]).mean())))
        for name, values in (
            ("through space", straight),
            ("along the surface, by heat", heat),
            ("along the edges", edges),
        )
    )
    shown = np.where(np.isfinite(heat), heat, 0)
    levels = np.linspace(0, float(shown.max()), LINES + 2)[1:-1]
    write_mesh(stage.folder / "distance.ply", mesh.with_data(distance=shown))
    lost = int((~np.isfinite(heat)).sum())
    return Chapter(
        "Geodesics",
        "beyond the chapter",
        (
            "Heat that has spread for a short time flows away from its source along the shortest "
            "paths. Its gradient, made of length 1, is the gradient of the distance; one Poisson "
            "problem gives the distance itself (Crane, Weischedel and Wardetzky, 2013).",
            *(
                (f"{lost} vertices are not joined to the source; they are drawn as 0.",)
                * bool(lost)
            ),
        ),
        (("distance to the farthest vertex", "value", "mean ratio to heat"), *rows),
        (
            stage.draw(
                "geodesics.png",
                f"Distance from the tip that is farthest out, and {LINES} lines of equal distance.",
                mesh,
                shown,
                level_set=levels.tolist(),
            ),
        ),
        (("distance.ply", "the mesh with the distance as data"),),
        (f"beltrami geodesics {stage.name} --source {source} -o distance.ply",),
    )
