"""The flat grid beside the mesh: where Fourier's own waves are the eigenvectors (3.2.4, 3.2.6)."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats
from beltrami.cli.chapters.chapter import Chapter, Figure, Stage, number
from beltrami.diffusion.heat import heat
from beltrami.grids.grid import Grid
from beltrami.grids.transform import dft, idft
from beltrami.mesh.shapes import grid as rectangle
from beltrami.operators.laplacian import laplacian

SIZE = 64
FRACTIONS = (2e-4, 2e-3, 1e-2)  # times, in areas
STEPS = 10


def grid(stage: Stage) -> Chapter:
    """Diffuse the same spots on a flat torus, where the FFT solves it, and on the mesh."""
    torus = Grid((SIZE, SIZE))
    pair = laplacian(torus, "dirichlet")
    spots = _spots(torus.coordinates)
    values = torus.eigenvalues("dirichlet")
    exact = [_by_fourier(spots, values, time) for time in FRACTIONS]
    stepped = [heat(pair, spots.ravel(), time, steps=STEPS) for time in FRACTIONS]
    rows = tuple(
        (
            number(time),
            number(state.max()),
            number(float(np.abs(found - state.ravel()).max())),
            f"{float(state.mean() - spots.mean()):.0e}",
        )
        for time, state, found in zip(FRACTIONS, exact, stepped, strict=True)
    )
    return Chapter(
        "A flat grid beside the mesh",
        "3.2.4, 3.2.6, 3.3.3",
        (
            "On a periodic grid every operator that is the same at each point is a convolution, "
            "and the Fourier transform turns it into a product. So the heat equation is solved by "
            "two FFTs, exactly: each wave of the frequency ω shrinks by exp(-λ t), with "
            "λ = Σ 4 sin²(πω/p) / h².",
            f"On the grid of {SIZE} by {SIZE} points the first eigenvalue is "
            f"{number(float(np.sort(values, axis=None)[1]))}; on the torus it is 4π² = "
            f"{number(4 * np.pi**2)}. All degrees are {number(float(pair.degrees[0]))}: regular "
            "grids hide what irregular meshes show.",
            "A mesh has no FFT. There the same pair of matrices takes the place of the kernel, and "
            "its eigenvectors that of the waves.",
        ),
        (
            ("time (areas)", "largest, exact", f"implicit, {STEPS} steps: off by", "mean moved by"),
            *rows,
        ),
        (_on_the_grid(stage, exact), _on_the_mesh(stage)),
    )


def _spots(coordinates: Floats) -> Floats:
    """Put a hot and a cold spot of Gaussian shape on the torus."""
    wave = np.cos(2 * np.pi * (coordinates[:, None] - [[0.3, 0.35], [0.7, 0.6]]))
    hot, cold = np.exp(12 * (wave.sum(axis=2) - 2)).T
    return np.asarray((hot - cold).reshape(SIZE, SIZE))


def _by_fourier(f: Floats, eigenvalues: Floats, time: float) -> Floats:
    return np.asarray(idft(np.exp(-eigenvalues * time) * dft(f)).real)


def _on_the_grid(stage: Stage, states: list[Floats]) -> Figure:
    sheet = rectangle(SIZE - 1, SIZE - 1)
    return stage.draw(
        "grid.png",
        "A hot and a cold spot on a flat torus, cut open: what leaves on one side enters on the "
        "other. Times are in units of the area; each picture has its own colours.",
        [sheet] * len(states),
        [state.ravel() for state in states],
        caption=_captions(),
        size=(380, None),
        up="y",
        view=None,
        colormap="diverging",
    )


def _on_the_mesh(stage: Stage) -> Figure:
    """Draw a hot and a cold spot at the two ends of the mesh, at the same times."""
    mesh = stage.mesh
    pair = laplacian(mesh)
    place = mesh.vertices[:, 0]
    ends = [int(place.argmax()), int(place.argmin())]
    start = np.zeros(mesh.n_vertices)
    start[ends] = [1, -1] / pair.masses[ends]
    states = [heat(pair, start, time * mesh.area) for time in FRACTIONS]
    return stage.draw(
        "beside.png",
        "The same on the mesh, from the two ends of its first axis, after the same times in units "
        "of its own area.",
        [mesh] * len(states),
        states,
        caption=_captions(),
        size=(380, None),
        colormap="diverging",
    )


def _captions() -> list[str]:
    return [f"t = {number(time)} areas" for time in FRACTIONS]
