"""beltrami regularize: a smooth function near to the given one."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from beltrami.cli.console import waiting
from beltrami.cli.functions import read_data, write_values
from beltrami.cli.options import DataName, HoldBoundary, Mass, MeshFile, Values, Weights
from beltrami.cli.outputs import check_values_output


def regularize(
    mesh: MeshFile,
    output: Values,
    data: Annotated[
        Path, typer.Option(metavar="FILE", help="Function on the vertices: .npy .txt .ply .gii ...")
    ],
    time: Annotated[
        float,
        typer.Option(help="How smooth; of the form mass in length² with area masses. May be inf."),
    ],
    data_name: DataName = None,
    form: Annotated[str, typer.Option(help="mass, identity or normalized.")] = "mass",
    measured: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Weight of each value of --data: 0 where none is known."),
    ] = None,
    weights: Weights = None,
    mass: Mass = None,
    hold_boundary: HoldBoundary = False,
) -> None:
    """Find the function with the least sum of squared distance to --data and squared gradient."""
    from beltrami.diffusion.regularize import regularize as solve
    from beltrami.io.registry import read_mesh
    from beltrami.operators.laplacian import laplacian

    check_values_output(output)
    with waiting(f"reading {mesh.name}"):
        read = read_mesh(mesh)
        values = read_data(data, read, data_name)
        soft = None if measured is None else read_data(measured, read, option="")
    held = read.topology.on_boundary if hold_boundary else ()
    with waiting("solving"):
        pair = laplacian(read, weights, mass)
        result = solve(pair, values, time, form, hold=held, weights=soft)
    write_values(output, read, data_name or data.stem, result)
    low, high = float(result.min()), float(result.max())
    typer.echo(f"wrote {output}: values from {low:.6g} to {high:.6g}, {pair!r}")
