"""beltrami integrate: the integral of a function over the surface."""

from __future__ import annotations

from typing import Annotated

import typer

from beltrami.cli.console import print_json, waiting
from beltrami.cli.functions import read_data
from beltrami.cli.options import Data, DataName, Json, MeshFile


def integrate(
    mesh: MeshFile,
    data: Data = None,
    data_name: DataName = None,
    how: Annotated[
        str, typer.Option(help="vertex: cells of the vertices; edge: middles of the edges.")
    ] = "vertex",
    areas: Annotated[
        str | None,
        typer.Option(
            help="barycentric, voronoi or circumcentric; of edges circumcenter or incenter.",
            show_default="barycentric, circumcenter",
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Integrate the function --data over a mesh; without it 1, whose integral is the area."""
    import numpy as np

    from beltrami.io.registry import read_mesh
    from beltrami.operators.integrals import integrate as add_up

    with waiting(f"integrating over {mesh.name}"):
        read = read_mesh(mesh)
        one = np.ones(read.n_vertices)
        values = one if data is None else read_data(data, read, data_name)
        total, area = add_up(read, values, how, areas), add_up(read, one, how, areas)
    if json:
        print_json({"integral": total, "area": area, "mean": total / area})
        return
    typer.echo(f"integral {_written(total)}")
    typer.echo(f"mean     {_written(total / area)}")
    typer.echo(f"area     {_written(area)}")


def _written(numbers: object) -> str:
    """Write one number, or one for each column."""
    import numpy as np

    return ", ".join(f"{number:.12g}" for number in np.atleast_1d(np.asarray(numbers)))
