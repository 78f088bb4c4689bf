"""beltrami heat: diffuse a function on a mesh."""

from __future__ import annotations

from typing import Annotated

import typer

from beltrami.cli.console import waiting
from beltrami.cli.functions import read_data, write_values
from beltrami.cli.options import (
    Data,
    DataName,
    HoldBoundary,
    Mass,
    MeshFile,
    Modes,
    Values,
    Weights,
)
from beltrami.cli.outputs import check_values_output


def heat(
    mesh: MeshFile,
    output: Values,
    time: Annotated[float, typer.Option(help="Diffusion time, in length² with area masses.")],
    data: Data = None,
    data_name: DataName = None,
    source: Annotated[
        list[int] | None,
        typer.Option(metavar="VERTEX", help="A unit of heat at this vertex, instead of --data."),
    ] = None,
    method: Annotated[
        str, typer.Option(help="implicit, explicit, crank_nicolson, spectral or exact.")
    ] = "implicit",
    steps: Annotated[
        int | None,
        typer.Option(min=1, help="Time steps.", show_default="10; explicit: what stability asks"),
    ] = None,
    damped_steps: Annotated[
        int | None,
        typer.Option(min=0, help="Of crank_nicolson: first steps without ringing."),
    ] = None,
    modes: Modes = None,
    weights: Weights = None,
    mass: Mass = None,
    hold_boundary: HoldBoundary = False,
) -> None:
    """Diffuse the function --data, or the heat of --source vertices, for a time."""
    import numpy as np

    from beltrami._arrays import as_indices
    from beltrami.diffusion.heat import heat as diffuse
    from beltrami.io.registry import read_mesh
    from beltrami.operators.laplacian import laplacian
    from beltrami.spectrum.fourier_basis import fourier_basis

    if modes is not None and method != "spectral":
        raise typer.BadParameter("--modes goes with --method spectral")
    if (data is None) == (source is None):
        raise typer.BadParameter("give either --data or --source")
    check_values_output(output)
    with waiting(f"reading {mesh.name}"):
        read = read_mesh(mesh)
    held = read.topology.on_boundary if hold_boundary else ()
    with waiting("diffusing") as progress:
        pair = laplacian(read, weights, mass)
        if data is not None:
            values = read_data(data, read, data_name)
        else:
            values = np.zeros(read.n_vertices)
            at = as_indices(source or (), read.n_vertices, "source vertices")
            values[at] = 1 / pair.masses[at]
        result = diffuse(
            pair,
            values,
            time,
            method,
            steps,
            hold=held,
            damped_steps=damped_steps,
            basis=None if modes is None else fourier_basis(pair, modes, hold=held),
            progress=progress,
        )
    write_values(output, read, "heat" if data is None else data_name or data.stem, result)
    low, high = float(result.min()), float(result.max())
    typer.echo(f"wrote {output}: values from {low:.6g} to {high:.6g}, {pair!r}")
