"""Few contenders in a process of their own: ``python -m benchmarks.alone ...``.

A library that takes hundreds of megabytes and frees them leaves its process with memory that was
touched before. Who comes after it does not wait for the first touch of pages, as in a program that
does not load that library too.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from benchmarks.fresh import answer

if TYPE_CHECKING:
    from benchmarks.cases import Case
    from benchmarks.claims import Row


def seconds_of(row: Row, case: Case, names: Sequence[str], runs: int) -> list[list[float]]:
    """Warm up, and time the contenders of these names in turn; return the seconds of each.

    Raises
    ------
    RuntimeError
        If one of them fails.
    """
    from benchmarks.harness import Measured, in_turn, untimed

    contenders = {one.name: one for one in row.contenders(case)}
    for name in names:
        untimed(contenders[name])
    found = in_turn(row, [Measured(contenders[name]) for name in names], runs)
    for one in found:
        if one.problem:
            raise RuntimeError(f"{one.contender.name}: {one.problem}")
    return [list(one.seconds) for one in found]


if __name__ == "__main__":
    answer(seconds_of)
