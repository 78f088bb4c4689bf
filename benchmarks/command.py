"""The command line: ``python -m benchmarks [row ...] [--quick]``."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.cases import Case, cases, small
from benchmarks.claims import Row
from benchmarks.fresh import ask
from benchmarks.harness import Measured, Table, attempt, measure
from benchmarks.kept import keep, kept
from benchmarks.report import goals, written
from benchmarks.rows import ROWS

ROOT = Path(__file__).parent.parent
REPORT = ROOT / "BENCHMARKS.md"
REPORT_LARGE = ROOT / "BENCHMARKS-LARGE.md"
QUICK_RUNS = 3


def tell(text: str) -> None:
    """Show the progress where it does not mix with the report."""
    print(text, file=sys.stderr, flush=True)


def with_memory(table: Table, folder: Path, quick: bool) -> Table:
    """Measure the peak memory of everybody that ran, each in its own process."""

    def measured(one: Measured) -> Measured:
        if one.problem or one.contender.times_itself:
            return one
        asked = table.row.name, table.case, (one.contender.name,), folder, quick, 2
        held, problem = attempt(ask, "memory", *asked)
        return replace(one, memory=held, memory_problem=problem)

    return replace(table, measured=tuple(map(measured, table.measured)))


def with_times_alone(table: Table, folder: Path, quick: bool, runs: int) -> Table:
    """Time those that the goals compare once more, in a process where nobody else runs.

    Raises
    ------
    RuntimeError
        If that process fails, though all had run before.
    """
    pairs = [(table.named(goal.of), table.against(goal)) for goal in table.row.goals]
    if any(one is None for pair in pairs for one in pair):
        return table
    names = tuple(dict.fromkeys(one.contender.name for pair in pairs for one in pair if one))
    seconds = ask("alone", table.row.name, table.case, names, folder, quick, runs)
    alone = dict(zip(names, map(tuple, seconds), strict=True))
    measured = (replace(one, alone=alone.get(one.contender.name, ())) for one in table.measured)
    return replace(table, measured=tuple(measured))


def measured_now(row: Row, case: Case, asked: argparse.Namespace, folder: Path) -> Table:
    """Measure a row on a mesh."""
    runs = asked.runs or (QUICK_RUNS if asked.quick else row.runs)
    table = measure(row, case, runs, small(folder) if row.large else None)
    if row.alone:
        table = with_times_alone(table, folder, asked.quick, runs)
    return with_memory(table, folder, asked.quick) if row.memory and not asked.no_memory else table


def run(asked: argparse.Namespace, folder: Path, target: Path | None) -> list[Table]:
    """Measure the rows that were asked for; the report grows with each table."""
    tables: list[Table] = []
    for row in ROWS:
        if row.name not in asked.rows if asked.rows else row.large != asked.large:
            continue
        for case in cases(row.size, folder, asked.quick):
            tell(f"{row.name}, {case.name}")
            table = kept(folder, row, case) or measured_now(row, case, asked, folder)
            for one in table.measured:
                tell(f"  {one.contender.name}: {one.problem or f'{one.median:.4f} s'}")
            if table.problem:
                tell(f"  {table.problem}")
            tables.append(table)
            keep(folder, table)
            if target is not None:
                target.write_text(written(tables))
    return tables


def parsed(arguments: Sequence[str] | None) -> argparse.Namespace:
    """Read the command line."""
    names = [row.name for row in ROWS]
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("rows", nargs="*", metavar="row", help=f"all, or some of {names}")
    parser.add_argument("--quick", action="store_true", help="one small mesh, three runs")
    parser.add_argument(
        "--large", action="store_true", help="solver and spectra, to 2.1M vertices: over an hour"
    )
    parser.add_argument("--runs", type=int, help="how often each contender runs")
    parser.add_argument("--no-memory", action="store_true", help="do not measure the memory")
    parser.add_argument("--output", type=Path, help=f"write the report there, not {REPORT.name}")
    parser.add_argument(
        "--folder",
        type=Path,
        help="keep the meshes and what was measured there, and go on from it",
    )
    asked = parser.parse_args(arguments)
    for name in asked.rows:
        if name not in names:
            parser.error(f"there is no row {name!r}: choose among {', '.join(names)}")
    if asked.runs is not None and asked.runs < 1:
        parser.error("--runs is at least 1")
    return asked


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and report; the report is written where all rows were measured in full."""
    asked = parsed(arguments)
    target = asked.output
    if target is None and not asked.rows and not asked.quick:
        target = REPORT_LARGE if asked.large else REPORT
    if asked.folder is not None:
        asked.folder.mkdir(parents=True, exist_ok=True)
        tables = run(asked, asked.folder, target)
    else:
        with TemporaryDirectory(prefix="beltrami_benchmarks_") as folder:
            tables = run(asked, Path(folder), target)
    if target is None:
        print(written(tables))
        return 0
    print(goals(tables))
    tell(f"written: {target}")
    return 0
