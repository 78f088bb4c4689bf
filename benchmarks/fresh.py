"""Fresh processes: one of the modules here runs in its own, and answers with a line of JSON."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from benchmarks.threads import one_thread

if TYPE_CHECKING:
    from benchmarks.cases import Case
    from benchmarks.claims import Row

SECONDS = 1200
ROOT = Path(__file__).parent.parent


def ask(
    module: str, row: str, case: str, names: tuple[str, ...], folder: Path, quick: bool, runs: int
) -> Any:
    """Start the process and return its answer.

    Raises
    ------
    RuntimeError
        If it fails; the message is the last line that it wrote.
    """
    command = [sys.executable, "-m", f"benchmarks.{module}", row, case, *names]
    command += ["--folder", str(folder.resolve()), "--runs", str(runs)]
    command += ["--quick"] if quick else []
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=SECONDS, check=False, cwd=ROOT
    )
    lines = done.stdout.splitlines() if done.returncode == 0 else []
    if not lines:
        last = (done.stderr.strip().splitlines() or ["it wrote nothing"])[-1]
        raise RuntimeError(f"{module}: not measured (exit {done.returncode}): {last}")
    return json.loads(lines[-1])


def answer(work: Callable[..., Any]) -> None:
    """Be that process: do the work for what the command line names, and print the answer."""
    one_thread()
    parser = argparse.ArgumentParser()
    parser.add_argument("row")
    parser.add_argument("case")
    parser.add_argument("names", nargs="+")
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--runs", type=int, required=True)
    parser.add_argument("--quick", action="store_true")
    asked = parser.parse_args()
    row, case = named(asked.row, asked.case, asked.folder, asked.quick)
    print(json.dumps(work(row, case, asked.names, asked.runs)))


def named(row_name: str, case_name: str, folder: Path, quick: bool) -> tuple[Row, Case]:
    """Find a row and a mesh; not earlier than the threads are limited, as this loads numpy."""
    from benchmarks.cases import cases
    from benchmarks.rows import ROWS

    row = next(row for row in ROWS if row.name == row_name)
    return row, next(case for case in cases(row.size, folder, quick) if case.name == case_name)
