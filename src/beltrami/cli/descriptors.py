"""beltrami descriptors: what the spectrum tells of each vertex, or of the whole shape."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from beltrami.cli.console import waiting
from beltrami.cli.functions import write_values
from beltrami.cli.options import Mass, MeshFile, Values, Weights
from beltrami.cli.outputs import check_values_output
from beltrami.errors import check_name

if TYPE_CHECKING:
    from beltrami._arrays import Floats
    from beltrami.spectrum.basis import FourierBasis

KINDS = ("hks", "wks", "shape-dna")


Kind = Annotated[
    str, typer.Option(help="hks (heat kernel), wks (wave kernel), or shape-dna (the eigenvalues).")
]
Modes = Annotated[
    int, typer.Option("-k", "--modes", min=1, metavar="K", help="How many eigenpairs.")
]
Count = Annotated[
    int | None,
    typer.Option(
        min=1,
        help="How many times or energies, chosen in the range of the eigenvalues.",
        show_default="100",
    ),
]
Times = Annotated[
    list[float] | None,
    typer.Option(
        "--time",
        help="Of hks, in length² with area masses; may be given several times.",
        show_default=False,
    ),
]
ScaleInvariant = Annotated[
    bool, typer.Option("--scale-invariant", help="hks or wks of the surface scaled to area 1.")
]
Normalization = Annotated[
    str | None,
    typer.Option(
        help="Of shape-dna: area, first (eigenvalue above zero) or none.", show_default="area"
    ),
]


def descriptors(
    mesh: MeshFile,
    output: Values,
    kind: Kind = "hks",
    modes: Modes = 100,
    count: Count = None,
    time: Times = None,
    scale_invariant: ScaleInvariant = False,
    normalization: Normalization = None,
    weights: Weights = None,
    mass: Mass = None,
) -> None:
    """Write a row of numbers for each vertex (hks, wks), or one for each eigenvalue (shape-dna)."""
    from beltrami.io.registry import read_mesh
    from beltrami.operators.laplacian import laplacian
    from beltrami.spectrum.fourier_basis import fourier_basis

    _check_options(kind, output, count, time, scale_invariant, normalization)
    check_values_output(output)
    with waiting(f"reading {mesh.name}"):
        read = read_mesh(mesh)
    with waiting("computing eigenpairs"):
        basis = fourier_basis(laplacian(read, weights, mass), modes)
    if kind == "shape-dna":
        values, told = _spectrum(basis, normalization or "area")
    else:
        values, told = _signature(basis, kind, count or 100, time, scale_invariant)
    write_values(output, read, kind, values)
    typer.echo(f"wrote {output}: {told}, of {basis.k} eigenpairs")


def _check_options(
    kind: str,
    output: Path,
    count: int | None,
    time: list[float] | None,
    scale_invariant: bool,
    normalization: str | None,
) -> None:
    """Refuse, before the work, what does not go together."""
    from beltrami.spectrum.shape_dna import NORMALIZATIONS

    check_name("kind of descriptor", kind, KINDS)
    if normalization is not None:
        check_name("normalization", normalization, NORMALIZATIONS)
        if kind != "shape-dna":
            raise typer.BadParameter("--normalization belongs to --kind shape-dna")
    if time is not None and kind != "hks":
        raise typer.BadParameter("--time belongs to --kind hks")
    if time is not None and count is not None:
        raise typer.BadParameter("give either --time or --count")
    if kind == "shape-dna" and (count is not None or scale_invariant):
        raise typer.BadParameter("--count and --scale-invariant belong to --kind hks and wks")
    if kind == "shape-dna" and output.suffix.lower() == ".ply":
        raise typer.BadParameter(
            "eigenvalues are no function on the mesh: write .npy, .txt or .csv"
        )


def _spectrum(basis: FourierBasis, normalization: str) -> tuple[Floats, str]:
    from beltrami.spectrum.shape_dna import shape_dna

    values = shape_dna(basis, normalization)
    zeros = int((values == 0).sum())
    return (
        values,
        f"eigenvalues up to {values[-1]:.6g} (normalization {normalization}), {zeros} zero",
    )


def _signature(
    basis: FourierBasis, kind: str, count: int, time: list[float] | None, scale_invariant: bool
) -> tuple[Floats, str]:
    from beltrami.spectrum.heat_kernel import heat_kernel_signature
    from beltrami.spectrum.wave_kernel import wave_kernel_signature

    if kind == "hks":
        found = heat_kernel_signature(basis, time, count=count, scale_invariant=scale_invariant)
        what = "times"
    else:
        found = wave_kernel_signature(basis, count=count, scale_invariant=scale_invariant)
        what = "energies"
    n, q = found.values.shape
    certain = int((found.truncation < 0.01).sum())
    return found.values, (
        f"{n} x {q} values at {what} from {found.at.min():.6g} to {found.at.max():.6g}; more "
        f"eigenpairs would change {certain} of them by less than 1%"
    )
