"""beltrami batch: one pipeline over many meshes."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from beltrami.cli.console import print_json
from beltrami.cli.options import Json

if TYPE_CHECKING:
    from rich.progress import Progress

    from beltrami.batch.run_batch import Batch
    from beltrami.batch.state import State, Watcher

_SHOWN = 20  # failures, in words
_EVERY = 0.1  # seconds between two drawings of the bar


def batch(
    sources: Annotated[
        list[str],
        typer.Argument(metavar="MESHES...", help="Files, patterns ('**/*.ply'), folders, URLs."),
    ],
    do: Annotated[
        str,
        typer.Option(
            metavar="STEPS",
            help="Verbs with parameters, 'repair, spectrum k=128, descriptors', or a TOML file.",
        ),
    ],
    output: Annotated[
        str, typer.Option("-o", "--output", metavar="FOLDER", help="Folder, or URL, of results.")
    ],
    workers: Annotated[
        int | None,
        typer.Option(
            min=0, help="Processes; 0 works in this one.", show_default="one for each core"
        ),
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="A running Dask scheduler instead: tcp://..."),
    ] = None,
    memory: Annotated[
        str | None,
        typer.Option(
            metavar="SIZE",
            help="What each worker may have, as 4GB; meshes that need more fail beforehand.",
            show_default="the machine's, divided",
        ),
    ] = None,
    time_limit: Annotated[
        str | None,
        typer.Option(
            metavar="TIME", help="What each mesh may take, as 10min; one that takes longer fails."
        ),
    ] = None,
    redo: Annotated[
        str, typer.Option(help="What is done already: nothing, failed or all is done again.")
    ] = "nothing",
    strict: Annotated[bool, typer.Option("--strict", help="Stop at the first failure.")] = False,
    json: Json = False,
) -> None:
    """Run a pipeline over many meshes: a table with a row for each, arrays, and a manifest.

    What is done is not done again; interrupt it and run it again to go on. A mesh that fails has
    its error in the manifest.
    """
    from beltrami.batch.run_batch import run_batch

    with _watching() as watch:
        found = run_batch(
            sources,
            do,
            output,
            workers=workers,
            scheduler=scheduler,
            memory=memory,
            time_limit=time_limit,
            redo=redo,
            strict=strict,
            watch=watch,
        )
    (_print_plain if json else _print_words)(found)


def _print_plain(found: Batch) -> None:
    state = found.state
    failures = [
        {"source": one.source, "kind": one.error.kind, "step": one.error.step}
        | {"message": one.error.message}
        for one in found.failures
    ]
    counts = {"meshes": state.total, "done": state.done, "failed": state.failed}
    counts |= {"reused": state.reused, "left_out": found.left_out}
    print_json(counts | {"seconds": state.seconds, "failures": failures})


def _print_words(found: Batch) -> None:
    state = found.state
    for failure in found.failures[:_SHOWN]:
        typer.echo(f"failed {failure.source}: {failure.error}")
    if len(found.failures) > _SHOWN:
        typer.echo(f"failed {len(found.failures) - _SHOWN} more: see {found.manifest}")
    if found.left_out:
        typer.echo(f"left out {found.left_out} files that are no meshes")
    typer.echo(
        f"{state.done} of {state.total} meshes done, {state.failed} failed, {state.reused} known "
        f"from before; {state.seconds:.1f} s, {state.rate:.2f} meshes/s"
    )
    typer.echo(f"wrote {found.out}: {found.table}, {found.manifest}")


@contextmanager
def _watching() -> Iterator[Watcher]:
    """Show on stderr, if that is a terminal, how many are done, the rate and the failures."""
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeRemainingColumn,
    )

    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda _state: None
        return
    with Progress(
        TextColumn("meshes"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]:.2f}/s, {task.fields[failed]} failed"),
        TimeRemainingColumn(),
        console=console,
        transient=True,
    ) as bar:
        yield _drawing(bar)


def _drawing(bar: Progress) -> Watcher:
    task = bar.add_task("", total=None, rate=0.0, failed=0)
    drawn = 0.0

    def watch(state: State) -> None:
        nonlocal drawn
        if state.last is not None:
            bar.console.print(
                f"failed {state.last.source}: {state.last.error}", markup=False, highlight=False
            )
        now = time.monotonic()
        if now - drawn > _EVERY or state.ended == state.total:
            drawn = now
            bar.update(
                task,
                completed=state.ended,
                total=state.total,
                rate=state.rate,
                failed=state.failed,
            )

    return watch
