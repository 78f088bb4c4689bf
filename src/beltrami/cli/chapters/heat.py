"""Heat: a hot point that spreads, and noise that goes (section 3.3.1, figure 3.5)."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats
from beltrami.cli.chapters.chapter import Chapter, Figure, Stage, number
from beltrami.cli.chapters.denoising import distance
from beltrami.cli.chapters.noise import with_noise
from beltrami.diffusion.heat import heat as diffuse
from beltrami.diffusion.smooth_mesh import smooth_mesh
from beltrami.io.registry import write_mesh
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import Laplacian


def heat(stage: Stage) -> Chapter:
    """Spread the heat of a point, compare two schemes, and smooth a noisy copy of the mesh."""
    mesh = stage.mesh
    pair = laplacian(mesh)
    source = int(np.linalg.norm(mesh.vertices - mesh.vertices.mean(axis=0), axis=1).argmax())
    unit = np.zeros(mesh.n_vertices)
    unit[source] = 1 / pair.masses[source]
    times = [mesh.area * fraction for fraction in (1e-4, 1e-3, 1e-2, 1e-1)]
    states = [diffuse(pair, unit, time) for time in times]
    spread = stage.draw(
        "heat.png",
        "A unit of heat at one vertex, later and later; each picture has its own colours.",
        [mesh] * len(states),
        states,
        caption=[f"t = {number(time)}" for time in times],
        columns=2,
        colormap="sequential",  # negative weights leave values of -1e-7: no sign to be shown
        level_set=None,
    )
    rows = tuple(
        (number(time), number(state.min()), number(state.max()), f"{total:.12f}")
        for time, state, total in zip(times, states, _totals(pair, states), strict=True)
    )
    write_mesh(stage.folder / "heat.ply", mesh.with_data(heat=states[2]))
    return Chapter(
        "Heat",
        "3.3.1",
        (
            "The implicit step solves (B + δL) F' = B F. It is stable for every δ; one "
            "factorisation serves all steps. The heat in all, Σ B F, stays 1.",
            f"The explicit step must be shorter than 2/λ = {number(2 / pair.spectral_bound())} "
            f"here: {int(np.ceil(times[0] * pair.spectral_bound() / 2))} steps to the first time.",
            *_agreement(pair, unit, times[0]),
        ),
        (("time (length²)", "smallest", "largest", "heat in all"), *rows),
        (spread, *_denoising(stage)),
        (("heat.ply", f"the mesh with the heat at t = {number(times[2])} as data"),),
        (f"beltrami heat {stage.name} --source {source} --time {times[2]:.6g} -o heat.ply",),
    )


def _totals(pair: Laplacian, states: list[Floats]) -> list[float]:
    return [float(pair.masses @ state) for state in states]


def _agreement(pair: Laplacian, f: Floats, time: float) -> tuple[str, ...]:
    """Compare the two schemes, where the explicit one takes a bearable number of steps."""
    steps = int(np.ceil(time * pair.spectral_bound()))
    if steps > 2_000:
        return ()
    explicit = diffuse(pair, f, time, "explicit", steps)
    implicit = diffuse(pair, f, time, steps=steps)
    difference = pair.norm(explicit - implicit) / pair.norm(implicit)
    return (f"With {steps} steps each, the two differ by {number(difference)} (relative).",)


def _denoising(stage: Stage) -> tuple[Figure, ...]:
    """Add noise along the normals, and diffuse: too short leaves noise, too long takes shape."""
    mesh = stage.mesh
    if mesh.dimension != 3:
        return ()
    step = float(mesh.edge_lengths.mean())
    noisy = with_noise(mesh, 0.3)
    times = [step**2 * factor for factor in (0.3, 1, 10)]
    cleaned = [smooth_mesh(noisy, "implicit", time=time, steps=1) for time in times]
    errors = [distance(mesh, one) / step for one in (noisy, *cleaned)]
    names = ["noisy", *(f"t = {number(time)}" for time in times)]
    captions = [f"{name}, error {error:.3f}" for name, error in zip(names, errors, strict=True)]
    return (
        stage.draw(
            "denoising.png",
            "Noise of 0.3 mean edges along the normals, then the heat of the coordinates for a "
            "short, a middling and a long time; the error is the distance to the clean mesh, in "
            "mean edges.",
            [noisy, *cleaned],
            caption=captions,
            columns=2,
            camera="common",
        ),
    )
