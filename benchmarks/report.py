"""BENCHMARKS.md: the ratios with their goals first, then all that they come from."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from benchmarks.claims import Goal
from benchmarks.harness import Measured, Table
from benchmarks.machine import facts
from benchmarks.packages import versions
from benchmarks.threads import thread_settings

HEAD = """# Benchmarks

Written by `python -m benchmarks` (`make bench` installs the peers first); `benchmarks/README.md`
tells how it is measured. Every library gets the same arrays in one process, on one thread, in
turn; times are medians of CPU seconds unless wall time is said. Absolute times belong to the
machine named at the end: what counts is the ratio. In a row with large arrays those that the
goals compare are timed alone in a fresh process: to take memory costs little in a process where
other libraries have touched and freed much of it.
"""
NONE = "-"


def grid(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Write a table of Markdown."""
    lines = [list(heads), ["---"] * len(heads), *map(list, rows)]
    return "\n".join("| " + " | ".join(cell.replace("|", "/") for cell in x) + " |" for x in lines)


def verdict(table: Table, goal: Goal) -> str:
    """Say whether the goal is met, or why nobody can tell."""
    judged = [one for one in table.measured if one.contender.name == goal.of]
    if judged and judged[0].problem:
        return judged[0].problem
    strange = f"; OTHER RESULT: {', '.join(table.strangers)}" if table.strangers else ""
    value = table.value(goal)
    if value is None:
        return f"nothing to compare with{strange}"
    return ("met" if value <= goal.limit else "**missed**") + strange


def goal_line(table: Table, goal: Goal) -> list[str]:
    """Return one line of the first table."""
    ours, other, value = table.named(goal.of), table.against(goal), table.value(goal)
    sign = "less " if goal.less else ""
    return [
        table.row.work,
        table.case,
        f"{goal.of} {ours.judged:.4f} s" if ours else goal.of,
        f"{sign}{other.contender.name} {other.judged:.4f} s" if other else NONE,
        f"{value:.3f} {goal.unit}" if value is not None else NONE,
        f"<= {goal.limit:g} {goal.unit}",
        verdict(table, goal),
    ]


def goals(tables: Sequence[Table]) -> str:
    """Return the table of ratios."""
    lines = []
    for table in tables:
        if table.problem:
            lines.append([table.row.work, table.case, *[NONE] * 4, table.problem])
        else:
            lines += [goal_line(table, goal) for goal in table.row.goals]
    return grid(("work", "mesh", "ours", "against", "value", "goal", ""), lines)


def raw_line(one: Measured, with_residual: bool) -> list[str]:
    """Return what was measured of one contender."""
    name = one.contender.name
    if one.problem:
        return [name, *[NONE] * (4 + with_residual), f"FAILED: {one.problem}"]
    difference = NONE if one.difference is None else f"{one.difference:.1e}"
    residual = NONE if one.residual is None else f"{one.residual:.0e}"
    judged = "" if one.agrees else "OTHER RESULT, not counted"
    if one.contender.tolerance is None:
        judged = "another formula"
    elif not one.contender.ours and not one.contender.counts:
        judged = "not a peer"
    return [
        name,
        f"{one.median:.4f}",
        f"{min(one.seconds):.4f} to {max(one.seconds):.4f}",
        one.memory_text,
        difference,
        *([residual] if with_residual else []),
        judged,
    ]


def raw(table: Table) -> str:
    """Return the section of one row on one mesh."""
    title = f"### {table.row.name}: {table.case}\n\n"
    if table.problem:
        return f"{title}NOT MEASURED: {table.problem}"
    runs = max((len(one.seconds) for one in table.measured), default=0)
    mesh = f", {table.n_vertices:,} vertices, {table.n_faces:,} faces" if table.n_faces else ""
    with_residual = any(one.residual is not None for one in table.measured)
    told = ("residual",) if with_residual else ()
    heads = ("", "median s", "range", "peak MB", "difference", *told, "")
    text = f"{table.row.work}{mesh}; {runs} runs.\n\n"
    lines = grid(heads, [raw_line(one, with_residual) for one in table.measured])
    return title + text + lines + alone(table)


def alone(table: Table) -> str:
    """Tell what those took that the goals compare, in a process of their own."""
    told = [
        f"{one.contender.name} {one.judged:.4f} s ({min(one.alone):.4f} to {max(one.alone):.4f})"
        for one in table.measured
        if one.alone
    ]
    return f"\n\nAlone in a process, in turn: {', '.join(told)}." if told else ""


def written(tables: Sequence[Table]) -> str:
    """Return the whole report."""
    return "\n".join(
        [
            HEAD,
            "## Goals\n",
            goals(tables),
            "\n## What was measured\n",
            "Peak MB is what one run needs above what it is given, in a process of its own.",
            "The difference is that to the first contender that runs, relative to the largest",
            "value (edges: how many differ; eigenvalues: the largest relative one). The residual",
            "is that of the contender's own problem: Ax - b beside |A||x| + |b| of a solve, the",
            "largest norm of Lx - λBx beside λBx of eigenpairs, in double precision.\n",
            "\n\n".join(map(raw, tables)),
            "\n## Where and when\n",
            grid(("", ""), [*facts(), ("threads", thread_settings())]),
            "\n## Versions\n",
            grid(("", ""), versions()),
            "",
        ]
    )
