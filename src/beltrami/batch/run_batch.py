"""run_batch: one pipeline over many meshes, with nothing lost."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Generator, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import partial

from beltrami._arrays import whole
from beltrami._kinds import checked
from beltrami._optional import require
from beltrami.batch.cluster import local_workers, most_memory, on_workers, one_by_one, workers_at
from beltrami.batch.failures import PipelineError, StoreError, StrictError
from beltrami.batch.memory import BASE, parse_size
from beltrami.batch.pipeline import as_pipeline
from beltrami.batch.results import MANIFEST, TABLE, write_results
from beltrami.batch.sources import Sources, find_sources
from beltrami.batch.state import Failure, State, Tally, Watcher
from beltrami.batch.store import Store
from beltrami.batch.time_limit import parse_time
from beltrami.batch.work import REDO, STOPPED, Job, Outcome
from beltrami.errors import check_name


@dataclass(frozen=True, repr=False)
class Batch:
    """What a batch has done.

    Attributes
    ----------
    state
        The counts at the end.
    failures
        The meshes that failed, by name.
    out
        Where the results are.
    left_out
        Files that a pattern or a folder had and that are no meshes.
    table, manifest
        Names in ``out``: the table with one row for each mesh, and what was done to each.
    """

    state: State
    failures: tuple[Failure, ...]
    out: str
    left_out: int = 0
    table: str = TABLE
    manifest: str = MANIFEST

    def __repr__(self) -> str:
        s = self.state
        return f"<Batch: {s.done} of {s.total} meshes done, {s.failed} failed, in {self.out}>"


@checked
def run_batch(
    sources: Sources,
    pipeline: object,
    out: str | os.PathLike[str],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    memory: str | float | None = None,
    time_limit: str | float | None = None,
    redo: str = "nothing",
    strict: bool = False,
    watch: Watcher | None = None,
) -> Batch:
    """Run a pipeline over many meshes; what is done already is not done again.

    Parameters
    ----------
    sources
        Files, patterns (``"meshes/**/*.ply"``), folders, URLs of fsspec, or a list of them.
    pipeline
        ``"repair, spectrum k=128, descriptors"``, a list, or the name of a TOML file; checked
        as a whole before anything runs. Without a parameter ``repair`` repairs everything.
    out
        A folder, or a URL such as ``s3://bucket/results``. It gets

        ``results.parquet``: one row for each mesh, done or failed, with numbers, spectra and
        descriptors, and the names of files;
        ``manifest.jsonl``: the pipeline and the versions, and a line for each mesh: input hash,
        key, outcome, error, seconds of each step, files with their hashes;
        ``files/``: arrays (npz) and meshes under names that are the hashes of their contents;
        ``work/``: a record for each piece of work, from which a later run goes on.
    workers
        Processes on this machine; by default one for each core that has enough memory. 0 works
        in this process, without Dask.
    scheduler
        The address of a running Dask scheduler (``tcp://...``) instead; sources and ``out`` must
        then mean the same to its workers.
    memory
        What each worker may have: ``"4GB"``, or bytes. By default what the machine has, divided
        among the workers. A mesh that is estimated to need more fails before its work begins.
    time_limit
        What each mesh may take: ``"10min"``, or seconds. One that takes longer fails: its worker
        is stopped, and another one started. It needs workers.
    redo
        ``"nothing"``; ``"failed"``: meshes whose error would come again, too; ``"all"``.
    strict
        Raise at the first mesh that fails, rather than go on.
    watch
        Called with a ``State`` after each mesh.

    Returns
    -------
    Batch

    Raises
    ------
    PipelineError
        If the pipeline cannot run, or an option has a value that cannot be.
    FileNotFoundError
        If a source, or a pattern, has no mesh.
    StrictError
        If ``strict``, and a mesh fails.
    StoreError
        If the results cannot be written, as on a full disk. What is done is whole; a later run
        goes on.
    MissingExtraError
        Without the extra ``batch``.

    Notes
    -----
    A piece of work is known by the hash of the bytes of the input, of the pipeline with all its
    parameters and of the version of beltrami. Its record is written last, and everything is
    written beside and then renamed, so that it may be killed at any moment. The mesh of a worker
    that dies is done again, once. On Ctrl-C the table and the manifest tell of what is done.
    A script that calls this needs ``if __name__ == "__main__":``, for the workers import it.

    Examples
    --------
    >>> import tempfile, beltrami as bt
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     bt.write_mesh(folder + "/a.ply", bt.shapes.icosphere(1))
    ...     done = run_batch(folder, "integrate, spectrum k=4", folder + "/out", workers=0)
    >>> done.state.done, done.state.failed
    (1, 0)
    """
    steps = as_pipeline(pipeline)
    check_name("redo", redo, REDO)
    seconds = None if time_limit is None else parse_time(time_limit)
    require("pyarrow.parquet", "batch", "the table of a batch")
    store = Store(out)
    found = find_sources(sources, store.root if store.is_local else None)
    place = store.root if store.is_local else store.place
    names = [source.name for source in found.sources]
    with (
        store.claimed(),
        _running(workers, scheduler, memory, len(names), ending=seconds is not None) as (
            run,
            allowed,
        ),
    ):
        jobs = (Job(s.name, s.place, steps, place, allowed, redo, seconds) for s in found.sources)
        tally = Tally(len(names), watch)
        try:
            with closing(run(jobs)) as outcomes:
                _collect(tally, outcomes, strict)
        except StoreError:  # the table and the manifest that are there stay as they are
            raise
        except BaseException:
            write_results(store, steps, tally.ordered(names), len(names))
            raise
        ended = tally.ordered(names)
        write_results(store, steps, ended, len(names))
    failures = tuple(Failure(one.name, one.error) for one in ended if one.error is not None)
    return Batch(tally.state(), failures, os.fspath(out), found.left_out)


@contextmanager
def _running(
    workers: int | None,
    scheduler: str | None,
    memory: str | float | None,
    most: int,
    *,
    ending: bool,
) -> Iterator[tuple[Callable[[Iterator[Job]], Generator[Outcome]], int | None]]:
    """Start what does the jobs; yield it, with the bytes that a job may have."""
    allowed = None if memory is None else parse_size(memory)
    if scheduler is not None:
        if workers is not None:
            raise PipelineError(0, "a scheduler has its own workers: give one or the other")
        with workers_at(scheduler, ending=ending) as cluster:
            yield partial(on_workers, cluster), allowed
        return
    if workers is not None and whole("workers", workers, 0) == 0:
        if ending:
            raise PipelineError(0, "a time limit stops the worker that is late: take workers=1")
        yield one_by_one, allowed
        return
    total = most_memory()
    count = min(workers or _count(total, allowed), most)
    share = allowed or total // count
    if share < BASE:
        raise PipelineError(
            0, f"a worker needs {BASE / 1e9:.2f} GB at least, and has {share / 1e9:.2f} GB"
        )
    with local_workers(count, share) as cluster:
        yield partial(on_workers, cluster), share


def _count(total: int, allowed: int | None) -> int:
    """Return how many workers this machine has cores and memory for."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return max(1, min(cores or 1, total // (allowed or 2 * BASE)))


def _collect(tally: Tally, outcomes: Iterator[Outcome], strict: bool) -> None:
    """Count the outcomes as they come in; raise if one is a reason to stop."""
    for outcome in outcomes:
        if outcome.error is not None and outcome.outcome == STOPPED:
            raise StoreError(errno.EIO, outcome.error.message)
        tally.add(outcome)
        if strict and outcome.error is not None:
            raise StrictError(outcome.name, str(outcome.error))
