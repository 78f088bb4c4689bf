"""beltrami filter: apply a function of the Laplacian to a function on a mesh, or to the mesh."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from beltrami.cli.console import waiting
from beltrami.cli.functions import read_data, write_values
from beltrami.cli.options import Data, DataName, Mass, MeshFile, Output, Weights
from beltrami.cli.outputs import check_mesh_output, check_values_output

if TYPE_CHECKING:
    from beltrami._arrays import Floats
    from beltrami.operators.pair import Laplacian
    from beltrami.spectrum.kernel import Kernel

_TIMED = ("heat", "wave", "tikhonov")
_CUT = ("lowpass", "highpass")
KERNELS = (*_TIMED, *_CUT, "bandpass")


def filter(  # noqa: A001
    mesh: MeshFile,
    output: Output,
    kernel: Annotated[
        str, typer.Option(help="heat, wave, tikhonov, lowpass, highpass or bandpass.")
    ],
    time: Annotated[
        float | None,
        typer.Option(help="Of heat and waves; the weight of tikhonov.", show_default=False),
    ] = None,
    cutoff: Annotated[
        float | None,
        typer.Option(help="Eigenvalue where lowpass and highpass cut.", show_default=False),
    ] = None,
    band: Annotated[
        tuple[float, float] | None,
        typer.Option(metavar="LOW HIGH", help="Eigenvalues of bandpass.", show_default=False),
    ] = None,
    width: Annotated[
        float | None,
        typer.Option(
            help="How long a cut takes, in eigenvalues; 0: at once.",
            show_default="half of the cutoff, or of the band",
        ),
    ] = None,
    data: Data = None,
    data_name: DataName = None,
    method: Annotated[str, typer.Option(help="chebyshev, lanczos or exact.")] = "chebyshev",
    basis: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Modes of this mesh by `beltrami spectrum`, instead of --method: for kernels that "
            "are small beyond them.",
        ),
    ] = None,
    tolerance: Annotated[float, typer.Option(help="Error, beside the norm of --data.")] = 1e-8,
    weights: Weights = None,
    mass: Mass = None,
) -> None:
    """Filter the function --data, or the mesh itself, by its frequencies.

    With area masses eigenvalues have the unit 1 / length²; the largest possible one is told.
    """
    from beltrami.io.registry import read_mesh, write_mesh
    from beltrami.operators.laplacian import laplacian
    from beltrami.spectrum.filtering import filter as filtered
    from beltrami.spectrum.interval import spectral_interval

    h = _kernel(kernel, time, cutoff, band, width)
    if basis is not None and method != "chebyshev":
        raise typer.BadParameter("--basis takes the place of --method")
    (check_mesh_output if data is None else check_values_output)(output)
    with waiting(f"reading {mesh.name}"):
        read = read_mesh(mesh)
    values = read.vertices if data is None else read_data(data, read, data_name)
    with waiting("filtering") as progress:
        pair = laplacian(read, weights, mass)
        if basis is not None:
            result = _by_modes(basis, pair, values, h, tolerance)
        else:
            result = filtered(pair, values, h, method, tolerance=tolerance, progress=progress)
    if data is None:
        write_mesh(output, read.with_vertices(result))
    else:
        write_values(output, read, data_name or data.stem, result)
    low, high = spectral_interval(pair)
    typer.echo(f"wrote {output}: {h!r}, eigenvalues between {low:.6g} and {high:.6g}")


def _by_modes(path: Path, pair: Laplacian, values: Floats, h: Kernel, tolerance: float) -> Floats:
    """Filter by the eigenvectors in a file; refuse if the kernel lets others through."""
    import numpy as np

    from beltrami.errors import ApproximationError, MeshError
    from beltrami.spectrum.interval import spectral_interval
    from beltrami.spectrum.load_basis import load_basis

    modes = load_basis(path, pair)
    first, last = modes.eigenvalues[[0, -1]]
    if abs(first) > 1e-9 * last:
        raise MeshError(
            f"the modes in {path} begin at the eigenvalue {first:.6g}: a filter needs all from 0",
            remedy="Make them with `beltrami spectrum` without --near and without held vertices.",
        )
    high = max(spectral_interval(pair).high, last)
    beyond = np.linspace(last, high, 2) if last <= 0 else np.geomspace(last, high, 10_000)
    left = float(np.abs(h(beyond)).max()) if modes.k < pair.n else 0.0
    size = max(float(np.abs(h(modes.eigenvalues)).max()), left)
    if left > tolerance * size:
        raise ApproximationError(
            f"beyond the last of the {modes.k} modes, at the eigenvalue {last:.6g}, the kernel is "
            f"up to {left / size:.1g} of its maximum, and {tolerance:.1g} is allowed",
            left / size,
            "Take more modes, or a larger --tolerance.",
        )
    return modes.filter(values, h)


def _kernel(
    name: str,
    time: float | None,
    cutoff: float | None,
    band: tuple[float, float] | None,
    width: float | None,
) -> Kernel:
    """Make the kernel of this name; refuse options that it has no use for."""
    from beltrami.errors import check_name
    from beltrami.spectrum import kernels

    check_name("kernel", name, KERNELS)
    needed = "--time" if name in _TIMED else "--cutoff" if name in _CUT else "--band"
    given = {"--time": time, "--cutoff": cutoff, "--band": band}
    if given[needed] is None:
        raise typer.BadParameter(f"the kernel {name} needs {needed}")
    idle = [option for option, value in given.items() if value is not None and option != needed]
    if width is not None and name in _TIMED:
        idle.append("--width")
    if idle:
        raise typer.BadParameter(f"the kernel {name} has no use for {idle[0]}")
    if time is not None:
        timed = {"heat": kernels.Heat, "wave": kernels.Wave, "tikhonov": kernels.Tikhonov}
        return timed[name](time)
    if cutoff is not None:
        cut = kernels.LowPass if name == "lowpass" else kernels.HighPass
        return cut(cutoff, cutoff / 2 if width is None else width)
    low, high = band or (0.0, 0.0)
    return kernels.BandPass(low, high, abs(high - low) / 2 if width is None else width)
