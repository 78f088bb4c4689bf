"""The peak memory: of the run alone, and a failure that is told."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from benchmarks.cases import Case, no_mesh
from benchmarks.claims import Contender, Row

from benchmarks import memory

SIZE = 48 * 2**20

linux = pytest.mark.skipif(sys.platform != "linux", reason="reads the accounts of Linux")


def held(count: int) -> np.ndarray:
    return np.ones(count * SIZE // 8)


@linux
def test_peak_is_that_of_the_run(tmp_path: Path) -> None:
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
    peak = memory.peak_of(row, Case("no mesh", tmp_path, no_mesh), ["a"], 2)
    assert peak + 2**20 >= 2 * SIZE  # what is prepared does not count
    assert peak < 2.5 * SIZE


@linux
def test_unknown_field_of_the_account() -> None:
    with pytest.raises(LookupError, match="VmNothing"):
        memory.status("VmNothing")
