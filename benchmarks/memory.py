"""Peak memory of one run, in a process of its own: ``python -m benchmarks.memory ...``."""

from __future__ import annotations

import argparse
import ctypes
import gc
import subprocess
import sys
from pathlib import Path

from benchmarks.threads import one_thread

STATUS = Path("/proc/self/status")
SECONDS = 1200
ROOT = Path(__file__).parent.parent


def status(field: str) -> int:
    """Read a size in bytes out of the kernel's account of this process."""
    for line in STATUS.read_text().splitlines():
        if line.startswith(f"{field}:"):
            return int(line.split()[1]) * 1024
    raise LookupError(f"{STATUS} has no {field}")


def forget_peak() -> None:
    """Give freed memory back and set the peak to what is held now."""
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    Path("/proc/self/clear_refs").write_text("5")


def peak_here(row_name: str, case_name: str, contender_name: str, folder: Path, quick: bool) -> int:
    """Return the bytes that one run needs above what was held before it (Linux only).

    It is the second run that counts: the first one compiles and loads, on a small mesh where the
    row is a large one.
    """
    from benchmarks.cases import cases, small
    from benchmarks.rows import ROWS

    row = next(row for row in ROWS if row.name == row_name)
    case = next(case for case in cases(row.size, folder, quick) if case.name == case_name)
    first = small(folder) if row.large else case
    warm = next(one for one in row.contenders(first) if one.name == contender_name)
    warm.run(warm.prepare())
    contender = next(one for one in row.contenders(case) if one.name == contender_name)
    given = contender.prepare()
    forget_peak()
    before = status("VmRSS")
    contender.run(given)
    return status("VmHWM") - before


def peak(
    row_name: str, case_name: str, contender_name: str, folder: Path, quick: bool = False
) -> int:
    """Start the process that measures, and return its bytes.

    Raises
    ------
    RuntimeError
        If it fails; the message is the last line that it wrote.
    """
    command = [sys.executable, "-m", "benchmarks.memory", row_name, case_name, contender_name]
    command += [str(folder.resolve()), *(["--quick"] if quick else [])]
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=SECONDS, check=False, cwd=ROOT
    )
    lines = done.stdout.split() if done.returncode == 0 else []
    if not lines:
        last = (done.stderr.strip().splitlines() or ["it wrote nothing"])[-1]
        raise RuntimeError(f"the memory was not measured (exit {done.returncode}): {last}")
    return int(lines[-1])


def main() -> None:
    one_thread()
    parser = argparse.ArgumentParser()
    for name in ("row", "case", "contender"):
        parser.add_argument(name)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--quick", action="store_true")
    asked = parser.parse_args()
    print(peak_here(asked.row, asked.case, asked.contender, asked.folder, asked.quick))


if __name__ == "__main__":
    main()
