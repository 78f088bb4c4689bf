"""How far a batch is: counts, rates, and what failed."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TypeAlias

from beltrami.batch.record import Problem
from beltrami.batch.work import Outcome


@dataclass(frozen=True)
class Failure:
    """A mesh that failed: its source, and why."""

    source: str
    error: Problem


@dataclass(frozen=True)
class State:
    """How far a batch is.

    Attributes
    ----------
    total, done, failed, reused
        Meshes: all; those done; failures; and how many of both were taken over from earlier runs.
    seconds
        Since the first job was sent.
    last
        The failure that has just come in, if it was one.
    """

    total: int
    done: int = 0
    failed: int = 0
    reused: int = 0
    seconds: float = 0.0
    last: Failure | None = None

    @property
    def ended(self) -> int:
        """How many meshes are done or have failed."""
        return self.done + self.failed

    @property
    def rate(self) -> float:
        """Meshes per second that were worked on: without those taken over."""
        return (self.ended - self.reused) / max(self.seconds, 1e-9)


Watcher: TypeAlias = Callable[[State], object]


@dataclass
class Tally:
    """The outcomes as they come in."""

    total: int
    watch: Watcher | None = None
    outcomes: dict[str, Outcome] = field(default_factory=dict)
    done: int = 0
    reused: int = 0
    start: float = field(default_factory=time.perf_counter)

    def add(self, outcome: Outcome) -> None:
        """Count an outcome, and tell it."""
        self.outcomes[outcome.name] = outcome
        self.done += outcome.error is None
        self.reused += outcome.reused
        if self.watch is not None:
            error = outcome.error
            self.watch(self.state(None if error is None else Failure(outcome.name, error)))

    def state(self, last: Failure | None = None) -> State:
        """Return the counts of now."""
        failed = len(self.outcomes) - self.done
        seconds = time.perf_counter() - self.start
        return State(self.total, self.done, failed, self.reused, seconds, last)

    def ordered(self, names: Iterable[str]) -> list[Outcome]:
        """Return the outcomes in the order of these names, without those that are not there."""
        return [self.outcomes[name] for name in names if name in self.outcomes]
