"""The work on one mesh: read, look whether it is done, run the steps, keep what they found."""

from __future__ import annotations

import platform
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from typing import Any, Final

from beltrami.batch.failures import StoreError, TooLargeError
from beltrami.batch.pipeline import Pipeline
from beltrami.batch.reading import Input, mesh_of, read_input
from beltrami.batch.record import FAILED, Problem, Record, decoded
from beltrami.batch.sources import readable
from beltrami.batch.store import Kept, Store, work_name
from beltrami.batch.verb import Scene, Size
from beltrami.errors import BeltramiError, MissingExtraError

STOPPED: Final = "stopped"  # the results cannot be written: nothing to do with the mesh
REDO: Final = ("nothing", "failed", "all")
_CALCULATES: Final = ("beltrami", "numpy", "scipy", "numba")


@dataclass(frozen=True, slots=True)
class Job:
    """What a worker needs to know of a mesh, in plain words.

    Attributes
    ----------
    name, place
        Of the source.
    pipeline
        As checked by the client.
    store
        Where results go.
    allowed
        Bytes of memory that the process may have; None is no limit.
    redo
        ``"nothing"`` that is done already, what ``"failed"``, or ``"all"``.
    seconds
        What it may take in a process of its own; None is no limit.
    """

    name: str
    place: str
    pipeline: Pipeline
    store: str
    allowed: int | None = None
    redo: str = "nothing"
    seconds: float | None = None


@dataclass(frozen=True, slots=True)
class Outcome:
    """How the work on a mesh ended.

    Attributes
    ----------
    name
        Of the source.
    outcome
        ``"done"``, ``"failed"`` or ``"stopped"``.
    key
        Of the record, if there is one: of what is done, and of failures that would come again.
    sha256, bytes
        Of the input, as far as it was read.
    reused
        Whether it was done before.
    error
        Why not.
    """

    name: str
    outcome: str
    key: str = ""
    sha256: str = ""
    bytes: int = -1
    reused: bool = False
    error: Problem | None = None


def _nobody(_step: str) -> None:
    """Note nothing."""


def process(job: Job, tell: Callable[[str], object] = _nobody) -> Outcome:
    """Do the work on one mesh; whatever happens to the mesh is told, and not raised.

    Each step is told to ``tell`` when it begins.

    A failure is kept as a record if it follows from the bytes and the pipeline alone. What
    circumstances cause (a source that cannot be read, too little memory) is told and not kept,
    so that the next run tries again.
    """
    step = "reading"
    try:
        store = _store(job.store)
        tell(step)
        given = read_input(job.name, job.place, job.allowed)
        step = ""  # from here on the steps put their names on their errors
        return _known(job, store, given) or _worked(job, store, given, tell)
    except StoreError as error:
        return Outcome(job.name, STOPPED, error=_problem(error))
    except Exception as error:  # noqa: BLE001 - remote file systems raise anything
        return Outcome(job.name, FAILED, error=_problem(error, step, job.allowed))


def _known(job: Job, store: Store, given: Input) -> Outcome | None:
    """Return the outcome of earlier work on these bytes, if it is whole."""
    key = _key(job, given)
    if job.redo == "all":
        return None
    record = decoded(store.read([work_name(key)])[0], key, job.pipeline)
    if record is None or (job.redo == "failed" and record.error is not None):
        return None
    if any(store.size(kept.name) != kept.bytes for kept in record.files.values()):
        return None
    return _outcome(job, given, record, reused=True)


def _worked(job: Job, store: Store, given: Input, tell: Callable[[str], object]) -> Outcome:
    """Run the steps and write the record, which is the last thing that happens."""
    bench = _Bench(job.pipeline, store, job.allowed, tell)
    error = bench.run(given)
    record = Record(
        _key(job, given),
        {"sha256": given.sha256, "bytes": given.bytes, "suffix": given.suffix},
        job.pipeline.plain,
        versions(),
        bench.row,
        bench.files,
        bench.seconds,
        error,
        datetime.now(UTC).isoformat(timespec="seconds"),
    )
    if bench.passing:
        return Outcome(job.name, FAILED, "", given.sha256, given.bytes, False, record.error)
    store.replace(work_name(record.key), lambda path: path.write_bytes(record.encoded()))
    return _outcome(job, given, record, reused=False)


@dataclass
class _Bench:
    """The steps on one mesh, one after another."""

    pipeline: Pipeline
    store: Store
    allowed: int | None
    tell: Callable[[str], object]
    row: dict[str, Any] = field(default_factory=dict)
    files: dict[str, Kept] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)
    passing: bool = False  # whether the failure is one of circumstances

    def run(self, given: Input) -> Problem | None:
        """Run all steps; return why it stopped before the end, if it did."""
        label = "reading"
        try:
            with self._timed(label):
                scene = Scene(mesh_of(given, self.allowed))
            self._require_room(Size(scene.mesh.n_vertices, scene.mesh.n_faces))
            for step in self.pipeline.steps:
                label = step.label
                with self._timed(label):
                    told = step.verb.run(scene, step.options)
                    if told.write is not None:
                        self.files[label] = self.store.keep(told.suffix, told.write)
                scene = told.scene
                self.row |= {f"{label}.{name}": value for name, value in told.facts.items()}
        except StoreError:
            raise
        except (MemoryError, MissingExtraError, OSError) as error:
            self.passing = True
            return _problem(error, label, self.allowed)
        except Exception as error:  # noqa: BLE001 - an error of ours is to stop one mesh only
            return _problem(error, label)
        return None

    @contextmanager
    def _timed(self, label: str) -> Iterator[None]:
        self.tell(label)
        start = time.thread_time()
        try:
            yield
        finally:
            self.seconds[label] = round(time.thread_time() - start, 6)

    def _require_room(self, size: Size) -> None:
        needed, where = self.pipeline.estimate(size)
        if self.allowed is not None and needed > self.allowed:
            what = f"{where} of {size.n_vertices} vertices and {size.n_faces} faces"
            raise TooLargeError(what, needed, self.allowed)


def _outcome(job: Job, given: Input, record: Record, *, reused: bool) -> Outcome:
    size = given.bytes
    return Outcome(job.name, record.outcome, record.key, given.sha256, size, reused, record.error)


def _key(job: Job, given: Input) -> str:
    return job.pipeline.key(given.sha256, given.suffix, versions()["beltrami"])


def _problem(error: Exception, step: str = "", limit: int | None = None) -> Problem:
    """Put an exception into one line."""
    text = readable(" ".join(str(error).split())) or type(error).__name__
    if isinstance(error, MemoryError) and not isinstance(error, BeltramiError):
        within = f" of {limit / 1e9:.2f} GB" if limit is not None else ""
        text = f"out of memory: more than the limit{within} was needed. {text}"
    return Problem(type(error).__name__, text[:2000], step)


@lru_cache(maxsize=4)
def _store(place: str) -> Store:
    return Store(place)


@lru_cache(maxsize=1)
def versions() -> dict[str, str]:
    """Return the versions of what computes."""
    found = {"python": platform.python_version()}
    for name in _CALCULATES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:  # run from a folder without having been installed
            found[name] = "unknown"
    return found
