"""The harness: what is timed, in which order, what counts, and what is told."""

from __future__ import annotations

import gc
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from benchmarks.cases import Case, no_mesh
from benchmarks.claims import Contender, Goal, Row
from benchmarks.harness import Table, measure, timed


def apart(a: float, b: float) -> float:
    return abs(a - b)


def table_of(
    tmp_path: Path, contenders: Sequence[Contender], runs: int = 3, **keywords: Any
) -> Table:
    row = Row("row", "work", lambda case: contenders, (), **keywords)
    return measure(row, Case("no mesh", tmp_path, no_mesh), runs)


def taking(seconds: float, name: str, **keywords: Any) -> Contender:
    return Contender(name, lambda _: seconds, times_itself=True, **keywords)


class Clock:
    """A clock that goes on only when it is told to."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now

    def after(self, seconds: float, result: Any = None) -> Callable[..., Any]:
        def work(*_: Any) -> Any:
            self.now += seconds
            return result

        return work


def test_only_the_run_is_timed() -> None:
    clock = Clock()
    contender = Contender("a", clock.after(2.5, "done"), prepare=clock.after(100))
    assert timed(contender, clock) == (2.5, "done")


def test_run_gets_what_was_prepared_and_its_own_seconds_count() -> None:
    contender = Contender("a", lambda given: 2 * given, prepare=lambda: 7, times_itself=True)
    assert timed(contender, Clock())[0] == 14


def test_collector_is_off_during_the_run_and_on_after_a_failure() -> None:
    def run(_: None) -> None:
        assert not gc.isenabled()
        raise ValueError

    with pytest.raises(ValueError):
        timed(Contender("a", run), Clock())
    assert gc.isenabled()


def test_each_round_has_everybody_once_and_the_orders_differ(tmp_path: Path) -> None:
    ran: list[str] = []

    def recorded(name: str) -> Contender:
        return Contender(name, lambda _: ran.append(name))

    table_of(tmp_path, [recorded(name) for name in "abcd"], runs=8)
    assert ran[:4] == list("abcd")  # the warm-up
    rounds = [tuple(ran[start : start + 4]) for start in range(4, len(ran), 4)]
    assert len(rounds) == 8
    assert all(sorted(one) == list("abcd") for one in rounds)
    assert len(set(rounds)) > 2


def test_median_drops_a_disturbance(tmp_path: Path) -> None:
    times = iter([9.0, 1.0, 50.0, 1.2])  # the first one is the warm-up
    contender = Contender("a", lambda _: next(times), times_itself=True)
    (measured,) = table_of(tmp_path, [contender]).measured
    assert measured.seconds == (1.0, 50.0, 1.2)
    assert measured.median == 1.2


def test_result_that_differs_is_no_best_peer(tmp_path: Path) -> None:
    contenders = [
        Contender("ours", lambda _: 1.0, ours=True),
        Contender("wrong", lambda _: 1.1, tolerance=0.05),
        Contender("right", lambda _: 1.01, tolerance=0.05),
        Contender("other formula", lambda _: 9.0, tolerance=None),
    ]
    table = table_of(tmp_path, contenders, difference=apart)
    assert table.strangers == ["wrong"]
    assert [one.is_peer for one in table.measured] == [False, False, True, True]
    assert table.measured[3].difference == 8.0


def test_no_ratio_is_claimed_for_a_wrong_result_of_ours(tmp_path: Path) -> None:
    contenders = [
        Contender("ours", lambda _: 1.0, ours=True),
        Contender("ours, variant", lambda _: 2.0, ours=True),
        Contender("peer", lambda _: 1.0),
    ]
    table = table_of(tmp_path, contenders, difference=apart)
    assert table.value(Goal(1, of="ours")) is not None
    assert table.value(Goal(1, of="ours, variant")) is None


def test_result_is_compared_in_its_canonical_form(tmp_path: Path) -> None:
    contenders = [
        Contender("ours", lambda _: 2.0, ours=True),
        Contender("negative", lambda _: -2.0, canonical=lambda x: -x),
    ]
    assert table_of(tmp_path, contenders, difference=apart).measured[1].difference == 0


def test_best_peer_is_the_fastest_that_counts(tmp_path: Path) -> None:
    contenders = [
        taking(1.0, "ours", ours=True),
        taking(2.0, "ours, variant", ours=True),
        taking(5.0, "slow"),
        taking(4.0, "fast"),
        taking(0.1, "floor", counts=False),
    ]
    table = table_of(tmp_path, contenders)
    assert table.best_peer is not None
    assert table.best_peer.contender.name == "fast"
    assert table.value(Goal(1, of="ours")) == 0.25
    assert table.value(Goal(1, of="ours, variant")) == 0.5
    assert table.value(Goal(1, of="ours", against="floor")) == 10
    assert table.value(Goal(1, of="ours", against="slow", less=True)) == -4
    assert table.value(Goal(1, of="ours", against=None)) == 1
    assert table.value(Goal(1, of="nobody")) is None
    assert table.value(Goal(1, of="ours", against="nobody")) is None


def test_failure_is_told_by_name_and_stops_nobody_else(tmp_path: Path) -> None:
    def fail(_: None) -> None:
        raise OSError("no such\nlibrary")

    calls = iter([None, None])

    def fail_later(_: None) -> None:
        next(calls)

    contenders = [
        Contender("broken", fail),
        Contender("breaks later", fail_later),
        Contender("missing", lambda _: None, prepare=lambda: __import__("no_such_package")),
        taking(3.0, "works"),
    ]
    table = table_of(tmp_path, contenders)
    broken, later, missing, works = table.measured
    assert broken.problem == "OSError: no such library"
    assert later.problem.startswith("StopIteration")
    assert not later.seconds
    assert "no_such_package" in missing.problem
    assert works.seconds == (3.0, 3.0, 3.0)
    assert table.best_peer is works


def test_reference_is_the_first_that_runs(tmp_path: Path) -> None:
    def fail(_: None) -> float:
        raise OSError

    contenders = [
        Contender("ours", fail, ours=True),
        Contender("a", lambda _: 1.0),
        Contender("b", lambda _: 4.0),
    ]
    table = table_of(tmp_path, contenders, difference=apart)
    assert [one.difference for one in table.measured] == [None, 0, 3]
    assert table.value(Goal(1, of="ours")) is None


def test_mesh_that_cannot_be_made_is_told(tmp_path: Path) -> None:
    def fail() -> Any:
        raise FileNotFoundError("igea.ply")

    row = Row("row", "work", lambda case: [taking(1.0, "ours")], ())
    table = measure(row, Case("igea", tmp_path, fail), 3)
    assert table.problem == "FileNotFoundError: igea.ply"
    assert not table.measured


def test_table_tells_the_size_of_the_mesh(tmp_path: Path) -> None:
    row = Row("row", "work", lambda case: [], ())
    case = Case("small", tmp_path, lambda: (np.zeros((5, 3)), np.zeros((2, 3), np.int64)))
    table = measure(row, case, 1)
    assert (table.n_vertices, table.n_faces) == (5, 2)


def test_large_row_warms_up_on_the_small_mesh_and_compares_what_it_times(tmp_path: Path) -> None:
    ran: list[tuple[str, str]] = []

    def contenders(case: Case) -> list[Contender]:
        def named(name: str, result: float) -> Contender:
            def run(_: None) -> float:
                ran.append((case.name, name))
                return result

            return Contender(name, run, residual=lambda x: x / 8)

        found = [named("beltrami", 2.0), named("peer", 2.5)]
        return [*found, named("small only", 0.0)] if case.name == "small" else found

    row = Row("row", "work", contenders, (), difference=apart)
    table = measure(row, Case("large", tmp_path, no_mesh), 2, Case("small", tmp_path, no_mesh))
    assert [name for case, name in ran if case == "small"] == ["beltrami", "peer", "small only"]
    assert len([name for case, name in ran if case == "large"]) == 4  # no warm-up there
    assert [one.difference for one in table.measured] == [0, 0.5]
    assert [one.residual for one in table.measured] == [0.25, 0.3125]
    assert [len(one.seconds) for one in table.measured] == [2, 2]


def test_contender_that_fails_on_the_small_mesh_is_not_timed_on_the_large(tmp_path: Path) -> None:
    def contenders(case: Case) -> list[Contender]:
        def run(_: None) -> float:
            if case.name == "small":
                raise OSError("no licence")
            return 1.0

        return [Contender("peer", run)]

    row = Row("row", "work", contenders, (), difference=apart)
    both = Case("large", tmp_path, no_mesh), 1, Case("small", tmp_path, no_mesh)
    (one,) = measure(row, *both).measured
    assert one.problem == "OSError: no licence"
    assert not one.seconds
