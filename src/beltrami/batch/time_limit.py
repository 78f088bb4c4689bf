"""A limit of time for each mesh: the process that works on one for longer ends, wherever it is.

Compiled code does not return to Python to be told that it is late, so nothing inside of Python
can stop it. What can is a thread of the system that asks Python for nothing (``faulthandler``).
The mark, a file, tells whoever takes the mesh next that it was late, and in which step.
"""

from __future__ import annotations

import faulthandler
import os
import re
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from numbers import Real
from pathlib import Path
from typing import IO, Final

from beltrami.batch.failures import PipelineError, TimeLimitError
from beltrami.batch.record import FAILED, Problem
from beltrami.batch.store import INCOMING, MARK
from beltrami.batch.work import STOPPED, Job, Outcome, process
from beltrami.errors import shown

_MOST: Final = 1e9  # seconds: 30 years
_LATE: Final = b"Timeout ("  # how faulthandler begins
_TIME: Final = re.compile(r"(\d+(?:\.\d*)?)\s*(s|sec|min|m|h|d)?", re.IGNORECASE)
_SECONDS: Final = {"s": 1, "sec": 1, "m": 60, "min": 60, "h": 3600, "d": 86400}


def parse_time(text: object) -> float:
    """Return seconds: of ``10min``, ``90s``, ``1.5 h``; a number is a number of seconds.

    Raises
    ------
    PipelineError
        If it is no time above zero.

    Examples
    --------
    >>> parse_time("10min"), parse_time("1.5 h"), parse_time("90"), parse_time(0.5)
    (600.0, 5400.0, 90.0, 0.5)
    """
    seconds = 0.0
    if isinstance(text, str):
        if found := _TIME.fullmatch(text.strip()):
            seconds = float(found[1]) * _SECONDS[(found[2] or "s").lower()]
    elif isinstance(text, Real) and not isinstance(text, bool):
        seconds = float(text) if text < _MOST else 0.0
    if not 1e-6 <= seconds < _MOST:
        raise PipelineError(0, f"a time limit is a time such as 10min, not {shown(text)}")
    return seconds


def process_in_time(job: Job, name: str) -> Outcome:
    """Do the work on one mesh, or end this process when it is late; tell if one was before.

    Parameters
    ----------
    job
        With its limit of time.
    name
        Of this piece of work in this run, the same when it is done again.
    """
    late = told_late(job, name)
    if late is not None:
        return late
    if job.seconds is None:
        return process(job)
    mark = _mark(job, name)
    try:
        mark.parent.mkdir(parents=True, exist_ok=True)
        file = mark.open("wb", buffering=0)
    except OSError as error:
        reason = f"results cannot be written: {error.strerror}"
        return Outcome(job.name, STOPPED, error=Problem("StoreError", reason))
    try:
        with file, _clock(job.seconds, file) as tell:
            return process(job, tell)
    finally:
        mark.unlink(missing_ok=True)


def told_late(job: Job, name: str) -> Outcome | None:
    """Return the outcome of a mesh whose process was ended because it was late; forget the mark."""
    mark = _mark(job, name)
    try:
        before, late, _ = mark.read_bytes().partition(_LATE)
    except OSError:  # no mark: nobody has begun, or on another machine
        return None
    if not late or job.seconds is None:
        return None
    mark.unlink(missing_ok=True)
    step = before.decode(errors="replace").strip().rpartition("\n")[2]
    error = TimeLimitError(job.seconds)
    return Outcome(job.name, FAILED, error=Problem(type(error).__name__, str(error), step))


def _mark(job: Job, name: str) -> Path:
    """Return the mark: in the results, or in a folder of this machine if they are elsewhere."""
    home = tempfile.gettempdir() if "://" in job.store else os.path.join(job.store, INCOMING)
    return Path(home, name + MARK)


@contextmanager
def _clock(seconds: float, file: IO[bytes]) -> Iterator[Callable[[str], object]]:
    """End this process after so many seconds; yield what notes a step in the file."""

    def tell(step: str) -> None:
        with suppress(OSError):  # of a full disk: whoever writes results will say so
            file.write(step.encode() + b"\n")

    most = min(seconds, threading.TIMEOUT_MAX)  # on Windows 49 days: more would be an error
    faulthandler.dump_traceback_later(most, exit=True, file=file)
    try:
        yield tell
    finally:
        faulthandler.cancel_dump_traceback_later()
