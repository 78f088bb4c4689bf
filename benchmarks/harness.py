"""Measure a row: warm up, compare the results, then time everybody in turn."""

from __future__ import annotations

import gc
import random
import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from benchmarks.cases import Case
from benchmarks.claims import BEST_PEER, Contender, Goal, Row

ORDER = 918_273_645


@dataclass(frozen=True)
class Measured:
    """What came out for one contender; ``problem`` says why there are no seconds, if so.

    ``alone`` are the seconds in a process of those alone that the goals compare.
    """

    contender: Contender
    seconds: tuple[float, ...] = ()
    difference: float | None = None
    residual: float | None = None
    problem: str = ""
    memory: int | None = None
    memory_problem: str = ""
    alone: tuple[float, ...] = ()

    @property
    def memory_text(self) -> str:
        """Tell the peak memory in MB, or why it is not known."""
        if self.memory_problem:
            return self.memory_problem
        return "-" if self.memory is None else f"{self.memory / 1e6:.0f}"

    @property
    def median(self) -> float:
        """Median of the runs, in seconds."""
        return statistics.median(self.seconds)

    @property
    def judged(self) -> float:
        """Median of the runs that a goal looks at: those alone, where there are any."""
        return statistics.median(self.alone or self.seconds)

    @property
    def agrees(self) -> bool:
        """Whether the result is the reference's, as far as it is meant to be."""
        limit = self.contender.tolerance
        return self.difference is None or limit is None or self.difference <= limit

    @property
    def is_peer(self) -> bool:
        """Whether it can be the best peer: it ran, it counts, and it did the same work."""
        return bool(
            self.seconds and self.contender.counts and not self.contender.ours and self.agrees
        )


@dataclass(frozen=True)
class Table:
    """A row measured on one mesh; ``problem`` says why the mesh is missing, if so."""

    row: Row
    case: str
    n_vertices: int = 0
    n_faces: int = 0
    measured: tuple[Measured, ...] = ()
    problem: str = ""

    def named(self, name: str) -> Measured | None:
        """Return the contender of this name if it has seconds."""
        found = [one for one in self.measured if one.contender.name == name and one.seconds]
        return found[0] if found else None

    @property
    def strangers(self) -> list[str]:
        """Who was to give the same result, and did not."""
        return [one.contender.name for one in self.measured if one.seconds and not one.agrees]

    @property
    def best_peer(self) -> Measured | None:
        """The fastest peer whose result agrees."""
        peers = [one for one in self.measured if one.is_peer]
        return min(peers, key=lambda one: one.median, default=None)

    def value(self, goal: Goal) -> float | None:
        """Return the number that the goal limits, or None if a part of it is missing."""
        ours = self.named(goal.of)
        if ours is None or not ours.agrees:
            return None
        if goal.against is None:
            return ours.judged
        other = self.against(goal)
        if other is None:
            return None
        return ours.judged - other.judged if goal.less else ours.judged / other.judged

    def against(self, goal: Goal) -> Measured | None:
        """Return the contender that a goal compares with."""
        if goal.against is None:
            return None
        return self.best_peer if goal.against == BEST_PEER else self.named(goal.against)


def described(error: Exception) -> str:
    """Name an error in one line."""
    return f"{type(error).__name__}: {' '.join(str(error).split())}"[:160]


def attempt(work: Callable[..., Any], *arguments: Any) -> tuple[Any, str]:
    """Return the result, or None and the problem in words."""
    try:
        return work(*arguments), ""
    except Exception as error:  # noqa: BLE001 - a peer may raise anything, and it is reported
        return None, described(error)


def timed(contender: Contender, clock: Callable[[], float]) -> tuple[float, Any]:
    """Run once; return the seconds and the result."""
    given = contender.prepare()
    gc.collect()
    gc.disable()
    try:
        start = clock()
        result = contender.run(given)
        seconds = clock() - start
    finally:
        gc.enable()
    return (float(result) if contender.times_itself else seconds), result


def untimed(contender: Contender) -> Any:
    """Run once, so that all is loaded and compiled; return the result."""
    return contender.run(contender.prepare())


class Comparison:
    """Compares results with the first one that is given."""

    def __init__(self, row: Row) -> None:
        self.row = row
        self.reference: Any = None

    def __call__(self, one: Measured, result: Any) -> Measured:
        """Return what was measured, with the difference and the residual of this result."""
        contender = one.contender
        if self.row.difference is None or contender.times_itself:
            return one
        canonical, problem = attempt(contender.canonical, result)
        if problem:
            return replace(one, problem=problem)
        self.reference = canonical if self.reference is None else self.reference
        difference, problem = attempt(self.row.difference, self.reference, canonical)
        residual = None
        if contender.residual is not None and not problem:
            residual, problem = attempt(contender.residual, canonical)
        return replace(one, difference=difference, residual=residual, problem=problem)


def warm_up(row: Row, contenders: Sequence[Contender]) -> list[Measured]:
    """Run everybody once, untimed, and compare each result with the first one there is."""
    compare = Comparison(row)
    found = []
    for contender in contenders:
        result, problem = attempt(untimed, contender)
        one = Measured(contender, problem=problem)
        found.append(one if problem else compare(one, result))
    return found


def once(row: Row, case: Case, small: Case) -> list[Measured]:
    """Warm up on the small mesh; time each one once, and compare these results."""
    compare = Comparison(row)
    warm = {one.name: attempt(untimed, one)[1] for one in row.contenders(small)}
    found = []
    for contender in row.contenders(case):
        outcome, problem = None, warm.get(contender.name, "")
        if not problem:
            outcome, problem = attempt(timed, contender, row.clock)
        if problem:
            found.append(Measured(contender, problem=problem))
            continue
        found.append(compare(Measured(contender, (outcome[0],)), outcome[1]))
        del outcome
    return found


def in_turn(row: Row, measured: list[Measured], runs: int) -> list[Measured]:
    """Time everybody that runs once in each round, the rounds in different orders.

    So a disturbance of the machine falls on all of them, and the median drops it; and nobody
    comes always after the same one, whose data fill the caches.
    """
    order = random.Random(ORDER)  # noqa: S311 - an order, not a secret
    for _ in range(runs):
        for place in order.sample(range(len(measured)), len(measured)):
            one = measured[place]
            if one.problem:
                continue
            outcome, problem = attempt(timed, one.contender, row.clock)
            seconds = () if problem else (*one.seconds, outcome[0])
            measured[place] = replace(one, seconds=seconds, problem=problem)
            del outcome  # with the result: freed here, not inside the next contender's time
    return measured


def measure(row: Row, case: Case, runs: int, small: Case | None = None) -> Table:
    """Warm up, compare and time the contenders of a row on one mesh.

    With a ``small`` mesh to warm up on, the first timed run is the one that is compared.
    """
    _, problem = attempt(lambda: case.faces)
    if problem:
        return Table(row, case.name, problem=problem)
    contenders, problem = attempt(row.contenders, case)
    if problem:
        return Table(row, case.name, problem=problem)
    if small is None:
        measured = in_turn(row, warm_up(row, contenders), runs)
    else:
        measured = in_turn(row, once(row, case, small), runs - 1)
    return Table(row, case.name, len(case.vertices), len(case.faces), tuple(measured))
