"""Maps: to the plane without a fold, charts in a square, pictures on the surface (3.3.7, 3.3.8)."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats
from beltrami.cli.chapters.chapter import Chapter, Figure, Stage, number
from beltrami.display.srgb import from_oklab
from beltrami.display.texture import checkerboard
from beltrami.errors import NotManifoldError
from beltrami.io.registry import write_mesh
from beltrami.parameterization.atlas import atlas
from beltrami.parameterization.flatten import flatten
from beltrami.parameterization.parameterization import Parameterization
from beltrami.parameterization.parameterize import parameterize
from beltrami.parameterization.texture_atlas import TextureAtlas

COUNT = 8  # charts to begin with: fewer take longer
MAX_DISTORTION = 1.2
_GOLDEN = 2.399963229728653  # turns of the hue from chart to chart, in radians


def maps(stage: Stage) -> Chapter:
    """Map the surface as one disk in three ways, flatten it, and make an atlas of it.

    Chapter items: F3.10, F3.11, P71.
    """
    mesh = stage.mesh
    disks = {
        "circle, combinatorial weights": parameterize(mesh, "tutte", "combinatorial", strict=False),
        "circle, reweighted": parameterize(mesh, strict=False),
        "free boundary": parameterize(mesh, "free", strict=False),
    }
    rows = {name: _row(psi) for name, psi in disks.items()}
    notes = []
    try:
        rows["two eigenvectors (theorem 22)"] = _row(flatten(mesh))
    except NotManifoldError:
        notes.append("Eigenvectors are not drawn: the surface is not a manifold.")
    count = min(COUNT, mesh.n_faces)
    found = atlas(mesh, count, max_distortion=MAX_DISTORTION)
    rows[f"atlas of {found.count} charts"] = _row(found.map)
    write_mesh(stage.folder / "textured.obj", found.mesh, texture=checkerboard())
    whole = disks["free boundary"]
    return Chapter(
        "Maps",
        "3.3.7, 3.3.8",
        (
            "Where the surface is no disk it is cut along edges until it is one. If its boundary "
            "goes around a convex curve and each vertex is a weighted mean of its neighbours, no "
            "face turns over (Tutte): here that is decided from the exact signs of all faces and "
            "crossings of the boundary. Eigenvectors have no such promise.",
            "An atlas cuts the surface into disks until the distortion of each is small, and packs "
            "them in a square: a picture for every surface, with texels of one size.",
            *notes,
        ),
        (
            ("map", "edges cut", "flipped faces", "conformal", "area", "sym. Dirichlet"),
            *((name, *row) for name, row in rows.items()),
        ),
        (
            _distorted(stage, disks),
            stage.draw(
                "checkerboard.png",
                "A checkerboard through the map of one piece with a free boundary, and through the "
                "atlas: where squares are square and alike, angles and areas are kept.",
                [whole.textured, found.mesh],
                texture="checkerboard",
                caption=["one piece", "atlas"],
                size=(420, None),
            ),
            *_charts(stage, found),
        ),
        (
            ("textured.obj", "the mesh with the coordinates of the atlas"),
            ("textured.mtl", "its material"),
            ("textured.png", "its texture"),
        ),
        (
            f"beltrami parameterize {stage.name} -o map.obj --method free",
            f"beltrami atlas {stage.name} -o textured.obj --count {count} --max-distortion "
            f"{MAX_DISTORTION} --texture checkerboard",
        ),
    )


def _row(psi: Parameterization) -> tuple[str, ...]:
    """Write what is told of a map; what is infinite where a face has no area is a dash."""
    values = psi.distortion
    numbers = (values.mean_conformal, values.mean_area, values.symmetric_dirichlet)
    told = (number(value) if np.isfinite(value) else "-" for value in numbers)
    return str(len(psi.cut_edges)), str(len(psi.flipped)), *told


def _distorted(stage: Stage, disks: dict[str, Parameterization]) -> Figure:
    """Draw the images in the plane, with their distortion in colour."""
    return stage.draw(
        "maps.png",
        "The surface in the plane, and the distortion of each place: the logarithm to the base 10 "
        "of the symmetric Dirichlet energy, 0 where lengths are kept.",
        [psi.flat for psi in disks.values()],
        [at_vertices(psi) for psi in disks.values()],
        caption=list(disks),
        limits=(0.0, 2.0),
        size=(300, 300),
        up="y",
        view=None,
        level_set=None,
    )


def at_vertices(psi: Parameterization) -> Floats:
    """Return the logarithm of the energy, in the mean over the faces around each vertex."""
    energy = np.log10(np.clip(psi.distortion.energy, 1.0, 1e12))
    around, areas = psi.mesh.topology.vertex_faces, psi.distortion.areas
    return np.asarray((around @ (areas * energy)) / (around @ areas))


def _charts(stage: Stage, found: TextureAtlas) -> tuple[Figure, Figure]:
    """Draw the charts on the surface and in the square."""
    label = np.empty(found.map.mesh.n_vertices, np.int64)
    label[found.map.mesh.faces.ravel()] = np.repeat(found.labels, 3)
    turn = _GOLDEN * label
    lab = np.stack([0.76 - 0.1 * (label % 3 == 1), 0.1 * np.cos(turn), 0.1 * np.sin(turn)], axis=1)
    colors = np.clip(from_oklab(lab), 0, 1)
    surface = stage.draw("charts.png", "The charts on the surface.", found.map.mesh, colors)
    told = f"The {found.count} charts in the square, of which they fill {found.fill:.0%}."
    flat = found.map.flat
    square = stage.draw("square.png", told, flat, colors, up="y", view=None, size=(460, 460))
    return surface, square
