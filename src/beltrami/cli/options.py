"""Options that several verbs share, so that they are spelled and explained alike."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from beltrami.cli.endings import ending_well

_DATASET = "dataset:"


@ending_well
def _located(mesh: Path) -> Path:
    """Return the file of ``dataset:NAME``, fetched if need be, or the file that is given."""
    if not str(mesh).startswith(_DATASET):
        return mesh
    from beltrami.datasets.load import fetch

    return fetch(str(mesh).removeprefix(_DATASET))


MeshFile = Annotated[
    Path,
    typer.Argument(
        metavar="MESH",
        help="A mesh: .obj .off .ply .stl ..., or dataset:spot.",
        callback=_located,
    ),
]
MeshOutput = Annotated[
    Path, typer.Option("-o", "--output", metavar="FILE", help="Mesh file to write.")
]
Output = Annotated[
    Path,
    typer.Option(
        "-o",
        "--output",
        metavar="FILE",
        help="File to write: the mesh; of --data .npy .txt .csv .ply .gii.",
    ),
]
Values = Annotated[
    Path,
    typer.Option(
        "-o", "--output", metavar="FILE", help="Values: .npy .txt .csv .gii, or .ply with the mesh."
    ),
]
Data = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Function on the vertices: .npy .txt .ply .gii ..."),
]
DataName = Annotated[
    str | None,
    typer.Option(metavar="NAME", help="Which function of --data, if it has several."),
]
Weights = Annotated[
    str | None,
    typer.Option(
        help="combinatorial, distance, cotangent, clamped, intrinsic_delaunay or tufted.",
        show_default=False,
    ),
]
Mass = Annotated[
    str | None,
    typer.Option(
        help="voronoi, barycentric, consistent, degree or unit.",
        show_default="voronoi for cotangent weights, degree otherwise",
    ),
]
Time = Annotated[
    float | None,
    typer.Option(help="Diffusion time, in length² with area masses.", show_default=False),
]
Modes = Annotated[
    int | None,
    typer.Option(
        min=1, help="Of the spectral method: how many.", show_default="all, of small meshes"
    ),
]
HoldBoundary = Annotated[bool, typer.Option("--hold-boundary", help="Keep the boundary in place.")]
Json = Annotated[bool, typer.Option("--json", help="Write JSON to stdout, for machines.")]
