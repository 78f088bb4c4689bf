"""The command ``beltrami``: its verbs, and how errors end."""

from __future__ import annotations

import re
import sys
from typing import Annotated

import typer
from rich.console import Console

from beltrami.cli.heat import heat
from beltrami.cli.info import info
from beltrami.cli.render import render
from beltrami.cli.repair import repair
from beltrami.cli.smooth import smooth
from beltrami.cli.tour import tour
from beltrami.errors import BeltramiError

app = typer.Typer(
    name="beltrami",
    help="Fourier analysis and linear processing of functions on triangle meshes.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for verb in (info, repair, smooth, heat, render, tour):
    app.command()(verb)


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


def run() -> None:
    """Run the command; bad input is one line on stderr and exit code 1, bad usage exit code 2."""
    try:
        app()
    except (BeltramiError, OSError, MemoryError) as error:
        Console(stderr=True, highlight=False, soft_wrap=True).print(
            f"beltrami: {_as_a_line(error)}", style="red", markup=False
        )
        sys.exit(1)


def _as_a_line(error: Exception) -> str:
    """Put an error into one line, with the repair as a command instead of as a call."""
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    text = " ".join((str(error) or type(error).__name__).split())
    return re.sub(r"repair\(mesh, ([^)]*)\)", _as_options, text)


def _as_options(call: re.Match[str]) -> str:
    names = re.findall(r"(\w+)=", call.group(1))
    return "beltrami repair " + " ".join("--" + name.replace("_", "-") for name in names)
