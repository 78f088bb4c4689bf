"""The table, one row for each mesh, and the manifest, one line for each: both in one pass."""

from __future__ import annotations

import errno
import json
import shutil
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from functools import partial
from itertools import islice
from pathlib import Path
from typing import IO, Any, Final

from beltrami._optional import require
from beltrami.batch.failures import StoreError
from beltrami.batch.pipeline import FORMAT, Pipeline
from beltrami.batch.record import Record, decoded
from beltrami.batch.store import Store, work_name
from beltrami.batch.work import Outcome, versions

TABLE: Final = "results.parquet"
MANIFEST: Final = "manifest.jsonl"
_LOST: Final = "its record is not in the results: do all workers write to one place?"
_ROWS: Final = 1000  # at a time: so a million meshes need little memory
_OWN: Final = {
    "source": "text",
    "outcome": "text",
    "input_sha256": "text",
    "input_bytes": "whole",
    "key": "text",
    "error": "text",
    "error_kind": "text",
    "error_step": "text",
    "seconds": "number",
}


def write_results(
    store: Store, pipeline: Pipeline, outcomes: Sequence[Outcome], total: int
) -> None:
    """Write the table and the manifest of a run from the records of its meshes.

    Each is replaced as a whole. A row has the facts of all steps, null where there is none, and
    ``<step>.file``, the name of the file that the step made.

    Raises
    ------
    StoreError
        If they cannot be written, or a record that was written cannot be found.
    """
    arrow = require("pyarrow", "batch", "the table of a batch")
    parquet = require("pyarrow.parquet", "batch", "the table of a batch")
    schema = arrow.schema([(name, _type(arrow, kind)) for name, kind in columns(pipeline).items()])

    def write_table(lines: IO[str], path: Path) -> None:
        with parquet.ParquetWriter(path, schema) as writer:
            for chunk in _chunks(store, pipeline, outcomes):
                rows = [_row(outcome, record) for outcome, record in chunk]
                writer.write_table(arrow.Table.from_pylist(rows, schema))
                lines.writelines(_line(outcome, record) + "\n" for outcome, record in chunk)

    def write_manifest(path: Path) -> None:
        with _text(path.with_name("lines"), "w+") as lines, _text(path, "w") as file:
            table = store.replace(TABLE, partial(write_table, lines))
            head = _head(pipeline, outcomes, total) | {
                "versions": versions() | {"pyarrow": arrow.__version__},
                "table": {"name": table.name, "sha256": table.sha256},
            }
            file.write(json.dumps(head) + "\n")
            lines.seek(0)
            shutil.copyfileobj(lines, file)

    store.replace(MANIFEST, write_manifest)


def _head(pipeline: Pipeline, outcomes: Sequence[Outcome], total: int) -> dict[str, Any]:
    """Return what the manifest says of the run as a whole."""
    return {
        "format": FORMAT,
        "pipeline": pipeline.plain,
        "written": datetime.now(UTC).isoformat(timespec="seconds"),
        "meshes": total,
        "done": sum(outcome.outcome == "done" for outcome in outcomes),
        "failed": sum(outcome.outcome == "failed" for outcome in outcomes),
        "complete": len(outcomes) == total,
    }


def columns(pipeline: Pipeline) -> dict[str, str]:
    """Return names and kinds of the columns of the table."""
    files = {f"{step.label}.file": "text" for step in pipeline.steps}
    return _OWN | pipeline.columns | files


def _type(arrow: Any, kind: str) -> Any:
    simple = {
        "whole": arrow.int64(),
        "number": arrow.float64(),
        "flag": arrow.bool_(),
        "text": arrow.string(),
        "numbers": arrow.list_(arrow.float64()),
    }
    return simple[kind]


def _chunks(
    store: Store, pipeline: Pipeline, outcomes: Sequence[Outcome]
) -> Iterator[list[tuple[Outcome, Record | None]]]:
    """Run through the outcomes with their records, some at a time."""
    rest = iter(outcomes)
    while chunk := list(islice(rest, _ROWS)):
        keys = [outcome.key for outcome in chunk]
        contents = iter(store.read([work_name(key) for key in keys if key]))
        records = [decoded(next(contents), key, pipeline) if key else None for key in keys]
        for outcome, record in zip(chunk, records, strict=True):
            if outcome.key and record is None:
                raise StoreError(errno.ENOENT, _LOST, outcome.name)
        yield list(zip(chunk, records, strict=True))


def _row(outcome: Outcome, record: Record | None) -> dict[str, Any]:
    error = outcome.error
    row: dict[str, Any] = {
        "source": outcome.name,
        "outcome": outcome.outcome,
        "input_sha256": outcome.sha256 or None,
        "input_bytes": outcome.bytes if outcome.bytes >= 0 else None,
        "key": outcome.key or None,
        "error": None if error is None else error.message,
        "error_kind": None if error is None else error.kind,
        "error_step": None if error is None else error.step or None,
    }
    if record is not None:
        row["seconds"] = sum(record.seconds.values())
        row |= record.row
        row |= {f"{label}.file": kept.name for label, kept in record.files.items()}
    return row


def _line(outcome: Outcome, record: Record | None) -> str:
    """Return the line of a mesh in the manifest."""
    line: dict[str, Any] = {
        "source": outcome.name,
        "outcome": outcome.outcome,
        "reused": outcome.reused,
        "sha256": outcome.sha256 or None,
        "key": outcome.key or None,
    }
    if outcome.error is not None:
        error = outcome.error
        line["error"] = {"kind": error.kind, "step": error.step, "message": error.message}
    if record is not None:
        line |= {"finished": record.finished, "versions": record.versions}
        line |= {"seconds": record.seconds}
        line["files"] = {label: vars(kept) for label, kept in record.files.items()}
    return json.dumps(line, ensure_ascii=False)


def _text(path: Path, mode: str) -> IO[str]:
    return path.open(mode, encoding="utf-8", newline="\n")
