"""beltrami tour: everything the package can do, on one mesh, in one folder."""

from __future__ import annotations

import time
import warnings
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from beltrami.cli.console import waiting
from beltrami.cli.remedies import as_commands
from beltrami.errors import BeltramiError, EmptyMeshError, check_name

if TYPE_CHECKING:
    from collections.abc import Callable

    from beltrami.cli.chapters.chapter import Chapter, Stage
    from beltrami.mesh.mesh import Mesh

MESH = "mesh.ply"  # written by the chapter about files


def tour(
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="FOLDER", help="Folder to write into.")
    ],
    mesh: Annotated[
        Path | None,
        typer.Argument(metavar="[MESH]", help="Mesh file; a shape of our own if not given."),
    ] = None,
    up: Annotated[
        str | None, typer.Option(help="Upward axis in pictures: x, y or z.", show_default="y")
    ] = None,
    view: Annotated[
        tuple[float, float] | None,
        typer.Option(help="Azimuth and elevation of the eye, in degrees.", show_default=False),
    ] = None,
) -> None:
    """Run everything on one mesh, and leave results and one index page in a folder."""
    from beltrami.cli.chapters.chapter import Stage
    from beltrami.cli.index_page import index_page
    from beltrami.io.atomic import replacing

    axis = check_name("axis", up or ("z" if mesh is None else "y"), ("x", "y", "z"))
    with waiting("preparing the mesh"):
        shape, notes = _prepared(mesh)
    output.mkdir(parents=True, exist_ok=True)
    chapters = _play(Stage(MESH, shape, output, axis, view))
    total = sum(chapter.seconds or 0 for chapter in chapters)
    notes.append(f"{len(chapters)} chapters in {total:.0f} seconds.")
    notes.append(f"The commands on this page run in its folder, on its {MESH}.")
    title = f"A tour of {'the blob' if mesh is None else mesh.name}"
    with replacing(output / "index.html") as file:
        file.write(index_page(title, notes, chapters).encode())
    typer.echo(f"{len(chapters)} chapters. Open {output / 'index.html'}")


def _prepared(path: Path | None) -> tuple[Mesh, list[str]]:
    """Read the mesh; what no operator accepts is repaired, and said."""
    from beltrami.io.registry import read_mesh
    from beltrami.mesh.repair import repair
    from beltrami.mesh.shapes import blob

    if path is None:
        return blob(20_000), ["The embedded shape: smooth limbs, a thin neck, a sharp crest."]
    fixed = repair(read_mesh(path), remove_degenerate_faces=True, remove_unreferenced=True)
    if fixed.mesh.n_faces == 0:
        raise EmptyMeshError(f"{path}: no face has an area, so there is nothing to show")
    notes = [f"Before the tour, on a copy: {line}." for line in fixed.done]
    for note in notes:
        typer.echo(note)
    return fixed.mesh, notes


def _play(stage: Stage) -> list[Chapter]:
    """Run the chapters; one that cannot be run on this mesh says why, and the others go on."""
    from beltrami.cli.chapters.averaging import averaging
    from beltrami.cli.chapters.chapter import Chapter
    from beltrami.cli.chapters.compression import compression
    from beltrami.cli.chapters.denoising import denoising
    from beltrami.cli.chapters.files import files
    from beltrami.cli.chapters.geodesics import geodesics
    from beltrami.cli.chapters.grid import grid
    from beltrami.cli.chapters.heat import heat
    from beltrami.cli.chapters.interactive import interactive
    from beltrami.cli.chapters.maps import maps
    from beltrami.cli.chapters.operators import operators
    from beltrami.cli.chapters.spectrum import spectrum
    from beltrami.cli.chapters.surface import surface
    from beltrami.cli.chapters.waves import waves

    acts: tuple[Callable[[Stage], Chapter], ...] = (
        interactive, surface, operators, averaging, grid, heat, denoising, waves, spectrum,
        compression, maps,
        geodesics, files,
    )  # fmt: skip
    played = []
    with waiting("touring") as progress:
        for done, act in enumerate(acts):
            progress(done, len(acts))
            start = time.perf_counter()
            with warnings.catch_warnings(record=True) as warned:
                warnings.simplefilter("always")
                try:
                    chapter = act(stage)
                except BeltramiError as error:
                    title = act.__name__.capitalize()
                    why = f"Not on this mesh: {as_commands(str(error))}"
                    chapter = Chapter(title, "", (why,))
                    typer.echo(f"{title}: {why}", err=True)
            told = tuple(dict.fromkeys(str(one.message) for one in warned))
            seconds = time.perf_counter() - start
            played.append(replace(chapter, seconds=seconds, warnings=told))
    return played
