"""BENCHMARKS-DENOISING.md: the goals first, then mesh by mesh."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import t as student

from benchmarks.machine import facts
from benchmarks.noisy_meshes import CREASED, FURTHER_SEEN, HELD_OUT, ODD, PAIR, TUNED
from benchmarks.packages import versions
from benchmarks.report import grid

HEAD = """# Denoising without a parameter

Written by `python -m benchmarks.denoising`. `denoise` is told nothing; the peers (trimesh, PyVista,
PyMeshLab, libigl) have the best of their filters and parameters (`benchmarks/smoothers.py`) that
knowing the truth finds, another one for the angle than for the distance. Noise is white, along the
normals, of the level said, in mean edges. Angles are means over the faces, of the normals;
distances root mean squares over the vertices, in mean edges. A ratio is ours over the best peer's:
the mean over the seeds ± half the 95 % confidence interval (Student). "Own best" is ours over the
best single one of the filters that are mixed, found knowing the truth. CPU is that of `denoise`.

The constants of `denoise` were chosen on the meshes "tuned on"; on those "held out" none was, but
that what is fainter than 0.12 mean edges may be texture (the armadillo's) was seen on both, that
borders of less than a hundredth of the vertices matter little (the face's), too, and how far noise
that is not white may be off in `bends` was looked at on all, and on the further ones.
"The best linear filter" is the best of those with equal weights and with weights by length.
"""
OF_FURTHER = """
Of CGAL's data (Debian: libcgal-demo), many of them decimated, with parts of few vertices and faces
of very unequal size. While `denoise` was made, failures on those "seen" were mended, and some
constants chosen beside those of the tuned ones (one also beside parts of robots that are not told
here: up to which level noise is doubted); for the others nothing was.
"""
OF_LITTLE = """
Scans have less noise than what papers show, and many files have none. "Clean" is how far the
vertices of a mesh without any are moved, in mean edges; the others are distances over that of the
noise itself, for 0.02 and 0.05 mean edges, and over the best peer's, which may be nothing at all.
"Said" is how many of the three were said to have noise of another kind, or spikes.
"""
GOALS = {"distance": (0.70, 0.80), "angle": (1.0, 1.1), "own": (1.02, 1.10), "pair": 3.2}
Facts = dict[str, Any]


@dataclass(frozen=True)
class Case:
    """One mesh and level: (of peers, of ours) for each seed."""

    name: str
    level: float
    n_vertices: int
    runs: tuple[tuple[Facts, ...], ...]

    @property
    def ratios(self) -> Any:
        """(seeds, 4): angle and distance over the best peer's, and over the own best."""
        rows = [
            (
                mine["errors"][0] / theirs["angle"][0],
                mine["errors"][1] / theirs["distance"][0],
                mine["errors"][0] / mine["own"][0],
                mine["errors"][1] / mine["own"][1],
            )
            for theirs, mine in self.runs
        ]
        return np.array(rows)


@dataclass(frozen=True)
class OddCase:
    """One mesh with noise that is not white, or very strong."""

    name: str
    kind: str
    facts: Facts


def interval(values: Any) -> str:
    """Write a mean, and half its confidence interval if there are several values."""
    n = len(values)
    if n < 2:
        return f"{np.mean(values):.2f}"
    half = student.ppf(0.975, n - 1) * np.std(values, ddof=1) / np.sqrt(n)
    return f"{np.mean(values):.2f} ± {half:.2f}"


def line(case: Case) -> list[str]:
    """Return the row of a case; names and start are those of the first seed."""
    first = case.runs[0][0]
    mine = np.mean([run[1]["errors"] for run in case.runs], axis=0)
    ratios = case.ratios.T
    return [
        f"{case.name} {case.level:g}",
        str(len(case.runs)),
        "{:.1f}° {:.2f}".format(*first["noisy"]),
        f"{mine[0]:.2f}° {mine[1]:.3f}",
        f"{first['angle'][0]:.2f}° {first['angle'][1]}",
        f"{first['distance'][0]:.3f} {first['distance'][1]}",
        "{:.2f}° {:.3f}".format(*first["defaults"]),
        *map(interval, ratios),
        f"{np.mean([run[1]['seconds'] for run in case.runs]):.1f} s",
    ]


HEADS = ("mesh, level", "seeds", "noisy", "denoise, blind", "best peer by angle",
         "best peer by distance", "best at defaults", "ratio of angles", "ratio of distances",
         "own best, angle", "own best, distance", "CPU")  # fmt: skip


def told(values: Sequence[float], goal: tuple[float, float]) -> str:
    """Write median and worst with their goals."""
    if not len(values):
        return "not measured"
    middle, worst = float(np.median(values)), float(np.max(values))
    parts = [
        f"{name} {value:.3f} (<= {limit:.2f}: {'met' if value <= limit else '**missed**'})"
        for name, value, limit in zip(("median", "worst"), (middle, worst), goal, strict=True)
    ]
    return ", ".join(parts)


def false_alarms(cases: Sequence[Case]) -> str:
    """Write how often a warning was given where there should be none."""
    said = [run[1]["warned"] for case in cases for run in case.runs]
    verdict = "**missed**" if any(said) else "met"
    return f"{sum(said)} of {len(said)} (0: {verdict})" if said else "not measured"


def goals(groups: Sequence[list[Case]], odd: Sequence[OddCase], of_pair: list[Case]) -> str:
    """Return the table of goals, tuned on beside held out."""
    means = [[(case, case.ratios.mean(axis=0)) for case in group] for group in groups]
    rows = [
        ["distances, over the best peer's",
         *(told([r[1] for _, r in x], GOALS["distance"]) for x in means)],
        ["angles on organic shapes, over the best peer's",
         *(told([r[0] for case, r in x if case.name not in CREASED], GOALS["angle"])
           for x in means)],
        ["angles on shapes with creases, over the best peer's",
         *(told([r[0] for case, r in x if case.name in CREASED], GOALS["angle"])
           for x in means)],
        ["distances, over the own best", *(told([r[3] for _, r in x], GOALS["own"])
                                           for x in means)],
    ]  # fmt: skip
    rows.append(["white noise that is said to be of another kind", *map(false_alarms, groups)])
    for kind, text in ODD.items():
        cells = []
        for names in (TUNED, HELD_OUT):
            found = [one.facts for one in odd if one.kind == kind and one.name in names]
            ratios = [one["distance"] / one["linear"] for one in found]
            said = sum(one["warned"] for one in found)
            cells.append(f"said {said} of {len(found)}; {told(ratios, (1.0, 1.0))}")
        rows.append([f"{kind} ({text}), distance over the best linear filter's", *cells])
    for case in of_pair:
        angle, limit = case.runs[0][1]["errors"][0], GOALS["pair"]
        verdict = "met" if angle <= limit else "**missed**"
        rows.append([f"{PAIR}, angle", f"{angle:.2f}° (<= {limit}°: {verdict})", "-"])
    return grid(("", "tuned on", "held out"), rows)


def lines(cases: Iterable[Case]) -> str:
    return grid(HEADS, [line(case) for case in cases])


def of_further(cases: Sequence[Case]) -> list[str]:
    """Return the section of the further meshes, if they were measured."""
    if not cases:
        return []
    groups = [
        [case for case in cases if (case.name.removesuffix(".off") in FURTHER_SEEN) is seen]
        for seen in (True, False)
    ]
    means = [[case.ratios.mean(axis=0) for case in group] for group in groups]
    rows = [
        [f"{what}, over the best peer's", *(told([r[i] for r in x], GOALS[key]) for x in means)]
        for what, key, i in (("distances", "distance", 1), ("angles", "angle", 0))
    ]
    rows.append(["white noise that is said to be of another kind", *map(false_alarms, groups)])
    return [
        "\n## Further meshes\n" + OF_FURTHER,
        grid(("", "seen", "not seen"), rows),
        "",
        lines(cases),
    ]


def of_little(little: dict[str, Facts]) -> list[str]:
    """Return the section of little noise, if it was measured."""
    if not little:
        return []
    rows, ratios = [], []
    for name, found in little.items():
        row = [name, f"{found['clean'][1]:.4f}"]
        for one, by_peer in zip(found["levels"], found["peers"], strict=True):
            mine, (theirs, peer) = one["distance"], min(by_peer, [one["noisy"], "nothing"])
            ratios.append((mine / one["noisy"], mine / theirs))
            row += [f"{ratios[-1][0]:.2f}", f"{ratios[-1][1]:.2f} {peer}"]
        rows.append([*row, str(sum(found["said"]))])
    over = np.array(ratios)
    of_noise = f"more than the noise: {(over[:, 0] > 1).sum()} of {len(over)}"
    of_peers = f"more than the best peer: {(over[:, 1] > 1).sum()} of {len(over)}"
    middle = "median {:.2f} of the noise, {:.2f} of the best peer".format(*np.median(over, axis=0))
    heads = ["mesh", "clean"]
    for one in next(iter(little.values()))["levels"]:
        heads += [f"{one['level']:g}, over the noise", f"{one['level']:g}, over the best peer"]
    return [
        "\n## Little noise\n" + OF_LITTLE,
        f"Distances: {middle}; {of_noise}; {of_peers}.\n",
        grid((*heads, "said"), rows),
    ]


def written(
    cases: Sequence[Case],
    odd: Sequence[OddCase],
    missing: Sequence[str],
    further: Sequence[Case] = (),
    little: dict[str, Facts] | None = None,
) -> str:
    """Return the whole report."""
    groups = [[case for case in cases if case.name in names] for names in (TUNED, HELD_OUT)]
    of_pair = [case for case in cases if case.name == PAIR]
    odd_rows = [
        [
            one.name,
            one.kind,
            f"{one.facts['noisy']:.3f}",
            f"{one.facts['distance']:.3f}",
            f"{one.facts['linear']:.3f}",
            "yes" if one.facts["warned"] else "**no**",
        ]
        for one in odd
    ]
    absent = f"\nNot measured: {', '.join(missing)}.\n" if missing else ""
    return "\n".join(
        [
            HEAD + absent,
            "## Goals\n",
            goals(groups, odd, of_pair),
            "\n## Tuned on\n",
            lines([*of_pair, *groups[0]]),
            "\n## Held out\n",
            lines(groups[1]),
            *of_further(further),
            *of_little(little or {}),
            "\n## Noise of other kinds\n",
            "Distances, and whether `denoise` says that something is odd.\n",
            grid(("mesh", "noise", "noisy", "denoise", "best linear", "said"), odd_rows),
            "\n## Where and when\n",
            grid(("", ""), facts()),
            "\n## Versions\n",
            grid(("", ""), versions()),
            "",
        ]
    )
