"""beltrami denoise: remove the noise of a mesh, or of a function on it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from beltrami.cli.console import waiting
from beltrami.cli.functions import read_data, write_values
from beltrami.cli.options import Data, DataName, Mass, MeshFile, Output, Weights
from beltrami.cli.outputs import check_mesh_output, check_values_output

if TYPE_CHECKING:
    from beltrami.diffusion.denoise_function import DenoisedFunction
    from beltrami.diffusion.denoised import Denoised
    from beltrami.mesh.mesh import Mesh


def denoise(
    mesh: MeshFile,
    output: Output,
    method: Annotated[
        str, typer.Option(help="auto, or linear for linear filters alone; of meshes.")
    ] = "auto",
    noise: Annotated[
        float | None,
        typer.Option(
            help="Standard deviation of the noise: of a mesh, along its normals.",
            show_default="measured",
        ),
    ] = None,
    data: Data = None,
    data_name: DataName = None,
    weights: Weights = None,
    mass: Mass = None,
) -> None:
    """Remove the noise of a mesh, or of the function --data on it; nothing need be told."""
    from beltrami.diffusion.denoise import denoise as denoise_mesh
    from beltrami.diffusion.denoise_function import denoise_function
    from beltrami.io.registry import read_mesh, write_mesh
    from beltrami.operators.laplacian import laplacian

    if data is None and (weights, mass) != (None, None):
        raise typer.BadParameter("--weights and --mass go with --data")
    if data is not None and method != "auto":
        raise typer.BadParameter("--method is for meshes, not for --data")
    (check_mesh_output if data is None else check_values_output)(output)
    with waiting(f"reading {mesh.name}"):
        read = read_mesh(mesh)
    if data is None:
        with waiting("denoising") as progress:
            found = denoise_mesh(read, method, noise, progress=progress)
        write_mesh(output, found.mesh)
        _report(output, read, found)
        return
    values = read_data(data, read, data_name)
    with waiting("denoising") as progress:
        result = denoise_function(laplacian(read, weights, mass), values, noise, progress=progress)
    write_values(output, read, data_name or data.stem, result.values)
    _report_function(output, result)


def _report(output: Path, before: Mesh, found: Denoised) -> None:
    """Tell what was found, what was done, and how large the error should be now."""
    import numpy as np

    edge = float(before.edge_lengths.mean())
    moved = np.linalg.norm(found.mesh.vertices - before.vertices, axis=1)
    typer.echo(f"wrote {output}: {found.mesh!r}")
    for i, part in enumerate(found.parts):
        if len(found.parts) > 1:
            typer.echo(f"part {i}, {len(part.vertices)} vertices:")
        typer.echo(f"noise: {part.sigma:.4g} along the normals, {part.sigma / edge:.3f} mean edges")
        if len(part.spikes):
            typer.echo(f"spikes: {len(part.spikes)} vertices, put where their neighbours say")
        for name, mixture in (("filters", part.mixture), ("then", part.second)):
            if mixture:
                shares = [f"{100 * weight:.0f} % {text}" for text, weight in mixture]
                typer.echo(f"{name}: " + "; ".join(shares))
        if part.corrected:
            typer.echo(f"corrected by curvature and length of edges: {part.corrected:.3g}")
    typer.echo(
        f"error expected: {found.predicted_error:.3g} ({found.predicted_error / edge:.3f} mean "
        f"edges); vertices moved by {float(np.sqrt((moved**2).mean())):.3g}"
    )
    bends = [_bend(one) for one in (before, found.mesh)]
    typer.echo(f"mean angle of neighbouring faces: {bends[0]:.1f}° before, {bends[1]:.1f}° now")
    if not math.isnan(found.volume_change):
        typer.echo(f"volume: {100 * found.volume_change:+.3f} %")
    _warn(found.warnings)


def _bend(mesh: Mesh) -> float:
    """Return the mean angle between the normals of faces that share an edge, in degrees."""
    import numpy as np

    f, g = mesh.topology.face_pairs.faces.T
    if not len(f):
        return 0.0
    normals = mesh.face_normals
    cosines = np.einsum("ij,ij->i", normals[f], normals[g])
    return float(np.degrees(np.arccos(np.clip(cosines, -1, 1))).mean())


def _report_function(output: Path, found: DenoisedFunction) -> None:
    typer.echo(f"wrote {output}")
    for j, sigma in enumerate(found.sigma):
        parts = [f"{100 * weight:.0f} % {text}" for text, weight in found.mixture[j]]
        typer.echo(
            f"column {j}: noise {sigma:.4g}, error expected {found.predicted_error[j]:.3g}; "
            + "; ".join(parts)
        )
    _warn(found.warnings)


def _warn(warnings: tuple[str, ...]) -> None:
    for text in warnings:
        typer.echo(f"warning: {text}", err=True)
