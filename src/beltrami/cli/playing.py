"""Play the chapters of the tour: one after another, or in several processes where that pays."""

from __future__ import annotations

import os
import signal
import sys
import time
import warnings
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from dataclasses import replace
from importlib import import_module
from multiprocessing import active_children, get_context

from beltrami._progress import Progress
from beltrami.cli.chapters.chapter import Chapter, Stage
from beltrami.cli.remedies import as_commands
from beltrami.errors import BeltramiError

CHAPTERS = (
    "interactive", "surface", "operators", "averaging", "grid", "heat", "denoising", "waves",
    "spectrum", "compression", "maps", "geodesics", "files",
)  # fmt: skip
_LONGEST = ("compression", "denoising", "interactive", "maps")  # begun first
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
_MOST = 4  # processes: there are not more long chapters
LARGE = 5000  # vertices from which the chapters take longer than the start of a process


def play(stage: Stage, progress: Progress) -> list[tuple[Chapter, bool]]:
    """Return the chapters in their order, and whether each could be played on this mesh.

    They share nothing but the mesh and the folder, where each has files of its own.
    """
    processes = min(_MOST, _cores())
    if processes > 1 and stage.mesh.n_vertices >= LARGE:
        return _together(stage, progress, processes)
    played = []
    for done, name in enumerate(CHAPTERS):
        progress(done, len(CHAPTERS))
        played.append(play_one(stage, name))
    return played


def _together(stage: Stage, progress: Progress, processes: int) -> list[tuple[Chapter, bool]]:
    """Play in several processes, the longest chapters first."""
    order = sorted(CHAPTERS, key=lambda name: name not in _LONGEST)
    pool = ProcessPoolExecutor(processes, get_context("spawn"), initializer=_leave_when_asked)
    try:
        with _one_thread_each(), _deaf_until_ready():
            futures = {name: pool.submit(_play_in_process, stage, name) for name in order}
        for done, _ in enumerate(as_completed(futures.values()), 1):
            progress(done, len(CHAPTERS))
        return [futures[name].result() for name in CHAPTERS]
    except BrokenProcessPool as cause:
        raise BeltramiError(
            "a process of the tour died, as it does when the machine is out of memory"
        ) from cause
    except KeyboardInterrupt:
        for child in active_children():
            if child.pid is not None:
                with suppress(OSError):  # it has left already: the terminal asked it too
                    os.kill(child.pid, signal.SIGINT)
        raise
    finally:
        pool.shutdown(cancel_futures=True)


@contextmanager
def _one_thread_each() -> Iterator[None]:
    """Let processes that start now have one thread of BLAS: more would wait for each other.

    They read it from the environment when they load numpy; what the user has set is kept.
    """
    new = [name for name in _THREADS if name not in os.environ]
    os.environ.update(dict.fromkeys(new, "1"))
    try:
        yield
    finally:
        for name in new:
            del os.environ[name]


@contextmanager
def _deaf_until_ready() -> Iterator[None]:
    """Let processes that start now hear Ctrl-C when they can leave without a traceback.

    They inherit what is blocked. Here it is heard late, not lost.
    """
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _cores() -> int:
    """Return how many cores this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not everywhere
        return os.cpu_count() or 1


def play_one(stage: Stage, name: str) -> tuple[Chapter, bool]:
    """Play a chapter; where it cannot be played it says why."""
    act = getattr(import_module(f"beltrami.cli.chapters.{name}"), name)
    start, possible = time.perf_counter(), True
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        try:
            chapter: Chapter = act(stage)
        except BeltramiError as error:
            possible = False
            why = f"Not on this mesh: {as_commands(str(error))}"
            chapter = Chapter(name.capitalize(), "", (why,))
    told = tuple(dict.fromkeys(str(one.message) for one in warned))
    return replace(chapter, seconds=time.perf_counter() - start, warnings=told), possible


def _play_in_process(stage: Stage, name: str) -> tuple[Chapter, bool]:
    """Play a chapter in a process of the pool; nothing more once it was asked to leave.

    The pool takes the end of an interrupted chapter for its result, and hands out the next one.
    """
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        sys.exit(130)
    return play_one(stage, name)


def _leave_when_asked() -> None:
    """Leave a process of the pool by Ctrl-C without a traceback; the first process tells."""
    if hasattr(signal, "pthread_sigmask"):
        signal.signal(signal.SIGINT, _leave_at_once)  # what was asked while it started
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    signal.signal(signal.SIGINT, _leave)


def _leave_at_once(*_: object) -> None:
    """Leave where the pool would log an exception; nothing has been begun that needs an end."""
    os._exit(130)


def _leave(*_: object) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # so that it tidies up in peace, and is known
    sys.exit(130)
