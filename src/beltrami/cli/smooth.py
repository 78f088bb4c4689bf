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
        str,
        typer.Option(
            help="averaging, taubin, windowed_sinc; with --time: implicit, explicit, bilaplacian, "
            "curvature_flow, conformal_flow; keeping creases: bilateral_normals, guided_normals, "
            "tv_normals."
        ),
    ] = "averaging",
    steps: Annotated[
        int | None,
        typer.Option(min=0, help="Rounds, or time steps.", show_default="of the method"),
    ] = None,
    step: Annotated[
        float | None,
        typer.Option(help="How far to the mean, 0 to 1.", show_default="1; taubin: 0.5"),
    ] = None,
    pass_band: Annotated[
        float | None,
        typer.Option(
            help="Of taubin and windowed_sinc: frequencies below it stay.", show_default="0.1"
        ),
    ] = None,
    time: Time = None,
    weights: Weights = None,
    mass: Mass = None,
    data: Data = None,
    data_name: DataName = None,
    features: Annotated[
        float | None,
        typer.Option(
            metavar="DEGREES",
            help="Smooth edges that bend more along themselves, and leave corners; not for flows.",
            show_default=False,
        ),
    ] = None,
    contrast: Annotated[
        float | None,
        typer.Option(
            help="Of bilateral_ and guided_normals: normals that differ by more stay apart.",
            show_default="0.35",
        ),
    ] = None,
    fidelity: Annotated[
        float | None,
        typer.Option(help="Of tv_normals: more is nearer to the mesh.", show_default="1"),
    ] = None,
    hold_boundary: HoldBoundary = False,
    keep: Annotated[
        str | None, typer.Option(help="volume or centroid.", show_default=False)
    ] = None,
) -> None:
    """Smooth a mesh, or the function --data on it.

    Averages take combinatorial weights unless told otherwise, flows cotangent ones.
    """
    from beltrami.diffusion.smooth_mesh import smooth_mesh
    from beltrami.diffusion.smoothing import smooth as smooth_function
    from beltrami.io.registry import read_mesh, write_mesh
    from beltrami.operators.laplacian import laplacian

    if data is not None and method != "averaging":
        raise typer.BadParameter("a function is diffused by `beltrami heat`")
    others = (time, mass, pass_band, features, contrast, fidelity, keep)
    if data is not None and any(option is not None for option in others):
        raise typer.BadParameter("--data takes --steps, --step, --weights and --hold-boundary")
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
            pass_band=pass_band,
            time=time,
            weights=weights,
            mass=mass,
            features=features,
            contrast=contrast,
            fidelity=fidelity,
            hold_boundary=hold_boundary,
            keep=keep,
            progress=progress,
        )
    write_mesh(output, smoothed)
    typer.echo(f"wrote {output}: {smoothed!r}")
