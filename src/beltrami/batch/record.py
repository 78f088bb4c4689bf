"""Record: what a pipeline found for some bytes of input, as JSON under the key of the work."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass, field
from typing import Any, Final

from beltrami.batch.pipeline import FORMAT, Pipeline
from beltrami.batch.store import Kept, is_name

DONE: Final = "done"
FAILED: Final = "failed"


@dataclass(frozen=True)
class Problem:
    """Why a mesh failed: the class of the error, its message, the step where it was raised."""

    kind: str
    message: str
    step: str = ""

    def __str__(self) -> str:
        return f"{self.step}: {self.message}" if self.step else self.message


@dataclass(frozen=True)
class Record:
    """What is known of a piece of work; it is written once, when the work has ended.

    Attributes
    ----------
    key
        The digest of the input, the pipeline and the version.
    input
        sha256 and bytes of the input.
    pipeline
        The steps with all parameters.
    versions
        Of beltrami and of what it computes with.
    row
        The columns, by label and name.
    files
        By the label of the step that made it.
    seconds
        Of the processor, by the label of the step; and for reading.
    error
        Why it failed; None if it did not.
    finished
        When, in UTC.
    """

    key: str
    input: dict[str, Any]
    pipeline: list[dict[str, Any]]
    versions: dict[str, str]
    row: dict[str, Any] = field(default_factory=dict)
    files: dict[str, Kept] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)
    error: Problem | None = None
    finished: str = ""

    @property
    def outcome(self) -> str:
        """``"done"`` or ``"failed"``."""
        return DONE if self.error is None else FAILED

    def encoded(self) -> bytes:
        """Return it as JSON; numbers that JSON does not know become null."""
        plain = _finite({"format": FORMAT, "outcome": self.outcome, **asdict(self)})
        return json.dumps(plain, allow_nan=False, ensure_ascii=False).encode()


def decoded(content: bytes | None, key: str, pipeline: Pipeline) -> Record | None:
    """Return the record of a key; None if it is not whole, not valid or not of this work.

    Nothing in it is trusted: names of files are those that a store makes, columns those of the
    pipeline, values of their kinds.
    """
    if content is None:
        return None
    try:
        plain = json.loads(content)
        json.dumps(plain, ensure_ascii=False).encode()  # raises where a text is no Unicode
        if plain.pop("format") != FORMAT or plain["key"] != key:
            return None
        outcome = plain.pop("outcome")
        files = {label: Kept(**kept) for label, kept in plain.pop("files").items()}
        error = plain.pop("error")
        problem = None if error is None else Problem(**error)
        record = Record(**plain, files=files, error=problem)
        return record if outcome == record.outcome and _is_valid(record, pipeline) else None
    except (ValueError, TypeError, LookupError, AttributeError, RecursionError):
        return None


def fits(kind: str, value: Any) -> bool:
    """Say whether a value is of this kind of column; None is of every kind.

    Examples
    --------
    >>> fits("whole", 3), fits("whole", 3.5), fits("numbers", [1.0, None]), fits("flag", 1)
    (True, False, True, False)
    """
    if value is None:
        return True
    if kind == "numbers":
        return isinstance(value, list) and all(fits("number", item) for item in value)
    if kind == "flag":
        return isinstance(value, bool)
    if kind == "text":
        return isinstance(value, str)
    allowed = int if kind == "whole" else (int, float)
    if isinstance(value, bool) or not isinstance(value, allowed):
        return False
    return isinstance(value, float) or abs(value) < 2**63


def _is_valid(record: Record, pipeline: Pipeline) -> bool:
    columns = pipeline.columns
    labels = {step.label for step in pipeline.steps}
    whole = all(name in columns and fits(columns[name], v) for name, v in record.row.items())
    named = all(
        label in labels
        and is_name(kept.name)
        and kept.sha256 == kept.name.split("/")[2].partition(".")[0]
        and isinstance(kept.bytes, int)
        for label, kept in record.files.items()
    )
    texts = record.error is None or all(
        isinstance(text, str)
        for text in (record.error.kind, record.error.message, record.error.step)
    )
    times = None not in record.seconds.values() and all(
        fits("number", value) for value in record.seconds.values()
    )
    kinds: tuple[tuple[object, type], ...] = ((record.finished, str), (record.versions, dict))
    kinds += ((record.input["sha256"], str), (record.input["bytes"], int))
    known = all(isinstance(value, kind) for value, kind in kinds)
    return whole and named and texts and times and known


def _finite(value: Any) -> Any:
    """Replace numbers that are not finite by None."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
