"""The peak memory: of the run alone, and a failure that is told."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from benchmarks.claims import Contender, Row

from benchmarks import memory, rows

SIZE = 48 * 2**20

linux = pytest.mark.skipif(sys.platform != "linux", reason="reads the accounts of Linux")


def held(count: int) -> np.ndarray:
    return np.ones(count * SIZE // 8)


@linux
def test_peak_is_that_of_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sizes = iter([9, 2])  # the first run is the warm-up: its peak does not count

    def run(_: np.ndarray) -> None:
        held(next(sizes))

    row = Row(
        "row",
        "work",
        lambda case: [Contender("a", run, prepare=lambda: held(3))],
        (),
        size=0,
    )
    monkeypatch.setattr(rows, "ROWS", (row,))
    peak = memory.peak_here("row", "no mesh", "a", tmp_path, quick=False)
    assert peak + 2**20 >= 2 * SIZE  # what is prepared does not count
    assert peak < 2.5 * SIZE


def test_failure_of_the_process_is_told(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match=r"exit 1.*StopIteration"):
        memory.peak("no such row", "no mesh", "a", tmp_path)


@linux
def test_unknown_field_of_the_account() -> None:
    with pytest.raises(LookupError, match="VmNothing"):
        memory.status("VmNothing")
