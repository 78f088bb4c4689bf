"""What was measured, kept in the folder of a run: one that was stopped goes on from there."""

from __future__ import annotations

import json
from dataclasses import fields
from pathlib import Path
from typing import Any

from benchmarks.cases import Case
from benchmarks.claims import Row
from benchmarks.harness import Measured, Table

NAME = "measured.json"
FACTS = [field.name for field in fields(Measured) if field.name != "contender"]


def keep(folder: Path, table: Table) -> None:
    """Add a table to what is kept, all but what the row itself knows; it replaces an older one."""
    if table.problem:
        return
    name = (table.row.name, table.case)
    others = [one for one in _stored(folder) if (one["row"], one["case"]) != name]
    one = {
        "row": table.row.name,
        "case": table.case,
        "n_vertices": table.n_vertices,
        "n_faces": table.n_faces,
        "measured": [
            {"name": one.contender.name} | {fact: getattr(one, fact) for fact in FACTS}
            for one in table.measured
        ],
    }
    partial = folder / f"{NAME}.partial"
    partial.write_text(json.dumps([*others, one], indent=1))
    partial.replace(folder / NAME)


def kept(folder: Path, row: Row, case: Case) -> Table | None:
    """Return the table of a row that was measured before, or None."""
    for one in _stored(folder):
        if (one["row"], one["case"]) == (row.name, case.name):
            named = {contender.name: contender for contender in row.contenders(case)}
            measured = tuple(
                Measured(
                    named[facts["name"]],
                    **{fact: facts[fact] for fact in FACTS if fact in facts} | _times(facts),
                )
                for facts in one["measured"]
            )
            return Table(row, case.name, one["n_vertices"], one["n_faces"], measured)
    return None


def _times(facts: dict[str, Any]) -> dict[str, tuple[float, ...]]:
    return {fact: tuple(facts.get(fact, ())) for fact in ("seconds", "alone")}


def _stored(folder: Path) -> list[dict[str, Any]]:
    path = folder / NAME
    return json.loads(path.read_text()) if path.exists() else []
