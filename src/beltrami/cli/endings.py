"""How a verb ends: done, or with bad input in one line."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import ParamSpec, TypeVar

import typer

from beltrami.errors import BeltramiError

P = ParamSpec("P")
R = TypeVar("R")

BAD_INPUT = 1


def ending_well(verb: Callable[P, R]) -> Callable[P, R]:
    """Let a verb end with one line on stderr and an exit code, whatever went wrong outside of it.

    Bad input and failed reading or writing is 1; bad usage, which is not for here, is 2.
    Any other exception is a mistake of ours and is shown with its traceback.
    """

    @functools.wraps(verb)
    def ended(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            return verb(*args, **kwargs)
        except BrokenPipeError:
            raise  # nobody reads any more: nothing to tell
        except (BeltramiError, OSError, MemoryError) as error:
            _tell(_as_a_line(error))
            raise typer.Exit(BAD_INPUT) from error

    return ended


def _tell(line: str) -> None:
    typer.secho(f"beltrami: {line}", err=True, fg="red")


def _as_a_line(error: Exception) -> str:
    """Put an error into one line, with its remedy as a command instead of as a call."""
    from beltrami.cli.remedies import as_commands

    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    if isinstance(error, MemoryError):
        return f"not enough memory. {error}"
    text = str(error) or type(error).__name__
    remedy = getattr(error, "remedy", "")  # only this is about options: files may be called alike
    if remedy and text.endswith(remedy):
        text = text.removesuffix(remedy) + as_commands(remedy)
    return " ".join(text.split())
