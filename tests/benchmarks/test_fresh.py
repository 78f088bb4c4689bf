"""Fresh processes: what they answer, what they are asked, and a failure that is told."""

from __future__ import annotations

from pathlib import Path

import pytest
from benchmarks.alone import seconds_of
from benchmarks.cases import Case, no_mesh
from benchmarks.claims import Contender, Row
from benchmarks.fresh import ask, named


def test_failure_of_the_process_is_told(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match=r"alone: not measured \(exit 1\): StopIteration"):
        ask("alone", "no such row", "no mesh", ("a",), tmp_path, quick=False, runs=1)


def test_a_process_measures_what_it_is_asked(tmp_path: Path) -> None:
    given = "import", "no mesh", ("beltrami", "bare Python"), tmp_path
    ours, bare = ask("alone", *given, quick=False, runs=2)
    assert len(ours) == len(bare) == 2
    assert all(0 < seconds < 60 for seconds in (*ours, *bare))


def test_row_and_mesh_are_found_by_name(tmp_path: Path) -> None:
    row, case = named("adjacency", "blob 10k", tmp_path, quick=True)
    assert (row.name, case.name, case.folder) == ("adjacency", "blob 10k", tmp_path)


def row_of(*contenders: Contender) -> Row:
    return Row("row", "work", lambda case: contenders, ())


def test_only_those_named_run_in_turn_after_a_warm_up(tmp_path: Path) -> None:
    ran: list[str] = []

    def recorded(name: str) -> Contender:
        return Contender(name, lambda _: ran.append(name) or len(ran) / 4, times_itself=True)

    row = row_of(*map(recorded, "abc"))
    times = seconds_of(row, Case("no mesh", tmp_path, no_mesh), ["c", "a"], 3)
    assert ran[:2] == ["c", "a"]
    assert sorted(ran[2:]) == ["a"] * 3 + ["c"] * 3
    assert times == [[(place + 1) / 4 for place in range(2, 8) if ran[place] == x] for x in "ca"]


def test_contender_that_breaks_later_is_told_by_name(tmp_path: Path) -> None:
    calls = iter([1.0])
    broken = Contender("broken", lambda _: next(calls), times_itself=True)
    with pytest.raises(RuntimeError, match="broken: StopIteration"):
        seconds_of(row_of(broken), Case("no mesh", tmp_path, no_mesh), ["broken"], 1)
