"""beltrami page: a mesh in one HTML file that computes in the browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from beltrami.cli.console import waiting
from beltrami.cli.functions import read_data
from beltrami.cli.options import Data, DataName, MeshFile
from beltrami.cli.outputs import check_page_output
from beltrami.cli.remedies import as_commands

Option = typer.Option


def page(
    mesh: MeshFile,
    output: Annotated[Path, Option("-o", "--output", metavar="FILE", help="Page to write: .html.")],
    data: Data = None,
    data_name: DataName = None,
    title: Annotated[
        str | None, Option(help="What it is called.", show_default="the name of the mesh")
    ] = None,
    modes: Annotated[
        int, Option("-k", "--modes", min=1, metavar="K", help="Eigenpairs of each Laplacian.")
    ] = 64,
    weights: Annotated[
        list[str] | None,
        Option(
            help="Laplacians, one option each: combinatorial, distance, cotangent ...",
            show_default="cotangent, combinatorial and distance",
        ),
    ] = None,
    plane: Annotated[bool, Option("--plane/--no-plane", help="Map the mesh to the plane.")] = True,
    noise: Annotated[
        float,
        Option(help="Noise of the copy that is denoised, in mean edge lengths; 0: no copy."),
    ] = 0.2,
    up: Annotated[str, Option(help="Upward axis at first: x, y or z.")] = "y",
    unit: Annotated[str, Option(help="Unit of length, for the axes: mm.", show_default=False)] = "",
    texture: Annotated[
        str | None,
        Option(
            metavar="FILE",
            help="Picture for the surface and its map, or checkerboard.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Write one HTML file to see a mesh in: eigenfunctions, heat, waves, filters.

    It needs no network and no server, only a browser.
    """
    from beltrami.display.page import LAPLACIANS
    from beltrami.display.page import page as write
    from beltrami.io.registry import read_mesh

    check_page_output(output)
    if data is None and data_name is not None:
        raise typer.BadParameter("--data-name goes with --data")
    with waiting(f"reading {mesh.name}"):
        read = read_mesh(mesh)
        f = None if data is None else {data_name or data.stem: read_data(data, read, data_name)}
    with waiting("computing the page") as progress:
        written = write(
            read,
            output,
            f,
            title=title or mesh.stem,
            modes=modes,
            laplacians=tuple(weights) if weights else LAPLACIANS,
            plane=plane,
            noise=noise,
            up=up,
            unit=unit,
            texture=texture if texture in (None, "checkerboard") else Path(texture),
            progress=progress,
        )
    for note in written.notes:
        typer.echo(as_commands(note))
    typer.echo(f"wrote {output}: {written.size / 1e6:.2f} MB. Open it in a browser")
