"""Running jobs: in this process, or on the workers of a Dask scheduler, of ours or of others."""

from __future__ import annotations

import logging
import signal
import threading
import uuid
from collections.abc import Generator, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from typing import Any, Final

from beltrami._optional import require
from beltrami.batch.limits import at_most
from beltrami.batch.record import FAILED, Problem
from beltrami.batch.time_limit import process_in_time, told_late
from beltrami.batch.work import Job, Outcome, process
from beltrami.errors import BeltramiError

_AHEAD: Final = 2  # jobs sent for each thread, so that none waits for the client
_THREADS: Final = ("OMP", "OPENBLAS", "MKL", "NUMBA", "VECLIB")
_ENVIRONMENT: Final = "distributed.nanny.pre-spawn-environ"
_CONFIG: Final[Mapping[str, Any]] = {
    "distributed.scheduler.allowed-failures": 1,  # a job is done again once, on a new worker
    "distributed.scheduler.worker-ttl": None,  # compiled code may keep a worker silent for long
    "distributed.scheduler.worker-saturation": 1.0,  # no job waits behind one that may kill
    "distributed.worker.memory.target": False,
    "distributed.worker.memory.spill": False,
    "distributed.worker.memory.pause": False,
    "distributed.worker.memory.terminate": 0.95,
    **{f"{_ENVIRONMENT}.{name}_NUM_THREADS": 1 for name in _THREADS},
}


@dataclass(frozen=True)
class Workers:
    """A client of a scheduler, and the workers that were stopped because of their memory."""

    client: Any
    overfull: set[str] = field(default_factory=set)

    @property
    def count(self) -> int:
        """How many jobs run at a time."""
        return sum(self.client.nthreads().values())


def one_by_one(jobs: Iterator[Job]) -> Generator[Outcome]:
    """Do the jobs in this process."""
    for job in jobs:
        yield process(job)


def most_memory() -> int:
    """Return the bytes of memory of this machine, or of the container that this is."""
    return int(require("distributed.system", "batch", "a batch of several workers").MEMORY_LIMIT)


@contextmanager
def local_workers(count: int, memory: int) -> Iterator[Workers]:
    """Start worker processes on this machine: one thread each, and one of the linear algebra.

    A worker that takes more than ``memory`` bytes is stopped, and another one started. They talk
    through TLS with keys of this run, because who can talk to a worker can make it do anything.
    """
    require("cryptography", "batch", "a batch of several workers")
    distributed = require("distributed", "batch", "a batch of several workers")
    dask = require("dask", "batch", "a batch of several workers")
    with dask.config.set(_CONFIG):
        with _deaf_children():
            cluster = distributed.LocalCluster(
                n_workers=count,
                threads_per_worker=1,
                processes=True,
                memory_limit=memory,
                security=distributed.Security.temporary(),
                dashboard_address="127.0.0.1:0",
                silence_logs=logging.CRITICAL,
            )
        with cluster, distributed.Client(cluster) as client, _listening() as overfull:
            yield Workers(client, overfull)


@contextmanager
def workers_at(address: str, *, ending: bool = False) -> Iterator[Workers]:
    """Connect to a scheduler that somebody has started.

    With ``ending`` its workers must be processes that may end, because others watch over them.
    """
    distributed = require("distributed", "batch", "a batch on a cluster")
    try:
        client = distributed.Client(address, timeout="10s")
    except (OSError, ValueError) as cause:
        raise BeltramiError(f"no scheduler answers at {address}: {cause}") from cause
    with client:
        found = Workers(client)
        if not found.count:
            raise BeltramiError(f"the scheduler at {address} has no workers: start some")
        if ending and client.run_on_scheduler(_shared):
            raise BeltramiError(
                "a time limit ends workers: start them with one thread, and with a nanny that "
                "starts another one (dask worker --nthreads 1 --nanny)"
            )
        yield found


def _shared(dask_scheduler: Any) -> bool:
    """Say whether a worker has several threads, or nobody who starts another one."""
    workers = dask_scheduler.workers.values()
    return any(worker.nthreads != 1 or not worker.nanny for worker in workers)


def on_workers(workers: Workers, jobs: Iterator[Job]) -> Generator[Outcome]:
    """Do the jobs on workers, and yield each outcome when it is there.

    Only a few jobs for each thread are with the scheduler at a time, so that a million is no
    burden to it. The job of a worker that dies is done again by another one.

    Raises
    ------
    BeltramiError
        If the scheduler is lost.
    """
    distributed = require("distributed", "batch", "a batch of several workers")
    run = uuid.uuid4().hex[:12]
    live: dict[str, tuple[Any, Job]] = {}
    pending = distributed.as_completed([])
    ahead, sent = _AHEAD * max(1, workers.count), 0
    try:
        while True:
            while len(live) < ahead and (job := next(jobs, None)) is not None:
                key = f"{run}-{sent}"
                future = workers.client.submit(_limited, job, key, key=key, pure=False)
                live[key] = future, job
                pending.add(future)
                sent += 1
            if not live:
                return
            future, job = live.pop(next(pending).key)
            outcome = _outcome_of(future, job, workers)
            del future  # so that nobody keeps what it returned, or does it again
            yield outcome
    finally:
        with suppress(Exception):  # the connection may be gone with what is being cancelled
            workers.client.cancel([future for future, _ in live.values()], force=True)


def _limited(job: Job, key: str) -> Outcome:
    """Do a job under its limits of memory and time, if this process does one job at a time."""
    alone = require("distributed", "batch", "a batch").get_worker().state.nthreads == 1
    with at_most(job.allowed if alone else None):
        return process_in_time(job, key) if alone else process(job)


def _outcome_of(future: Any, job: Job, workers: Workers) -> Outcome:
    """Return what a worker returned, or why none could."""
    distributed = require("distributed", "batch", "a batch")
    try:
        outcome: Outcome = future.result()
    except distributed.KilledWorker as error:
        late = told_late(job, future.key)
        if late is not None:
            return late
        count = error.allowed_failures + 1
        if error.last_worker.address in workers.overfull:
            reason = "out of memory: the worker went beyond its limit, and was stopped"
        else:
            reason = "the worker died, as it does when the machine is out of memory"
            reason += "" if job.seconds is None else ", or the mesh late on several machines"
        text = f"{reason}, {count} times. Allow more memory, or take fewer workers"
        return Outcome(job.name, FAILED, error=Problem("KilledWorker", text))
    except (distributed.client.FutureCancelledError, OSError) as cause:
        raise BeltramiError(
            "the scheduler was lost. What is done is kept; run it again to go on"
        ) from cause
    return outcome


@contextmanager
def _deaf_children() -> Iterator[None]:
    """Start processes that do not hear Ctrl-C, which is for this one to handle."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def _listening() -> Iterator[set[str]]:
    """Collect the addresses of workers that are stopped because of their memory."""
    logger = logging.getLogger("distributed")
    ears = _Ears()
    logger.addHandler(ears)
    try:
        yield ears.heard
    finally:
        logger.removeHandler(ears)


class _Ears(logging.Handler):
    """Note the first argument of messages that tell of a limit."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.heard: set[str] = set()

    def emit(self, record: logging.LogRecord) -> None:
        """Note the address of a worker that "exceeded" its memory."""
        text = record.getMessage()
        if "exceeded" in text:
            self.heard.update(word for word in text.split() if "://" in word)
