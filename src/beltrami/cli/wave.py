"""beltrami wave: let a function swing on a mesh, and write or draw its frames."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from beltrami.cli.console import waiting
from beltrami.cli.functions import read_data
from beltrami.cli.options import Data, DataName, HoldBoundary, Mass, MeshFile, Modes, Weights
from beltrami.cli.outputs import check_frames_output

if TYPE_CHECKING:
    from beltrami._arrays import Floats
    from beltrami.cli.frames import Frames
    from beltrami.display.srgb import Image
    from beltrami.mesh.mesh import Mesh

Option = typer.Option


def wave(
    mesh: MeshFile,
    output: Annotated[
        Path,
        Option(
            "-o",
            "--output",
            metavar="PLACE",
            help="Frames: .npy (one row for each), .webp or .gif (animated), or a folder (PNG).",
        ),
    ],
    time: Annotated[float, Option(help="Time of the last frame, a length with area masses.")],
    frames: Annotated[int, Option(min=2, help="Number of frames, the first at the time 0.")] = 60,
    data: Data = None,
    data_name: DataName = None,
    bump: Annotated[
        list[int] | None,
        Option(metavar="VERTEX", help="A Gaussian at this vertex, instead of --data."),
    ] = None,
    hollow: Annotated[
        list[int] | None, Option(metavar="VERTEX", help="A negative Gaussian at this vertex.")
    ] = None,
    width: Annotated[
        float | None,
        Option(help="Of the Gaussians.", show_default="a twentieth of the root of the area"),
    ] = None,
    velocity: Annotated[
        Path | None, Option(metavar="FILE", help="Velocity at the time 0.", show_default="at rest")
    ] = None,
    method: Annotated[str, Option(help="leapfrog, implicit or spectral.")] = "leapfrog",
    step: Annotated[float | None, Option(help="Longest time step.", show_default=False)] = None,
    modes: Modes = None,
    weights: Weights = None,
    mass: Mass = None,
    hold_boundary: HoldBoundary = False,
    size: Annotated[tuple[int, int], Option(help="Width and height of a picture.")] = (500, 500),
    view: Annotated[
        tuple[float, float] | None,
        Option(help="Azimuth and elevation of the eye, in degrees.", show_default=False),
    ] = None,
    up: Annotated[str, Option(help="x, y or z.")] = "y",
    rate: Annotated[float, Option(help="Frames a second, of animations.")] = 25.0,
) -> None:
    """Solve the wave equation from --data, or from --bump and --hollow vertices."""
    import numpy as np

    from beltrami.cli.frames import told, write_array
    from beltrami.diffusion.wave import wave as swing
    from beltrami.io.registry import read_mesh
    from beltrami.operators.laplacian import laplacian
    from beltrami.spectrum.fourier_basis import fourier_basis

    if (data is None) == (bump is None and hollow is None):
        raise typer.BadParameter("give either --data, or --bump and --hollow vertices")
    if width is not None and data is not None:
        raise typer.BadParameter("--width goes with --bump and --hollow")
    if modes is not None and method != "spectral":
        raise typer.BadParameter("--modes goes with --method spectral")
    suffix = check_frames_output(output)
    with waiting(f"reading {mesh.name}"):
        read = read_mesh(mesh)
        speed = None if velocity is None else read_data(velocity, read, option="")
        if data is not None:
            start = read_data(data, read, data_name)
        else:
            start = _bumps(read, bump or [], hollow or [], width)
    if suffix != ".npy" and start.ndim == 2:
        raise typer.BadParameter("pictures show one function: choose it, or write .npy")
    times = np.linspace(0, time, frames)
    held = read.topology.on_boundary if hold_boundary else ()
    pair = laplacian(read, weights, mass)
    basis = None if modes is None else fourier_basis(pair, modes, hold=held)

    def states() -> Frames:
        return swing(pair, start, speed, times, method, step=step, hold=held, basis=basis)

    if suffix == ".npy":
        with waiting("swinging") as progress:
            write_array(output, told(states(), progress, frames), frames, start.shape)
        typer.echo(f"wrote {output}: {frames} frames, {pair!r}")
        return
    height = _draw(read, states, output, suffix, frames, rate, size=size, view=view, up=up)
    typer.echo(f"wrote {output}: {frames} frames, colours from {-height:.3g} to {height:.3g}")


def _draw(
    mesh: Mesh,
    states: Callable[[], Frames],
    output: Path,
    suffix: str,
    count: int,
    rate: float,
    **look: Any,
) -> float:
    """Draw all frames in colours up to half of the largest value, which is returned.

    Of a wave that parts, most frames are below that.
    """
    from beltrami.cli.frames import largest, told, write_pictures
    from beltrami.display.render import render

    with waiting("swinging") as progress:
        height = largest(told(states(), progress, count)) / 2 or 1.0
    look |= {"colormap": "diverging", "limits": (-height, height), "level_set": None}

    def draw(time: float, frame: Floats) -> Image:
        return render(mesh, frame, caption=f"t = {time:.3g}", **look)

    with waiting("drawing") as progress:
        write_pictures(output, suffix, told(states(), progress, count), draw, rate)
    return height


def _bumps(mesh: Mesh, bump: list[int], hollow: list[int], width: float | None) -> Floats:
    """Make Gaussians of the heights 1 and -1."""
    from beltrami.diffusion.bumps import gaussian_bumps

    heights = [1.0] * len(bump) + [-1.0] * len(hollow)
    wide = 0.05 * mesh.area**0.5 if width is None else width
    return gaussian_bumps(mesh, [*bump, *hollow], wide, heights)
