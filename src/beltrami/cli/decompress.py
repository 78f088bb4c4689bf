"""beltrami decompress: the mesh of a compressed file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from beltrami.cli.console import waiting
from beltrami.cli.options import MeshOutput
from beltrami.cli.outputs import check_mesh_output


def decompress(
    source: Annotated[Path, typer.Argument(metavar="FILE", help="A compressed mesh: .btm")],
    output: MeshOutput,
    max_vertices: Annotated[
        int, typer.Option(min=0, help="Refuse files that declare more.")
    ] = 10_000_000,
    partial: Annotated[
        bool,
        typer.Option("--partial", help="Take the beginning of a file of the mode spectral."),
    ] = False,
) -> None:
    """Decompress a mesh that `beltrami compress` wrote."""
    from beltrami.compression import decompress as room
    from beltrami.io.registry import write_mesh

    check_mesh_output(output)
    with waiting(f"decompressing {source.name}") as progress:
        mesh = room.decompress(source, max_vertices, progress, partial=partial)
        write_mesh(output, mesh)
    typer.echo(f"wrote {output}: {mesh!r}")
