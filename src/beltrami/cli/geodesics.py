"""beltrami geodesics: distances along the surface from one vertex or several."""

from __future__ import annotations

from typing import Annotated

import typer

from beltrami.cli.console import waiting
from beltrami.cli.functions import write_values
from beltrami.cli.options import MeshFile, Values
from beltrami.cli.outputs import check_values_output

_MANY = 20_000  # vertices, whose exact distances take some ten seconds


def geodesics(
    mesh: MeshFile,
    output: Values,
    source: Annotated[
        list[int], typer.Option(metavar="VERTEX", help="A source; may be given several times.")
    ],
    method: Annotated[
        str,
        typer.Option(
            help="heat (two linear solves), exact (some thousand vertices), or edges (upper bound)."
        ),
    ] = "heat",
    time: Annotated[
        float | None,
        typer.Option(
            help="Of the heat method, in length².", show_default="mean edge length squared"
        ),
    ] = None,
    intrinsic: Annotated[
        bool,
        typer.Option(help="Heat on intrinsic Delaunay triangles, or on the faces as they are."),
    ] = True,
    boundary: Annotated[
        str, typer.Option(help="Of the heat method: neumann or average.")
    ] = "neumann",
) -> None:
    """Measure how far each vertex is from the nearest --source, along the surface."""
    import numpy as np

    from beltrami.geodesics.distance import geodesic_distance
    from beltrami.io.registry import read_mesh

    check_values_output(output)
    with waiting(f"reading {mesh.name}"):
        read = read_mesh(mesh)
    if method == "exact" and read.n_vertices > _MANY:
        typer.echo(
            f"exact distances of {read.n_vertices} vertices may take minutes; "
            "--method heat takes seconds",
            err=True,
        )
    with waiting("measuring distances"):
        distance = geodesic_distance(
            read, source, method=method, time=time, intrinsic=intrinsic, boundary=boundary
        )
    write_values(output, read, "distance", distance)
    reached = np.isfinite(distance)
    farthest = int(np.argmax(np.where(reached, distance, -np.inf)))
    typer.echo(
        f"wrote {output}: farthest is vertex {farthest} at {distance[farthest]:.6g}"
        + ("" if reached.all() else f"; {int((~reached).sum())} vertices are not reached (inf)")
    )
