"""What people see while they wait, and what machines get."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from beltrami._progress import Progress as Callback

_PATIENCE = 1.0  # seconds before a bar appears


@contextmanager
def waiting(what: str) -> Iterator[Callback]:
    """Show a bar on stderr if the work takes more than a second; yield its callback.

    Before the first callback, and where the number of steps is unknown, the bar pulses. Nothing
    is shown where stderr is not a terminal.
    """
    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
    )
    task = bar.add_task(what, total=None)
    timer = threading.Timer(_PATIENCE, bar.start)
    timer.daemon = True
    if bar.console.is_terminal:
        timer.start()
    try:
        yield lambda done, total: bar.update(task, completed=done, total=total)
    finally:
        timer.cancel()
        if bar.live.is_started:  # stopped without a start it would write an empty line
            bar.stop()


def print_json(value: Any) -> None:
    """Write a value to stdout as JSON; numbers that JSON does not know become null."""
    typer.echo(json.dumps(_plain(value), indent=1, allow_nan=False))


def _plain(value: Any) -> Any:
    """Replace NaN and infinities by None, arrays by lists."""
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, float) and (value != value or value in (float("inf"), float("-inf"))):
        return None
    return value
