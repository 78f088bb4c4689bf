"""The surface: topology, geometry and light (section 3.1, figure 3.1)."""

from __future__ import annotations

import numpy as np

from beltrami.cli.chapters.chapter import Chapter, Stage, number
from beltrami.cli.remedies import as_commands
from beltrami.display.light import SpotLight, light_intensity
from beltrami.mesh.diagnose import diagnose


def surface(stage: Stage) -> Chapter:
    """Diagnose the mesh, draw it, its faces from near, and its light."""
    mesh = stage.mesh
    diagnosis = diagnose(mesh)
    angles = np.degrees(mesh.corner_angles)
    rows = (
        ("vertices, edges, faces", f"{mesh.n_vertices}, {diagnosis.n_edges}, {mesh.n_faces}"),
        ("components", str(diagnosis.n_components)),
        ("boundary loops", _or_undefined(diagnosis.n_boundary_loops)),
        ("Euler characteristic", str(diagnosis.euler_characteristic)),
        ("genus", _or_undefined(diagnosis.genus)),
        ("manifold, oriented", f"{_said(diagnosis.is_manifold)}, {_said(diagnosis.is_oriented)}"),
        ("area", number(diagnosis.area)),
        ("volume", "undefined" if diagnosis.volume is None else number(diagnosis.volume)),
        ("mean edge length", number(float(mesh.edge_lengths.mean()))),
        ("smallest, largest angle", f"{angles.min():.1f}°, {angles.max():.1f}°"),
        ("faces with an obtuse angle", f"{(angles > 90).any(axis=1).mean():.1%}"),
    )
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    figures = [
        stage.draw("surface.png", "The surface, in perspective, shaded by Gouraud.", mesh),
        stage.draw(
            "faces.png",
            "Its faces from near.",
            mesh,
            zoom=6,
            focus=_farthest(mesh.vertices),
            wireframe=True,
            shading="flat",
        ),
    ]
    if mesh.dimension == 3:
        top = {"x": 0, "y": 1, "z": 2}[stage.up]
        above = (low + high) / 2
        above[top] = high[top] + (high - low).max()
        intensity = light_intensity(mesh, SpotLight(above))
        figures.append(
            stage.draw(
                "light.png",
                "The light of a spot above: I(i) = max(⟨n, l⟩, 0), a function on the vertices. "
                f"It reaches {np.mean(intensity > 0):.0%} of them.",
                mesh,
                intensity,
                limits=(0, 1),
            )
        )
    return Chapter(
        "The surface",
        "3.1",
        tuple(as_commands(line).removeprefix("- ") for line in diagnosis.report().splitlines()[4:]),
        (("quantity", "value"), *rows),
        tuple(figures),
        commands=(f"beltrami info {stage.name}", f"beltrami render {stage.name} -o surface.png"),
    )


def _or_undefined(count: int | None) -> str:
    return "undefined" if count is None else str(count)


def _said(truth: bool) -> str:
    return "yes" if truth else "no"


def _farthest(vertices: np.ndarray) -> np.ndarray:
    """Return a place near the vertex farthest from the middle, in space: there is much to see."""
    middle = vertices.mean(axis=0)
    place = vertices[((vertices - middle) ** 2).sum(axis=1).argmax()]
    place = place + 0.1 * (middle - place)  # so that the surface, not its end, fills the picture
    return np.pad(place, (0, 3 - len(place)))
