"""beltrami spectrum: eigenpairs of a mesh, into a file that load_basis reads."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from beltrami.cli.console import waiting
from beltrami.cli.options import HoldBoundary, Mass, MeshFile, Weights
from beltrami.cli.outputs import check_basis_output, check_picture_output

if TYPE_CHECKING:
    from beltrami.mesh.mesh import Mesh
    from beltrami.spectrum.basis import FourierBasis

PICTURED = 12  # modes, at most

Modes = Annotated[
    int, typer.Option("-k", "--modes", min=1, metavar="K", help="How many eigenpairs.")
]
Basis = Annotated[
    Path, typer.Option("-o", "--output", metavar="FILE", help="Basis to write: .npz.")
]


def spectrum(
    mesh: MeshFile,
    output: Basis,
    modes: Modes = 100,
    near: Annotated[
        float, typer.Option(help="The eigenvalues nearest to this number, in 1/length².")
    ] = 0.0,
    tolerance: Annotated[float, typer.Option(help="Largest relative residual.")] = 1e-6,
    certify: Annotated[bool, typer.Option("--certify", help="Prove that none is missing.")] = False,
    png: Annotated[
        Path | None,
        typer.Option("--png", metavar="FILE", help="Also draw the first modes and their zeros."),
    ] = None,
    up: Annotated[str, typer.Option(help="Upward axis in the picture: x, y or z.")] = "y",
    weights: Weights = None,
    mass: Mass = None,
    hold_boundary: HoldBoundary = False,
) -> None:
    """Compute eigenvalues and eigenvectors of the Laplacian, and write them to a file.

    With --hold-boundary functions are zero at the boundary (Dirichlet), else free (Neumann).
    """
    from beltrami.io.registry import read_mesh
    from beltrami.operators.laplacian import laplacian
    from beltrami.spectrum.fourier_basis import fourier_basis

    check_basis_output(output)
    if png is not None:
        check_picture_output(png)
    with waiting(f"reading {mesh.name}"):
        read = read_mesh(mesh)
    held = read.topology.on_boundary if hold_boundary else ()
    with waiting("computing eigenpairs"):
        pair = laplacian(read, weights, mass)
        basis = fourier_basis(pair, modes, near, tolerance, hold=held, certify=certify)
    basis.save(output)
    low, high = float(basis.eigenvalues[0]), float(basis.eigenvalues[-1])
    typer.echo(
        f"wrote {output}: {basis.k} eigenpairs from {low:.6g} to {high:.6g}, residuals up to "
        f"{float(basis.residuals.max()):.1e}"
    )
    if certify:
        within = basis.computation.counted_within
        typer.echo(f"none is missing nearer than {within:.6g} to {near:g}, by inertia")
    if png is not None:
        with waiting("drawing"):
            _draw(png, read, basis, up)
        typer.echo(f"wrote {png}")


def _draw(path: Path, mesh: Mesh, basis: FourierBasis, up: str) -> None:
    from beltrami.display.render import render

    shown = range(min(PICTURED, basis.k))
    render(
        [mesh] * len(shown),
        [basis.eigenvectors[:, i] for i in shown],
        path,
        caption=[f"mode {i}, λ = {float(basis.eigenvalues[i]):.4g}" for i in shown],
        size=(320, 280),
        columns=4,
        colormap="diverging",
        colorbar=False,
        up=up,
    )
