"""beltrami smooth: average a mesh, or a function on it, with its neighbours."""

from __future__ import annotations

from typing import Annotated

import typer

from beltrami.cli.console import waiting
from beltrami.cli.functions import read_data, write_values
from beltrami.cli.options import Data, DataName, HoldBoundary, Mass, MeshFile, Output, Time, Weights
from beltrami.cli.outputs import check_mesh_output, check_values_output


def smooth(
    mesh: MeshFile,
    output: Output,
    method: Annotated[
        str, typer.Option(help="averaging, or heat: implicit, explicit (with --time).")
    ] = "averaging",
    steps: Annotated[
        int | None, typer.Option(min=0, help="Rounds, or time steps.", show_default="10")
    ] = None,
    step: Annotated[
        float | None,
        typer.Option(help="Of averaging: how far to the mean, 0 to 1.", show_default="1"),
    ] = None,
    time: Time = None,
    weights: Weights = None,
    mass: Mass = None,
    data: Data = None,
    data_name: DataName = None,
    hold_boundary: HoldBoundary = False,
    keep: Annotated[
        str | None, typer.Option(help="volume or centroid.", show_default=False)
    ] = None,
) -> None:
    """Smooth a mesh, or the function --data on it.

    Averaging takes combinatorial weights unless told otherwise, heat cotangent ones.
    """
    from beltrami.diffusion.smooth_mesh import smooth_mesh
    from beltrami.diffusion.smoothing import smooth as smooth_function
    from beltrami.io.registry import read_mesh, write_mesh
    from beltrami.operators.laplacian import laplacian

    if method == "averaging" and (time is not None or mass is not None):
        raise typer.BadParameter("--time and --mass go with --method implicit or explicit")
    if method != "averaging" and step is not None:
        raise typer.BadParameter("--step goes with --method averaging")
    if data is not None and method != "averaging":
        raise typer.BadParameter("a function is diffused by `beltrami heat`")
    if data is not None and keep is not None:
        raise typer.BadParameter("--keep is for meshes, not for --data")
    (check_mesh_output if data is None else check_values_output)(output)
    with waiting(f"reading {mesh.name}"):
        read = read_mesh(mesh)
    if data is not None:
        values = read_data(data, read, data_name)
        held = read.topology.on_boundary if hold_boundary else ()
        with waiting("smoothing") as progress:
            pair = laplacian(read, "combinatorial" if weights is None else weights, "degree")
            rounds = 10 if steps is None else steps
            delta = 1.0 if step is None else step
            result = smooth_function(pair, values, rounds, delta, hold=held, progress=progress)
        write_values(output, read, data_name or data.stem, result)
        typer.echo(f"wrote {output}")
        return
    with waiting("smoothing") as progress:
        smoothed = smooth_mesh(
            read,
            method,
            steps=steps,
            step=step,
            time=time,
            weights=weights,
            mass=mass,
            hold_boundary=hold_boundary,
            keep=keep,
            progress=progress,
        )
    write_mesh(output, smoothed)
    typer.echo(f"wrote {output}: {smoothed!r}")
