"""The benchmarks are no part of the installed package: make them importable."""

from __future__ import annotations

import gc
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

sys.path.insert(0, str(Path(__file__).parents[2]))


@pytest.fixture(autouse=True)
def nothing_to_collect(monkeypatch: pytest.MonkeyPatch) -> None:
    """Collect no garbage before each timed run: with all tests loaded that takes .2 s."""
    from benchmarks import harness

    resting = SimpleNamespace(collect=int, disable=gc.disable, enable=gc.enable)
    monkeypatch.setattr(harness, "gc", resting)
