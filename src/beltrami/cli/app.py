"""The command ``beltrami`` and its verbs."""

from __future__ import annotations

from typing import Annotated

import typer

from beltrami.cli.atlas import atlas
from beltrami.cli.batch import batch
from beltrami.cli.compress import compress
from beltrami.cli.curvature import curvature
from beltrami.cli.cut import cut
from beltrami.cli.decompress import decompress
from beltrami.cli.denoise import denoise
from beltrami.cli.descriptors import descriptors
from beltrami.cli.endings import ending_well
from beltrami.cli.filter import filter as filter_verb
from beltrami.cli.flatten import flatten
from beltrami.cli.geodesics import geodesics
from beltrami.cli.heat import heat
from beltrami.cli.info import info
from beltrami.cli.integrate import integrate
from beltrami.cli.page import page
from beltrami.cli.parameterize import parameterize
from beltrami.cli.regularize import regularize
from beltrami.cli.render import render
from beltrami.cli.repair import repair
from beltrami.cli.smooth import smooth
from beltrami.cli.spectrum import spectrum
from beltrami.cli.tour import tour
from beltrami.cli.wave import wave

app = typer.Typer(
    name="beltrami",
    help="Fourier analysis and linear processing of functions on triangle meshes.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for verb in (
    info,
    repair,
    smooth,
    denoise,
    heat,
    filter_verb,
    wave,
    regularize,
    curvature,
    geodesics,
    integrate,
    spectrum,
    descriptors,
    compress,
    decompress,
    cut,
    parameterize,
    atlas,
    flatten,
    render,
    batch,
    page,
    tour,
):
    app.command()(ending_well(verb))


def _show_version(asked: bool) -> None:
    if asked:
        from importlib.metadata import version

        typer.echo(f"beltrami {version('beltrami')}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool,
        typer.Option("--version", help="Show the version.", callback=_show_version, is_eager=True),
    ] = False,
) -> None:
    """Process functions on triangle meshes. Files in, files out."""
