"""The report: goals met and missed, failures by name, and the numbers behind."""

from __future__ import annotations

from typing import Any

import pytest
from benchmarks.claims import Contender, Goal, Row
from benchmarks.harness import Measured, Table
from benchmarks.report import goals, raw, written


def measured(
    name: str,
    seconds: float = 0,
    ours: bool = False,
    tolerance: float | None = 1e-9,
    **keywords: Any,
) -> Measured:
    contender = Contender(name, lambda _: None, ours=ours, tolerance=tolerance)
    return Measured(contender, (seconds,) * 3 if seconds else (), **keywords)


def table(limit: float, *others: Measured, ours: float = 0.2) -> Table:
    row = Row("row", "the work", lambda case: [], (Goal(limit),))
    first = measured("beltrami", ours, ours=True)
    return Table(row, "mesh", 12, 20, (first, *others))


@pytest.mark.parametrize(("limit", "said"), [(0.25, "met"), (0.2, "met"), (0.19, "**missed**")])
def test_goal_is_met_up_to_its_limit(limit: float, said: str) -> None:
    line = goals([table(limit, measured("peer", 1.0), measured("slow", 2.0))]).splitlines()[-1]
    assert line == (
        f"| the work | mesh | beltrami 0.2000 s | peer 1.0000 s | 0.200 x | <= {limit} x | {said} |"
    )


def test_peer_with_another_result_is_named_beside_the_goal() -> None:
    wrong = measured("wrong", 0.1, difference=0.5)
    text = goals([table(0.25, wrong, measured("peer", 1.0))])
    assert text.endswith("| peer 1.0000 s | 0.200 x | <= 0.25 x | met; OTHER RESULT: wrong |")
    assert "nothing to compare with; OTHER RESULT: wrong" in goals([table(0.25, wrong)])


def test_difference_and_absolute_goals_are_in_seconds() -> None:
    both = (Goal(0.3, against="bare", less=True), Goal(0.1, against=None))
    row = Row("row", "the work", lambda case: [], both)
    ours = measured("beltrami", 1.25, ours=True)
    lines = goals([Table(row, "mesh", measured=(ours, measured("bare", 1.0)))]).splitlines()
    assert lines[2].endswith("| less bare 1.0000 s | 0.250 s | <= 0.3 s | met |")
    assert lines[3].endswith("| - | 1.250 s | <= 0.1 s | **missed** |")


def test_failure_of_ours_is_said_beside_the_goal() -> None:
    row = Row("row", "the work", lambda case: [], (Goal(1),))
    broken = measured("beltrami", ours=True, problem="OSError: no | disk")
    text = goals([Table(row, "mesh", measured=(broken, measured("peer", 1.0)))])
    assert text.endswith("| beltrami | peer 1.0000 s | - | <= 1 x | OSError: no / disk |")


def test_raw_numbers_failures_and_marks() -> None:
    lines = raw(
        table(
            1,
            measured("broken", problem="ImportError: no module"),
            measured("peer", 1.0, difference=2e-13, memory=3_400_000),
            measured("wrong", 1.0, difference=0.5),
            measured("other", 1.0, difference=0.5, tolerance=None),
            measured("heavy", 1.0, memory_problem="the memory was not measured"),
        )
    ).splitlines()
    assert lines[2] == "the work, 12 vertices, 20 faces; 3 runs."
    assert lines[7:] == [
        "| broken | - | - | - | - | FAILED: ImportError: no module |",
        "| peer | 1.0000 | 1.0000 to 1.0000 | 3 | 2.0e-13 |  |",
        "| wrong | 1.0000 | 1.0000 to 1.0000 | - | 5.0e-01 | OTHER RESULT, not counted |",
        "| other | 1.0000 | 1.0000 to 1.0000 | - | 5.0e-01 | another formula |",
        "| heavy | 1.0000 | 1.0000 to 1.0000 | the memory was not measured | - |  |",
    ]


def test_missing_mesh_is_said_in_both_tables() -> None:
    row = Row("row", "the work", lambda case: [], (Goal(1),))
    missing = Table(row, "igea", problem="FileNotFoundError: igea.ply")
    assert goals([missing]).endswith(
        "| the work | igea | - | - | - | - | " + missing.problem + " |"
    )
    assert "NOT MEASURED: FileNotFoundError: igea.ply" in raw(missing)


def test_report_tells_where_when_and_with_what() -> None:
    text = written([table(1, measured("peer", 1.0))])
    for needed in ("| date |", "| processor |", "| memory |", "OMP_NUM_THREADS=", "| numpy |"):
        assert needed in text
