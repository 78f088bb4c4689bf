"""Peak memory of one run, in a process of its own: ``python -m benchmarks.memory ...``."""

from __future__ import annotations

import ctypes
import gc
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.fresh import answer

if TYPE_CHECKING:
    from benchmarks.cases import Case
    from benchmarks.claims import Row

STATUS = Path("/proc/self/status")


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


def peak_of(row: Row, case: Case, names: Sequence[str], runs: int) -> int:
    """Return the bytes that the last run of a contender needs above what was held before it.

    The runs before compile and load, on a small mesh where the row is a large one. Linux only.
    """
    from benchmarks.cases import small

    (name,) = names
    for run in range(runs):
        last = run == runs - 1
        mesh = small(case.folder) if row.large and not last else case
        contender = next(one for one in row.contenders(mesh) if one.name == name)
        given = contender.prepare()
        forget_peak()
        before = status("VmRSS")
        contender.run(given)
    return status("VmHWM") - before


if __name__ == "__main__":
    answer(peak_of)
