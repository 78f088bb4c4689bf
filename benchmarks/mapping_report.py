"""BENCHMARKS-MAPS.md: the goals, and the tables they come from."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.machine import facts
from benchmarks.packages import versions
from benchmarks.report import NONE, grid

FIXED_GOALS = {"natural": 1.8, "cut": 3.0, "one triangle": 10.0}
SECONDS_GOALS = {50_000: 3.0, 200_000: 15.0}
SLIM_GOAL, SLIM_STEPS = 1.1, 20
SLIM = f"libigl slim({SLIM_STEPS})"
FIXED, FREE = "beltrami auto", "beltrami free"
PEERS = ("beltrami", "libigl", "pymeshlab", "xatlas", "numpy", "scipy", "numba")
HEAD = """# Benchmarks of maps to the plane

Written by `python -m benchmarks.mapping_suite --folder kept --output BENCHMARKS-MAPS.md` with one
thread (OPENBLAS_NUM_THREADS=1); its `--help` tells what the disks are and how it is measured.
Valid is what an exact certificate calls a bijection, whoever made the map. Energies are symmetric
Dirichlet energies at the best scale, 1 for an isometry, of valid maps alone: a method that is
valid only on easy disks has a low median. Seconds are CPU time, summed over the disks of a group.
Methods may have been measured at different times, by runs that went on from the folder: compare
seconds of different methods roughly.
"""


@dataclass(frozen=True)
class Outcome:
    """One map: whether it is a bijection, how distorted, in how many seconds."""

    valid: bool
    energy: float
    seconds: float
    note: str = ""


@dataclass(frozen=True)
class Large:
    """One map of a large disk of a kind, made of a surface of so many vertices."""

    kind: str
    size: int
    n_vertices: int
    outcome: Outcome


Found = dict[tuple[str, str], dict[str, Outcome]]  # by group and method, then by disk


def written(found: Found, large: Sequence[Large], groups: Sequence[str]) -> str:
    """Return the whole report."""
    parts = [HEAD, "## Goals\n", grid(("what", "value", "goal", ""), goals(found, large))]
    parts += ["\n## All but the tubes: valid maps, and median energies\n", *summary(found)]
    for group in groups:
        if any(of == group for of, _ in found):
            parts += [f"\n## {group.capitalize()}\n", table(found, group)]
    if large:
        parts += ["\n## Large disks, by the default method\n", _large(large)]
    parts += ["\n## Where and when\n", grid(("what", "value"), [*facts(), ("load", _load())])]
    parts += ["\n", grid(("package", "version"), [v for v in versions() if v[0] in PEERS])]
    return "\n".join(parts) + "\n"


def goals(found: Found, large: Sequence[Large]) -> Iterator[tuple[str, str, str, str]]:
    """Yield a row for each goal: what, the value, the limit, and whether it is met."""
    for method in (FIXED, FREE):
        ours = [one for (_, of), those in found.items() if of == method for one in those.values()]
        valid = sum(one.valid for one in ours)
        yield f"{method}: certified bijections", str(valid), f"{len(ours)}", _met(len(ours), valid)
    for group, limit in FIXED_GOALS.items():
        outcomes = found.get((group, FIXED), {})
        if outcomes:
            median = float(np.median([one.energy for one in outcomes.values()]))
            yield f"{FIXED}, {group}: median", f"{median:.3f}", f"<= {limit}", _met(median, limit)
    for group in dict.fromkeys(of for of, _ in found):
        for words, count, median, worst in against_slim(found, group):
            yield (
                f"{FREE} / SLIM({SLIM_STEPS}) where it {words}, {group}, {count} disks: largest",
                f"{worst:.3f} (median {median:.3f})",
                f"<= {SLIM_GOAL}",
                _met(worst, SLIM_GOAL),
            )
    for one in large:
        limit = SECONDS_GOALS.get(one.size, np.inf)
        yield (
            f"{one.kind}, {one.n_vertices} vertices: seconds",
            f"{one.outcome.seconds:.1f}",
            f"<= {limit:g}" if np.isfinite(limit) else "a bijection",
            _met(one.outcome.seconds, limit) if one.outcome.valid else _met(1, 0),
        )


def _met(value: float, limit: float) -> str:
    return "met" if value <= limit else "**missed**"


def against_slim(found: Found, group: str) -> Iterator[tuple[str, int, float, float]]:
    """Yield how our free boundary does beside SLIM: where, on how many, median, largest ratio."""
    free = found.get((group, FREE), {})
    slim = found.get((group, SLIM), {})
    for valid, words in ((True, "is valid"), (False, "is no bijection, which is easier")):
        ratios = [
            free[disk].energy / other.energy
            for disk, other in slim.items()
            if other.valid is valid and np.isfinite(other.energy)
        ]
        if ratios:
            yield words, len(ratios), float(np.median(ratios)), max(ratios)


def table(found: Found, group: str) -> str:
    """Return the table of a group."""
    heads = ("method", "valid", "median", "largest", "seconds")
    return grid(heads, (_row(name, those) for (of, name), those in found.items() if of == group))


def _row(method: str, outcomes: dict[str, Outcome]) -> tuple[str, ...]:
    energies = _energies(outcomes)
    largest = f"{max(energies):.3g}" if energies else NONE
    seconds = f"{sum(one.seconds for one in outcomes.values()):.1f}"
    return method, f"{len(energies)} of {len(outcomes)}", _median(energies), largest, seconds


def summary(found: Found) -> Iterator[str]:
    """Yield one table of all groups but the tubes: valid maps, and the median of each group."""
    groups = [group for group in FIXED_GOALS if (group, FIXED) in found]
    rows = []
    for method in dict.fromkeys(name for _, name in found):
        outcomes = [found.get((group, method), {}) for group in groups]
        energies = [_energies(those) for those in outcomes]
        valid = f"{sum(map(len, energies))} of {sum(map(len, outcomes))}"
        rows.append((method, valid, " / ".join(map(_median, energies))))
    yield grid(("method", "valid", f"median energy: {' / '.join(groups)}"), rows)


def _large(large: Sequence[Large]) -> str:
    heads = ("disk", "vertices", "a bijection", "energy", "seconds")
    rows = [
        (
            one.kind, str(one.n_vertices), "yes" if one.outcome.valid else "**no**",
            f"{one.outcome.energy:.3g}", f"{one.outcome.seconds:.1f}",
        )
        for one in large
    ]  # fmt: skip
    return grid(heads, rows)


def _load() -> str:
    """Tell how busy the machine was: CPU seconds grow where programs share caches."""
    return f"{os.getloadavg()[2]:.1f} programs at a time, ours among them"


def _energies(outcomes: dict[str, Outcome]) -> list[float]:
    return [one.energy for one in outcomes.values() if one.valid]


def _median(energies: list[float]) -> str:
    return f"{np.median(energies):.3g}" if energies else NONE
