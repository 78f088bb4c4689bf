"""beltrami curvature: Gaussian, mean and principal curvatures at the vertices."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from beltrami.cli.console import print_json, waiting
from beltrami.cli.functions import write_values
from beltrami.cli.options import Json, MeshFile
from beltrami.cli.outputs import check_values_output
from beltrami.errors import check_name

if TYPE_CHECKING:
    from beltrami.operators.curvature import Curvature

KINDS = ("gaussian", "mean", "principal")


def curvature(
    mesh: MeshFile,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help="Values: .npy .txt .csv, or .ply with the mesh. Nothing is written without it.",
        ),
    ] = None,
    kind: Annotated[
        str, typer.Option(help="What is written: gaussian, mean or principal (two columns).")
    ] = "mean",
    json: Json = False,
) -> None:
    """Measure the curvatures of a mesh, and check the theorem of Gauss and Bonnet."""
    from beltrami.io.registry import read_mesh
    from beltrami.operators.curvature import curvature as measure

    check_name("kind of curvature", kind, KINDS)
    if output is not None:
        check_values_output(output)
    with waiting(f"measuring {mesh.name}"):
        read = read_mesh(mesh)
        found = measure(read)
    if output is not None:
        write_values(output, read, kind, getattr(found, kind))
    facts = _facts(found, read.euler_characteristic)
    if json:
        print_json(facts)
        return
    for name in ("gaussian", "mean"):
        typer.echo(f"{name} curvature: {_spread(facts[name])}")
    typer.echo(
        f"angle defects and turning add to {facts['total']:.9g} "
        f"(2π times the Euler characteristic: {facts['gauss_bonnet']:.9g})"
    )
    if output is not None:
        typer.echo(f"wrote {output}: {kind} curvature")


def _facts(found: Curvature, chi: int) -> dict[str, float | dict[str, float]]:
    """Sum up: extremes and integrals, and both sides of Gauss-Bonnet."""
    import numpy as np

    facts: dict[str, float | dict[str, float]] = {
        name: {
            "smallest": float(values.min()),
            "median": float(np.median(values)),
            "largest": float(values.max()),
            "integral": float(found.areas @ values),
        }
        for name, values in (("gaussian", found.gaussian), ("mean", found.mean))
    }
    total = float(found.angle_defect.sum() + found.turning.sum())
    return facts | {"total": total, "gauss_bonnet": 2 * np.pi * chi}


def _spread(facts: float | dict[str, float]) -> str:
    if not isinstance(facts, dict):
        return f"{facts:.6g}"
    return (
        f"{facts['smallest']:.6g} to {facts['largest']:.6g}, median {facts['median']:.6g}, "
        f"integral {facts['integral']:.6g}"
    )
