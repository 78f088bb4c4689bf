"""What was measured is kept: a run that was stopped goes on, and nothing changes on the way."""

from __future__ import annotations

from pathlib import Path

from benchmarks.cases import Case, no_mesh
from benchmarks.claims import Contender, Row
from benchmarks.harness import Measured, Table
from benchmarks.kept import keep, kept


def contenders(_: Case) -> list[Contender]:
    return [Contender("beltrami", lambda _: 1, ours=True), Contender("peer", lambda _: 2)]


def test_table_comes_back_as_it_was(tmp_path: Path) -> None:
    row, case = Row("row", "work", contenders, ()), Case("no mesh", tmp_path, no_mesh)
    ours, peer = contenders(case)
    measured = (
        Measured(ours, (0.25, 0.5), difference=0.0, residual=1e-16, memory=12),
        Measured(peer, problem="OSError: no licence", memory_problem="not measured"),
    )
    table = Table(row, case.name, 12, 20, measured)
    keep(tmp_path, table)
    again = kept(tmp_path, row, case)
    assert again is not None
    assert (again.n_vertices, again.n_faces, again.case) == (12, 20, "no mesh")
    for one, before in zip(again.measured, measured, strict=True):
        assert one.contender.name == before.contender.name
        assert one.contender.ours == before.contender.ours
        assert one.seconds == before.seconds
        assert (one.difference, one.residual) == (before.difference, before.residual)
        assert (one.memory, one.problem) == (before.memory, before.problem)
        assert one.memory_problem == before.memory_problem


def test_what_was_not_measured_is_not_there(tmp_path: Path) -> None:
    row, case = Row("row", "work", contenders, ()), Case("no mesh", tmp_path, no_mesh)
    assert kept(tmp_path, row, case) is None
    keep(tmp_path, Table(row, case.name, problem="no such file"))
    assert kept(tmp_path, row, case) is None
    keep(tmp_path, Table(Row("other", "work", contenders, ()), case.name))
    assert kept(tmp_path, row, case) is None


def test_a_run_that_goes_on_loses_nothing_of_what_it_does_not_measure(tmp_path: Path) -> None:
    case = Case("no mesh", tmp_path, no_mesh)
    one, two = (Row(name, "work", contenders, ()) for name in ("one", "two"))
    for row, vertices in ((one, 1), (two, 2), (one, 3)):
        keep(tmp_path, Table(row, case.name, vertices))
    again = [kept(tmp_path, row, case) for row in (one, two)]
    assert [table.n_vertices for table in again if table is not None] == [3, 2]
