"""What a row says: who does the work, how the results are compared, and the goals."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from benchmarks.cases import Case

BEST_PEER = "the best peer"


def nothing() -> None:
    """Prepare nothing."""


def as_it_is(result: Any) -> Any:
    """Compare the result as it is."""
    return result


@dataclass(frozen=True)
class Contender:
    """One way to do the work of a row.

    Parameters
    ----------
    name
        As the report prints it.
    run
        The work; it gets what ``prepare`` returned, and only it is timed.
    prepare
        Called before each run, not timed: fresh objects for work that caches or writes in place.
    canonical
        Brings a result into the form that the row compares; not timed.
    ours
        Whether this is beltrami.
    counts
        Whether a peer may be "the best peer": not a floor, nor a part of the work.
    tolerance
        Largest difference to the reference at which the work counts as the same; None where the
        peer's formula is another one: the difference is then shown and judged by the reader.
    times_itself
        ``run`` returns the seconds, because they are not those of the call.
    residual
        How far a canonical result is from solving its problem; None where that means nothing.
    """

    name: str
    run: Callable[[Any], Any]
    prepare: Callable[[], Any] = nothing
    canonical: Callable[[Any], Any] = as_it_is
    ours: bool = False
    counts: bool = True
    tolerance: float | None = 1e-9
    times_itself: bool = False
    residual: Callable[[Any], float] | None = None


@dataclass(frozen=True)
class Goal:
    """A number to reach, from GOALS: ``of`` over (or less) ``against`` is at most ``limit``.

    Parameters
    ----------
    limit
        The largest value that meets the goal.
    of
        The name of the contender that is judged.
    against
        ``BEST_PEER``, the name of another contender, or None for the seconds of ``of`` alone.
    less
        Subtract the seconds of ``against`` rather than divide by them.
    """

    limit: float
    of: str = "beltrami"
    against: str | None = BEST_PEER
    less: bool = False

    @property
    def unit(self) -> str:
        """``x`` for a ratio, ``s`` for seconds."""
        return "s" if self.less or self.against is None else "x"


@dataclass(frozen=True)
class Row:
    """One claim: the work, on meshes of one size.

    Parameters
    ----------
    name
        What the command line calls it.
    work
        What is done, in the words of the table.
    contenders
        Makes the list for a case; the first one that runs is the reference of the comparison.
    goals
        The numbers to reach.
    difference
        Distance of two canonical results; None where there is nothing to compare.
    size
        About how many vertices the meshes have; 0 for work without a mesh.
    runs
        How often each contender runs, in turn with the others.
    clock
        CPU seconds of this process, unless the work is done by others.
    memory
        Whether the peak memory of one run means something.
    large
        Measured with ``--large``, for a report of its own: it takes many minutes. The warm-up is
        on a small mesh, and the first timed run gives the result that is compared.
    alone
        Those that the goals compare are timed in turn in a process that nobody else runs in, and
        the goals are judged by that. For work that takes and frees much memory: the first touch of
        pages is up to half of its time, or nothing after others have touched and freed them.
    """

    name: str
    work: str
    contenders: Callable[[Case], Sequence[Contender]]
    goals: Sequence[Goal]
    difference: Callable[[Any, Any], float] | None = None
    size: int = 134_000
    runs: int = 7
    clock: Callable[[], float] = time.process_time
    memory: bool = True
    large: bool = False
    alone: bool = False
