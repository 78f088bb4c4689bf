"""The command line: which rows, and where the report goes."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from benchmarks.claims import Contender, Goal, Row
from benchmarks.threads import VARIABLES, one_thread

from benchmarks import command


def row(name: str, large: bool = False) -> Row:
    def contenders(_: object) -> list[Contender]:
        return [
            Contender("beltrami", lambda _: 1.0, ours=True, times_itself=True),
            Contender("peer", lambda _: 4.0, times_itself=True),
        ]

    return Row(name, f"the work of {name}", contenders, (Goal(0.5),), size=0, large=large)


@pytest.fixture(autouse=True)
def report(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(command, "ROWS", (row("first"), row("second"), row("long", large=True)))
    monkeypatch.setattr(command, "REPORT", tmp_path / "BENCHMARKS.md")
    monkeypatch.setattr(command, "REPORT_LARGE", tmp_path / "BENCHMARKS-LARGE.md")
    monkeypatch.setattr(command, "small", lambda folder: command.cases(0, folder)[0])
    return tmp_path / "BENCHMARKS.md"


def test_full_run_writes_the_report(report: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main([]) == 0
    text = report.read_text()
    assert "the work of first | no mesh | beltrami 1.0000 s | peer 4.0000 s | 0.250 x" in text
    assert "the work of second" in text
    assert "the work of long" not in text
    assert "0.250 x" in capsys.readouterr().out


def test_large_rows_have_a_report_of_their_own(report: Path) -> None:
    assert command.main(["--large"]) == 0
    assert not report.exists()
    text = report.with_name("BENCHMARKS-LARGE.md").read_text()
    assert "### long: no mesh" in text
    assert "### first" not in text


@pytest.mark.parametrize("arguments", [["second"], ["--quick"]])
def test_part_of_a_run_is_printed_and_leaves_the_report(
    arguments: list[str], report: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command.main(arguments) == 0
    assert not report.exists()
    printed = capsys.readouterr().out
    assert "### second: no mesh" in printed
    assert ("### first" in printed) == (arguments == ["--quick"])


def test_output_and_runs(tmp_path: Path) -> None:
    target = tmp_path / "part.md"
    folder = tmp_path / "kept"
    command.main(["first", "--runs", "2", "--output", str(target), "--folder", str(folder)])
    assert "; 2 runs." in target.read_text()
    assert (folder / "no_mesh.npz").exists()


@pytest.mark.parametrize("arguments", [["third"], ["--runs", "0"]])
def test_wrong_usage(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        command.main(arguments)
    assert stopped.value.code == 2
    assert "first, second" in capsys.readouterr().err or arguments[0] == "--runs"


def test_threads_are_limited_before_numpy_only(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in VARIABLES:
        monkeypatch.setenv(name, "3")
    with pytest.raises(RuntimeError, match="numpy"):
        one_thread()
    monkeypatch.delitem(sys.modules, "numpy")
    one_thread()
    assert all(os.environ[name] == "1" for name in VARIABLES)


def test_stopped_run_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = ["--folder", str(tmp_path / "kept")]
    command.main(["first", *folder])
    measured: list[str] = []
    real = command.measured_now

    def now(row: Row, *rest: object) -> object:
        measured.append(row.name)
        return real(row, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(command, "measured_now", now)
    command.main(folder)
    assert measured == ["second"]


def test_goals_of_a_row_alone_are_judged_by_those_they_compare(
    report: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[tuple[object, ...]] = []

    def ask(*arguments: object) -> object:
        asked.append(arguments)
        return 12 if arguments[0] == "memory" else [[3.0, 1.0, 2.0], [5.0, 5.0, 5.0]]

    monkeypatch.setattr(command, "ask", ask)
    goals = (Goal(0.5), Goal(2, of="peer", against="beltrami"))
    monkeypatch.setattr(command, "ROWS", (replace(row("first"), alone=True, goals=goals),))
    for _ in range(2):  # measured, and as it was kept
        command.main(["--runs", "3", "--folder", str(report.parent)])
        assert [one[3] for one in asked if one[0] == "alone"] == [("beltrami", "peer")]
        text = report.read_text()
        assert "| beltrami 2.0000 s | peer 5.0000 s | 0.400 x | <= 0.5 x | met |" in text
        assert "| peer 5.0000 s | beltrami 2.0000 s | 2.500 x | <= 2 x | **missed** |" in text
        assert "| beltrami | 1.0000 | 1.0000 to 1.0000 |" in text  # among all
        assert "in turn: beltrami 2.0000 s (1.0000 to 3.0000), peer 5.0000 s (5.0000 to" in text
