"""The table of smoothing: each work beside the fastest peer that ran, failures by name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from benchmarks import smoothing_times


class Clock:
    def __init__(self) -> None:
        self.now = 0.0
        self.seen: list[float] = []

    def takes(self, seconds: float) -> Any:
        def call() -> None:
            self.now += seconds
            self.seen.append(seconds)

        return call

    def __call__(self) -> float:
        return self.now


def test_each_work_has_a_line_and_is_beside_its_fastest_peer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock = Clock()
    monkeypatch.setattr(smoothing_times, "process_time", clock)

    def contenders(mesh: object) -> Iterator[tuple[str, str, Any]]:
        del mesh
        yield "averaging", "beltrami", clock.takes(1)
        yield "averaging", "slow", clock.takes(8)
        yield "averaging", "fast", clock.takes(4)
        yield "fairing", "beltrami, implicit", clock.takes(3)
        yield "fairing", "fast", clock.takes(2)

    monkeypatch.setattr(smoothing_times, "contenders", contenders)
    lines = smoothing_times.table(None, rounds=3).splitlines()
    assert lines[2:] == [
        "| averaging | 1.0000 | slow 8.0000, fast 4.0000 | 0.25 x fast |",
        "| fairing | 3.0000 | fast 2.0000 | 1.50 x fast |",
    ]


def test_order_of_the_calls_is_another_in_each_round(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock()
    monkeypatch.setattr(smoothing_times, "process_time", clock)

    def contenders(mesh: object) -> Iterator[tuple[str, str, Any]]:
        del mesh
        for seconds in (1, 2, 3, 4):
            yield "work", f"library {seconds}", clock.takes(seconds)

    monkeypatch.setattr(smoothing_times, "contenders", contenders)
    smoothing_times.table(None, rounds=6)
    rounds = [tuple(clock.seen[start : start + 4]) for start in range(0, len(clock.seen), 4)]
    assert len(rounds) == 7  # with the one that compiles
    assert all(sorted(one) == [1, 2, 3, 4] for one in rounds)
    assert len(set(rounds)) > 3
