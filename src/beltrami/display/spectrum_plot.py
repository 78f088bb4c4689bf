"""plot_spectrum: the coefficients of functions beside their frequencies (figure 3.8)."""

from __future__ import annotations

import os
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, Integers, as_function, whole
from beltrami._kinds import checked
from beltrami.display.images import check_suffix, write_image
from beltrami.display.line_plot import COLORS, LinePlot
from beltrami.display.srgb import Image
from beltrami.errors import BeltramiError, MeshError, shown
from beltrami.spectrum.basis import FourierBasis

_BANDS_PER_OCTAVE = 2  # of λ, over which the lines take root mean squares
_SMALLEST, _LARGEST = 200, 20_000  # pixels
_FEW = 3  # coefficients below which a mean says nothing
_FLOOR = 1e-18  # of the largest coefficient: what is below is drawn there
_NARROWEST = 1.01  # ratio of the last eigenvalue to the first, below which the axis is widened


@checked
def plot_spectrum(
    basis: FourierBasis,
    functions: Mapping[str, ArrayLike],
    path: str | os.PathLike[str] | None = None,
    *,
    size: tuple[int, int] = (900, 560),
) -> Image:
    r"""Draw spectra :math:`|\langle f, \varphi_i\rangle_B|` of functions over :math:`\lambda_i`.

    Both axes are logarithmic, so that the power laws of smoothness are straight lines. Dots are
    coefficients; lines are their root mean squares over half octaves, or more where these have
    few, which unlike single coefficients do not depend on the basis chosen in an eigenspace. The
    constant modes, λ = 0, are left out.

    Chapter items: F3.8, P61.

    Parameters
    ----------
    basis
        Eigenpairs of the pair (L, B).
    functions
        Names, for the legend, and functions (n,) or (n, c); the columns of one are taken together
        by the norm of their coefficients.
    path
        Where to write the picture, by suffix: png, webp or gif.
    size
        Width and height in pixels.

    Returns
    -------
    (h, w, 3) uint8 picture.

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed: ``pip install "beltrami[plot]"``.
    BeltramiError
        If there are no functions, or no eigenvalue beyond zero.
    DimensionError, NonFiniteError, UnknownNameError
        If a function or the suffix is not valid.
    """
    if path is not None:
        check_suffix(path)
    if not functions:
        raise BeltramiError("there is nothing to plot: give at least one function")
    positive = basis.eigenvalues > 1e-9 * max(float(basis.eigenvalues[-1]), 0.0)
    if not positive.any():
        raise BeltramiError("no eigenvalue is beyond zero: compute more eigenpairs")
    spectra = {
        name: _magnitudes(basis, as_function(f, basis.n, f"the function {name!r}"))[positive]
        for name, f in functions.items()
    }
    image = _draw(basis.eigenvalues[positive], spectra, size)
    if path is not None:
        write_image(path, image)
    return image


def band_means(eigenvalues: Floats, magnitudes: Floats) -> tuple[Floats, Floats]:
    """Root mean squares of coefficients over bands of the eigenvalues, which ascend.

    Bands are half octaves; those of fewer than three eigenvalues are joined with the next ones.
    Returns the geometric mean of the eigenvalues of each band, and the means.

    Examples
    --------
    >>> at, mean = band_means(np.array([1, 1.1, 2, 2.1, 8, 8, 8]), np.array([3, 4, 2, 0, 1, 1, 1]))
    >>> at.round(3).tolist(), mean.round(3).tolist()
    ([1.466, 8.0], [2.693, 1.0])
    """
    steps = _BANDS_PER_OCTAVE * np.log2(eigenvalues / eigenvalues[0]) + 1e-9
    _, octave = np.unique(np.floor(steps), return_inverse=True)
    band = _joined(np.bincount(octave))[octave]
    count = np.bincount(band)
    at = np.exp(np.bincount(band, np.log(eigenvalues)) / count)
    return at, np.sqrt(np.bincount(band, magnitudes**2) / count)


def _joined(counts: Integers) -> Integers:
    """Return the number of the band of each half octave; what is left at the end joins the last."""
    band, numbers, held = 0, [], 0
    for count in counts.tolist():
        numbers.append(band)
        held += count
        if held >= _FEW:
            band, held = band + 1, 0
    return np.minimum(numbers, max(band - 1, 0) if held else band)


def _magnitudes(basis: FourierBasis, f: Floats) -> Floats:
    coefficients = basis.forward(f)
    if coefficients.ndim == 1:
        return np.abs(coefficients)
    return np.asarray(np.linalg.norm(coefficients, axis=1))


def _pixels(size: tuple[int, int]) -> tuple[int, int]:
    """Return width and height, with room for the letters on the axes."""
    try:
        width, height = size
    except (TypeError, ValueError) as cause:
        raise MeshError(f"size is {shown(size)} where (width, height) is needed") from cause
    return whole("width", width, _SMALLEST, _LARGEST), whole("height", height, _SMALLEST, _LARGEST)


def _draw(eigenvalues: Floats, spectra: Mapping[str, Floats], size: tuple[int, int]) -> Image:
    plot = LinePlot(_pixels(size), "plots of spectra")
    axes = plot.axes
    axes.set(xscale="log", yscale="log", xlabel="eigenvalue λ", ylabel="size of coefficient")
    first, last = float(eigenvalues[0]), float(eigenvalues[-1])
    if last < _NARROWEST * first:  # alike, but perhaps for rounding: axes need a width
        axes.set_xlim(first / 2, last * 2)
    highest = max(float(values.max()) for values in spectra.values())
    floor = _FLOOR * (highest or 1.0)
    for i, (name, values) in enumerate(spectra.items()):
        color = COLORS[i % len(COLORS)]
        axes.plot(eigenvalues, np.maximum(values, floor), ".", color=color, alpha=0.3, ms=5)
        at, mean = band_means(eigenvalues, values)
        axes.plot(at, np.maximum(mean, floor), "-", color=color, lw=2, label=name)
    return plot.picture()
