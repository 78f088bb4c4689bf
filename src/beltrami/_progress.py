"""Progress: a callback that long loops call with (steps done, steps in all)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

Progress: TypeAlias = Callable[[int, int], None]


def stages(total: int, progress: Progress | None, block: int = 1) -> Iterator[int]:
    """Cut ``total`` steps into blocks and tell ``progress`` after each one.

    Examples
    --------
    >>> list(stages(7, lambda done, total: print(done, "of", total), block=3))
    3 of 7
    6 of 7
    7 of 7
    [3, 3, 1]
    """
    done = 0
    while done < total:
        size = min(block, total - done)
        yield size
        done += size
        if progress is not None:
            progress(done, total)
