"""beltrami flatten: two eigenvectors as texture coordinates, and how often they fold."""

from __future__ import annotations

from typing import Annotated

import typer

from beltrami.cli.console import waiting
from beltrami.cli.options import Json, MeshFile
from beltrami.cli.outputs import check_texture_output
from beltrami.cli.parameterize import TexturedOutput, report


def flatten(
    mesh: MeshFile,
    output: TexturedOutput,
    form: Annotated[
        str, typer.Option(help="areas, degree, or printed: as the chapter has it.")
    ] = "areas",
    weights: Annotated[
        str, typer.Option(help="As in the Laplacian: cotangent, combinatorial, distance ...")
    ] = "cotangent",
    json: Json = False,
) -> None:
    """Draw a surface with two eigenvectors as coordinates; count the folds, if it folds."""
    from beltrami.io.registry import read_mesh, write_mesh
    from beltrami.parameterization import flatten as room

    check_texture_output(output)
    with waiting(f"reading {mesh.name}"):
        read = read_mesh(mesh)
    with waiting("flattening"):
        found = room.flatten(read, form, weights)
    write_mesh(output, found.textured)
    report(output, found, json=json)
