"""Waves: two bumps that part, pass and come back (section 3.3.1, figure 3.6)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami.cli.chapters.chapter import Chapter, Figure, Stage, number
from beltrami.diffusion.bumps import gaussian_bumps
from beltrami.diffusion.wave import wave
from beltrami.display.images import write_animation
from beltrami.display.render import render
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import Laplacian

FRAMES = 16  # of the film
SHOWN = 3  # of each so many, four are shown side by side
WIDTH = 0.05  # of the bumps, in roots of the area
_LONG = 3_000  # steps of leapfrog, beyond which longer ones are taken
_STEPS = 120  # of these


def waves(stage: Stage) -> Chapter:
    """Let a bump and a hollow go, and watch them."""
    mesh, pair = stage.mesh, laplacian(stage.mesh)
    size = math.sqrt(mesh.area)
    bump = int(np.linalg.norm(mesh.vertices - mesh.vertices.mean(axis=0), axis=1).argmax())
    hollow = int(np.linalg.norm(mesh.vertices - mesh.vertices[bump], axis=1).argmax())
    start = gaussian_bumps(mesh, [bump, hollow], WIDTH * size, [1.0, -1.0])
    times = np.linspace(0, 0.5 * size, FRAMES)
    bound = pair.spectral_bound()
    steps = times[-1] * math.sqrt(bound)  # of half the longest length
    scheme: dict[str, Any] = {"method": "leapfrog"}
    if steps > _LONG:
        scheme = {"method": "implicit", "step": times[-1] / _STEPS}
    states = [state for _, state in wave(pair, start, None, times, **scheme)]
    rows = tuple(
        (number(time), number(state.min()), number(state.max()), number(_sum(pair, state)))
        for time, state in zip(times[::SHOWN], states[::SHOWN], strict=True)
    )
    command = (
        f"beltrami wave {stage.name} --bump {bump} --hollow {hollow} --time {times[-1]:.6g} "
        f"--frames {FRAMES} --method {scheme['method']} -o waves.npy"
    )
    return Chapter(
        "Waves",
        "3.3.1",
        (
            "A bump and a hollow are let go at rest. Leapfrog takes "
            f"F'' = 2F' - F - δ² B⁻¹L F', stable for steps below 2/√λ = "
            f"{number(2 / math.sqrt(bound))} here; the first step has the term -δ²/2 B⁻¹L F, "
            "without which all would be of first order. What starts at rest keeps its mean.",
            f"{math.ceil(steps)} steps of leapfrog would lead to the last picture."
            + (f" These are {_STEPS} implicit ones." if steps > _LONG else " They were taken."),
        ),
        (("time (length)", "smallest", "largest", "integral"), *rows),
        _figures(stage, times, states),
        (),
        (command,),
    )


def _sum(pair: Laplacian, state: Floats) -> float:
    total = float(pair.masses @ state)
    return total if abs(total) > 1e-12 * float(pair.masses @ np.abs(state)) else 0.0


def _figures(stage: Stage, times: Floats, states: list[Floats]) -> tuple[Figure, ...]:
    """Draw some states side by side, and a film of all."""
    mesh = stage.mesh
    height = max(float(np.abs(state).max()) for state in states) / 2 or 1.0
    look: dict[str, Any] = {
        "colormap": "diverging", "limits": (-height, height), "level_set": None
    }  # fmt: skip
    some = slice(0, SHOWN * 4, SHOWN)
    captions = [f"t = {number(time)}" for time in times[some]]
    strip = stage.draw(
        "waves.png",
        "A bump (red) and a hollow (blue) at far ends of the mesh, and three times later; colours "
        "up to half of the first height.",
        [mesh] * len(captions),
        states[some],
        caption=captions,
        columns=2,
        **look,
    )
    views: dict[str, Any] = {
        "up": stage.up,
        "view": stage.view,
        "size": (320, 280),
        "colorbar": False,
    }
    film = (
        render(mesh, state, caption=f"t = {number(time)}", **views, **look)
        for time, state in zip(times, states, strict=True)
    )
    write_animation(stage.folder / "waves.webp", film, 8)
    return strip, Figure("waves.webp", f"The film of all {FRAMES} states.")
