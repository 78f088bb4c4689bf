"""Pipeline: verbs with parameters, checked as a whole before anything runs."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from beltrami.batch import memory
from beltrami.batch.failures import PipelineError
from beltrami.batch.grammar import Written, written_steps
from beltrami.batch.verb import Size, Verb
from beltrami.batch.verbs import VERBS
from beltrami.errors import BeltramiError, check_name

FORMAT = 1  # of records; another number makes earlier work be done again


@dataclass(frozen=True)
class Step:
    """A verb with its parameters, and a label: ``diagnose``, then ``diagnose_2``."""

    label: str
    name: str
    options: dict[str, Any]

    @property
    def verb(self) -> Verb:
        """What it does."""
        return VERBS[self.name]


@dataclass(frozen=True, repr=False)
class Pipeline:
    """Steps that can run one after another; ``as_pipeline`` makes it.

    Examples
    --------
    >>> pipeline = as_pipeline("repair, spectrum k=8, descriptors save=false")
    >>> [step.label for step in pipeline.steps], pipeline.columns["spectrum.eigenvalues"]
    (['repair', 'spectrum', 'descriptors'], 'numbers')
    """

    steps: tuple[Step, ...]

    def __repr__(self) -> str:
        return f"<Pipeline: {self.text}>"

    @cached_property
    def columns(self) -> dict[str, str]:
        """Name and kind of each column that the steps fill, in their order."""
        return {
            f"{step.label}.{name}": kind
            for step in self.steps
            for name, kind in step.verb.columns.items()
        }

    @cached_property
    def plain(self) -> list[dict[str, Any]]:
        """The steps as they are written into the manifest, with every parameter."""
        return [{"do": step.name, **step.options} for step in self.steps]

    @cached_property
    def text(self) -> str:
        """The steps in one line, with every parameter: what the work is known by."""
        return json.dumps(self.plain, sort_keys=True, separators=(",", ":"), allow_nan=False)

    def key(self, digest: str, suffix: str, version: str) -> str:
        """Return the name of the work on these bytes of input: 64 hexadecimal digits."""
        parts = (str(FORMAT), version, suffix, digest, self.text)
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()

    def estimate(self, size: Size) -> tuple[int, str]:
        """Return the bytes of the peak, and the label of the step where it is."""
        held = memory.BASE + memory.of_mesh(size)
        worst, where = held, "reading"
        for step in self.steps:
            peak, kept = step.verb.memory(step.options, size)
            if held + peak > worst:
                worst, where = held + peak, step.label
            held += kept
        return worst, where


def as_pipeline(pipeline: object) -> Pipeline:
    """Check a pipeline, however it is written (see ``written_steps``).

    Raises
    ------
    PipelineError
        If it is empty, or a verb or a parameter is unknown or has a value that cannot be, or a
        step needs what no step before it makes. One line, which names the step.
    """
    if isinstance(pipeline, Pipeline):
        return pipeline
    written = written_steps(pipeline)
    if not written:
        raise PipelineError(0, f"a pipeline needs a step: {', '.join(VERBS)}")
    steps: list[Step] = []
    there: set[str] = set()
    for number, one in enumerate(written, 1):
        try:
            step = _checked(one, [step.name for step in steps])
        except BeltramiError as error:
            raise PipelineError(number, str(error)) from error
        if step.verb.needs and step.verb.needs not in there:
            raise PipelineError(
                number, f"{step.name} needs a spectrum after the last step that changes the mesh"
            )
        there = set() if step.verb.changes else there | {step.verb.gives}
        steps.append(step)
    return Pipeline(tuple(steps))


def _checked(written: Written, before: list[str]) -> Step:
    """Return a step whose parameters are valid, by themselves and together."""
    name = check_name("verb", written[0].replace("-", "_"), tuple(VERBS))
    verb = VERBS[name]
    given = {key.replace("-", "_"): value for key, value in written[1].items()}
    for key in given:
        if not verb.parameters:
            raise BeltramiError(f"{name} has no parameters, and {key!r} was given")
        check_name(f"parameter of {name}", key, tuple(verb.parameters))
    options: dict[str, Any] = {}
    for key, parameter in verb.parameters.items():
        value = given.get(key, parameter.default)
        if value is not None:
            options[key] = parameter.take(key, value)
    verb.check(options)
    count = before.count(name) + 1
    return Step(name if count == 1 else f"{name}_{count}", name, options)
