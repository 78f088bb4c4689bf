"""beltrami compress: a mesh in few bytes, with a bound of the error."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from beltrami.cli.console import print_json, waiting
from beltrami.cli.curve import tell_curve
from beltrami.cli.options import Json, MeshFile
from beltrami.cli.outputs import check_compressed_output

CompressedOutput = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--output",
        metavar="FILE",
        help="File to write: .btm; with --curve a picture",
        show_default=False,
    ),
]


def compress(
    mesh: MeshFile,
    output: CompressedOutput = None,
    max_error: Annotated[
        float | None,
        typer.Option(help="No vertex moves farther.", show_default=False),
    ] = None,
    relative: Annotated[
        bool,
        typer.Option("--relative", help="--max-error is a part of the bounding box's diagonal."),
    ] = False,
    bits: Annotated[
        int | None,
        typer.Option(help="2^bits grid points along the longest side.", show_default="14"),
    ] = None,
    mode: Annotated[str, typer.Option(help="auto, grid, smooth or spectral.")] = "auto",
    terms: Annotated[
        int | None,
        typer.Option(
            help="With --mode spectral: frequencies of each block of vertices.", show_default="all"
        ),
    ] = None,
    effort: Annotated[str, typer.Option(help="best or fast.")] = "best",
    keep_order: Annotated[
        bool, typer.Option("--keep-order", help="Keep the numbers of the vertices.")
    ] = False,
    function_error: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=ERROR",
            help="How far a function may move; else exact.",
            show_default=False,
        ),
    ] = None,
    uv_error: Annotated[
        float | None,
        typer.Option(help="How far texture coordinates may move.", show_default="exact"),
    ] = None,
    curve: Annotated[
        bool,
        typer.Option(
            "--curve",
            help="Tell sizes and errors of all modes instead; -o PICTURE draws them (png, webp).",
        ),
    ] = False,
    json: Json = False,
) -> None:
    """Compress a mesh: faces exactly, positions within a bound, functions exactly or within one.

    Vertices and faces are numbered anew, vertices not with --keep-order. The file is decoded and
    compared before it is written.
    """
    from beltrami.compression import compress as room
    from beltrami.compression.contents import describe
    from beltrami.io.registry import read_mesh

    if curve:
        tell_curve(mesh, output, effort, json)
        return
    if output is None:
        raise typer.BadParameter("name the file to write: -o FILE")
    if relative and max_error is None:
        raise typer.BadParameter("--relative belongs to --max-error")
    check_compressed_output(output)
    with waiting(f"compressing {mesh.name}") as progress:
        read = read_mesh(mesh)
        if relative and max_error is not None and read.n_vertices:
            max_error *= float(np.linalg.norm(np.ptp(read.vertices, axis=0)))
        data = room.compress(
            read,
            output,
            max_error=max_error,
            bits=bits,
            mode=mode,
            terms=terms,
            effort=effort,
            keep_order=keep_order,
            function_errors=_errors(function_error or []),
            uv_error=uv_error,
            progress=progress,
        )
    contents = describe(data)
    if json:
        print_json(contents.to_dict() | {"original_size": mesh.stat().st_size})
        return
    rate = 8 * len(data) / max(read.n_vertices, 1)
    typer.echo(
        f"wrote {output}: {len(data)} bytes, {rate:.2f} bits per vertex, "
        f"error at most {contents.max_error:.3g}"
    )
    kept = {"texture coordinates": uv_error is None, "functions": not function_error}
    for what, option in (
        ("texture coordinates", "--uv-error ERROR"),
        ("functions", "--function-error NAME=ERROR"),
    ):
        part = sum(size for name, size in contents.sections if name.endswith(what))
        if kept[what] and 2 * part > contents.size:
            typer.echo(f"{part} bytes of it are {what}, exactly: {option} makes them smaller")


def _errors(options: list[str]) -> dict[str, float]:
    """Read errors of functions: NAME=ERROR each."""
    errors = {}
    for option in options:
        name, _, number = option.rpartition("=")
        try:
            errors[name] = float(number)
        except ValueError:
            name = ""
        if not name:
            raise typer.BadParameter(f"expected NAME=ERROR, found {option!r}")
    return errors
