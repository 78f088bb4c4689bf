"""A pipeline as text, as a list or as a TOML file: to names of verbs with their parameters."""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

from beltrami.batch.failures import PipelineError
from beltrami.errors import shown

Written: TypeAlias = tuple[str, dict[str, Any]]
_WORD = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
_PIECE = re.compile(r"""\[[^\[\]]*\]|"(?:[^"\\]|\\.)*"|'[^']*'|[^\s,#\[\]"']+""")
_OPENING = {"[": "]", '"': '"', "'": "'"}


def written_steps(pipeline: object) -> list[Written]:
    """Return (verb, parameters) for each step of a pipeline, however it is written.

    Parameters
    ----------
    pipeline
        A text such as ``"repair, spectrum k=128, descriptors"``, whose values are those of TOML
        (numbers, true, false, "texts", [lists]) or single words; the name of a file that ends in
        ``.toml``, with a table ``[[step]]`` for each step whose ``do`` is the verb; or a list, of
        such texts, of (verb, parameters), or of such tables.

    Raises
    ------
    PipelineError
        If it is not written so; it names the step. Whether verbs and parameters exist is not
        asked here.

    Examples
    --------
    >>> written_steps("repair, spectrum k=128 weights=intrinsic_delaunay")
    [('repair', {}), ('spectrum', {'k': 128, 'weights': 'intrinsic_delaunay'})]
    >>> written_steps([("spectrum", {"k": 128}), {"do": "descriptors"}, "smooth steps=3"])
    [('spectrum', {'k': 128}), ('descriptors', {}), ('smooth', {'steps': 3})]
    """
    if isinstance(pipeline, os.PathLike) or (
        isinstance(pipeline, str) and pipeline.strip().lower().endswith(".toml")
    ):
        return _of_file(Path(os.fspath(pipeline).strip()))
    if isinstance(pipeline, str):
        return [_of_text(text, i + 1) for i, text in enumerate(_cut(pipeline))]
    if isinstance(pipeline, Sequence):
        return [_of_item(item, i + 1) for i, item in enumerate(pipeline)]
    raise PipelineError(0, f"a pipeline is a text, a list or a TOML file, not {shown(pipeline)}")


def _of_file(path: Path) -> list[Written]:
    try:
        tables = tomllib.loads(path.read_bytes().decode("utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as cause:
        raise PipelineError(0, f"{path}: expected a TOML file ({cause})") from cause
    steps = tables.pop("step", None)
    if tables or not isinstance(steps, list):
        extra = ", ".join(sorted(tables)) or "nothing of the kind"
        raise PipelineError(0, f"{path}: expected tables [[step]] alone, found {extra}")
    return [_of_item(step, i + 1) for i, step in enumerate(steps)]


def _of_item(item: object, step: int) -> Written:
    if isinstance(item, str):
        return _of_text(item, step)
    if isinstance(item, Mapping):
        given = dict(item)
        verb = given.pop("do", None)
    elif isinstance(item, Sequence) and len(item) == 2:
        verb, given = item[0], item[1]
    else:
        raise PipelineError(step, f"expected a verb with its parameters, found {shown(item)}")
    if not isinstance(verb, str) or not isinstance(given, Mapping):
        raise PipelineError(step, f"expected a verb with its parameters, found {shown(item)}")
    return verb.strip(), {str(name): value for name, value in given.items()}


def _cut(text: str) -> Iterator[str]:
    """Cut a text at its commas, but for those in brackets and quotes."""
    start, closing = 0, ""
    for i, sign in enumerate(text):
        if closing:
            closing = "" if sign == closing else closing
        elif sign in _OPENING:
            closing = _OPENING[sign]
        elif sign == ",":
            yield text[start:i]
            start = i + 1
    yield text[start:]


def _of_text(text: str, step: int) -> Written:
    """Read ``verb name=value ...``."""
    head, *rest = text.strip().split(maxsplit=1) or [""]
    if not _WORD.fullmatch(head):
        raise PipelineError(step, f"expected a verb, found {shown(head) if head else 'nothing'}")
    given: dict[str, Any] = {}
    remaining = rest[0].strip() if rest else ""
    while remaining:
        name, equals, after = remaining.partition("=")
        piece = _PIECE.match(after)
        if not _WORD.fullmatch(name) or not equals or piece is None:
            raise PipelineError(step, f"expected name=value, found {shown(remaining)}")
        remaining = after[piece.end() :]
        if remaining and not remaining[0].isspace():
            raise PipelineError(step, f"expected a space after {shown(piece.group())}")
        remaining = remaining.strip()
        if name in given:
            raise PipelineError(step, f"the parameter {name!r} is given twice")
        given[name] = _value(piece.group(), step)
    return head, given


def _value(text: str, step: int) -> Any:
    """Read a value of TOML, or a word."""
    try:
        found = tomllib.loads(f"x = {text}")
    except (tomllib.TOMLDecodeError, RecursionError):
        if _WORD.fullmatch(text):
            return text
        raise PipelineError(step, f"cannot read the value {shown(text)}") from None
    if list(found) != ["x"]:
        raise PipelineError(step, f"cannot read the value {shown(text)}")
    return found["x"]
