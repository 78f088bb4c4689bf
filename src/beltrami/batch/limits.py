"""A limit of the memory of this process, so that what is too much is an error and no death."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

SHARE: Final = 0.85  # of what is allowed: the rest is for libraries, stacks and messages


@contextmanager
def at_most(allowed: int | None) -> Iterator[None]:
    """Let allocations fail with MemoryError beyond so many bytes of data of this process.

    Where the system has no such limit (RLIMIT_DATA is of Linux), nothing is limited here, and
    the process that watches over a worker stops it instead.

    Examples
    --------
    >>> with at_most(None):
    ...     pass
    """
    limits = _limits() if allowed is not None else None
    if limits is None or allowed is None:
        yield
        return
    resource, (soft, hard) = limits
    wanted = int(SHARE * allowed)
    lower = wanted if soft == resource.RLIM_INFINITY else min(wanted, soft)
    resource.setrlimit(resource.RLIMIT_DATA, (lower, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_DATA, (soft, hard))


def _limits() -> tuple[Any, tuple[int, int]] | None:
    """Return the module that limits, and the limits there are; None where there is none."""
    if not sys.platform.startswith("linux"):
        return None
    import resource

    return resource, resource.getrlimit(resource.RLIMIT_DATA)
