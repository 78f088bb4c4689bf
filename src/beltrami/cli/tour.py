"""beltrami tour: everything the package can do, on one mesh, in one folder."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from beltrami.cli.console import waiting
from beltrami.errors import EmptyMeshError, check_name

if TYPE_CHECKING:
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
    start = time.perf_counter()
    chapters = _play(Stage(MESH, shape, output, axis, view))
    notes.append(f"{len(chapters)} chapters in {time.perf_counter() - start:.0f} seconds.")
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
    from beltrami.cli.playing import play

    with waiting("touring") as progress:
        played = play(stage, progress)
    for chapter, possible in played:
        if not possible:
            typer.echo(f"{chapter.title}: {chapter.text[0]}", err=True)
    return [chapter for chapter, _ in played]
