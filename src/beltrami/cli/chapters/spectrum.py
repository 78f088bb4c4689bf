"""The spectrum: eigenfunctions in colour, and functions as sums of them (3.3.2, 3.3.3, 3.3.6)."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats
from beltrami.cli.chapters.chapter import Chapter, Figure, Stage, number
from beltrami.display.spectrum_plot import plot_spectrum
from beltrami.errors import MissingExtraError
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.fourier_basis import fourier_basis

SHOWN = (1, 2, 4, 8, 16, 32, 64, 128)  # numbers of the modes drawn; 0 is the constant
MODES = 200


def spectrum(stage: Stage) -> Chapter:
    """Compute eigenpairs, draw some, and compare a smooth function with one that jumps.

    Chapter items: F3.7.
    """
    mesh = stage.mesh
    pair = laplacian(mesh)
    basis = fourier_basis(pair, min(MODES, pair.n))
    basis.save(stage.folder / "basis.npz")
    shown = [i for i in SHOWN if i < basis.k]
    figures = [_eigenfunctions(stage, basis, shown)]
    notes = []
    try:
        figures.append(_spectra(stage, basis, _smooth_and_rough(mesh)))
    except MissingExtraError as error:
        notes.append(f"No plot of spectra: {error}")
    return Chapter(
        "Spectrum",
        "3.3.2, 3.3.3, 3.3.6",
        (
            "The eigenvectors of the pair, Lφ = λBφ, are to the mesh what sines and cosines are to "
            "the circle. The first is constant; the larger λ, the more often a mode changes its "
            "sign, and by Courant's theorem the one of number i has at most i + 1 regions of one "
            "sign.",
            "On every surface λ grows like 4π i / area (Weyl's law), whatever its shape; the shape "
            "is in the differences.",
            *notes,
        ),
        (
            ("mode", "λ", "4π i / area", "residual"),
            *(
                (
                    str(i),
                    number(float(basis.eigenvalues[i])),
                    number(4 * np.pi * i / mesh.area),
                    f"{float(basis.residuals[i]):.0e}",
                )
                for i in shown
            ),
        ),
        tuple(figures),
        (("basis.npz", "the eigenpairs, for bt.load_basis"),),
        (f"beltrami spectrum {stage.name} -k {basis.k} -o basis.npz --png modes.png",),
    )


def _eigenfunctions(stage: Stage, basis: FourierBasis, shown: list[int]) -> Figure:
    return stage.draw(
        "eigenfunctions.png",
        "Eigenfunctions: blue is negative, red positive, and the black lines are where they are "
        "zero.",
        [stage.mesh] * len(shown),
        [basis.eigenvectors[:, i] for i in shown],
        caption=[f"mode {i}, λ = {number(float(basis.eigenvalues[i]))}" for i in shown],
        size=(480, None),
        columns=2,
        colormap="diverging",
        colorbar=False,
    )


def _smooth_and_rough(mesh: Mesh) -> dict[str, Floats]:
    """Make a wave along the longest axis, and the sign of it."""
    centred = mesh.vertices - mesh.vertices.mean(axis=0)
    axis = np.linalg.svd(centred, full_matrices=False)[2][0]
    place = centred @ axis
    wave = np.sin(2 * np.pi * place / np.ptp(place) + 1)
    return {"a smooth wave": wave, "its sign, which jumps": np.sign(wave)}


def _spectra(stage: Stage, basis: FourierBasis, functions: dict[str, Floats]) -> Figure:
    plot_spectrum(basis, functions, stage.folder / "spectra.png", size=(760, 480))
    return Figure(
        "spectra.png",
        "The coefficients of two functions over the eigenvalues: those of the smooth one fall "
        "faster, so that fewer of them are enough.",
    )
