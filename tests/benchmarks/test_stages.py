"""The stages of the solver: all are there, and operations are counted as a loop counts them."""

from __future__ import annotations

import numpy as np
from benchmarks.stages import _squares, rows_of


def test_every_stage_takes_some_time() -> None:
    found = rows_of(6000, 6)
    names = [name for name, _, _ in found]
    assert names[:2] == ["order", "factor"]
    assert sum("64 right-hand sides" in name for name in names) == 3
    assert {"6 eigenpairs: search", "6 eigenpairs: polish"} <= set(names)
    assert all(seconds > 0 for _, seconds, _ in found)


def test_squares_are_added_up() -> None:
    heights = np.array([0, 1, 2, 7])
    assert _squares(heights).tolist() == [sum(k * k for k in range(h + 1)) for h in heights]
