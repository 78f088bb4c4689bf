"""What can go wrong with a batch, as classes."""

from __future__ import annotations

from beltrami.errors import BeltramiError


class PipelineError(BeltramiError, ValueError):
    """A pipeline that cannot run, found before anything runs.

    Parameters
    ----------
    step
        The guilty step, from 1; 0 if it is none of them.
    problem
        What is wrong with it.
    """

    def __init__(self, step: int, problem: str) -> None:
        self.step = step
        self.problem = problem
        super().__init__(f"step {step} of the pipeline: {problem}" if step else problem)


class TooLargeError(BeltramiError, MemoryError):
    """Work that would not fit into the memory that is allowed; nothing of it was begun.

    Parameters
    ----------
    what
        The work.
    needed, allowed
        Bytes, estimated and given.
    """

    def __init__(self, what: str, needed: int, allowed: int) -> None:
        self.needed = needed
        self.allowed = allowed
        super().__init__(
            f"{what} is estimated to need {needed / 1e9:.2f} GB of memory, and {allowed / 1e9:.2f} "
            "GB are allowed. Allow more, ask for less, or see docs/scaling.md"
        )


class TimeLimitError(BeltramiError, TimeoutError):
    """A mesh took more ``seconds`` than it may; the process that worked on it was ended."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        super().__init__(
            f"more than the {seconds:g} s were needed that a mesh may take, and its worker was "
            "stopped. Allow more, or ask for less"
        )


class StoreError(BeltramiError, OSError):
    """The results cannot be written: the disk is full, or the place not writable.

    Every result that was told as done is there and whole; a later run goes on.
    """


class StrictError(BeltramiError, RuntimeError):
    """A mesh failed in a strict batch; ``source`` is the mesh, ``reason`` its error."""

    def __init__(self, source: str, reason: str) -> None:
        self.source = source
        self.reason = reason
        super().__init__(f"{source}: {reason}")
