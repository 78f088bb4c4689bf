"""beltrami render: pictures without a graphics card."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from beltrami.cli.console import waiting
from beltrami.cli.functions import read_drawn
from beltrami.cli.options import Data, DataName
from beltrami.cli.outputs import check_picture_output

Option = typer.Option


def render(
    meshes: Annotated[
        list[Path], typer.Argument(metavar="MESH...", help="Mesh files, drawn side by side.")
    ],
    output: Annotated[
        Path, Option("-o", "--output", metavar="FILE", help="Picture: .png, .webp or .gif.")
    ],
    data: Data = None,
    data_name: DataName = None,
    size: Annotated[tuple[int, int], Option(help="Width and height of a panel.")] = (800, 800),
    view: Annotated[
        tuple[float, float] | None,
        Option(help="Azimuth and elevation of the eye, in degrees.", show_default=False),
    ] = None,
    up: Annotated[str, Option(help="x, y or z.")] = "y",
    zoom: Annotated[float, Option(help="Magnification.")] = 1.0,
    flat: Annotated[bool, Option("--flat", help="One light for each face.")] = False,
    wireframe: Annotated[bool, Option("--wireframe", help="Draw the edges.")] = False,
    colormap: Annotated[str | None, Option(help="Colours of --data.", show_default=False)] = None,
    limits: Annotated[
        tuple[float, float] | None, Option(help="Range of the colours.", show_default=False)
    ] = None,
    missing: Annotated[
        str | None,
        Option(metavar="COLOR", help="Colour where --data is NaN.", show_default=False),
    ] = None,
    texture: Annotated[
        str | None,
        Option(
            metavar="FILE",
            help="Picture for meshes with texture coordinates, or checkerboard.",
            show_default=False,
        ),
    ] = None,
    captions: Annotated[bool, Option(help="Write the names of the files.")] = True,
) -> None:
    """Draw meshes, side by side, with a function on the first if --data is given."""
    from beltrami.display.render import render as draw
    from beltrami.io.registry import read_mesh

    check_picture_output(output)
    if data is None and (colormap, limits, data_name, missing) != (None, None, None, None):
        raise typer.BadParameter("--colormap, --limits, --missing and --data-name go with --data")
    with waiting("reading"):
        read = [read_mesh(path) for path in meshes]
        holes = missing is not None
        functions = [None if data is None else read_drawn(data, read[0], data_name, holes)]
    several = len(read) > 1
    with waiting("drawing"):
        picture = draw(
            read,
            functions + [None] * (len(read) - 1),
            output,
            size=size,
            view=view,
            up=up,
            zoom=zoom,
            shading="flat" if flat else "gouraud",
            wireframe=wireframe,
            colormap=colormap,
            limits=limits,
            missing=missing,
            texture=texture if texture in (None, "checkerboard") else Path(texture),
            caption=[path.name for path in meshes] if several and captions else None,
        )
    typer.echo(f"wrote {output}: {picture.shape[1]} x {picture.shape[0]} pixels")
