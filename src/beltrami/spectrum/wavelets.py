"""Two frames of wavelets on meshes: Meyer's, tight, and Mexican hats."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from beltrami._arrays import Floats, whole
from beltrami._kinds import checked
from beltrami.errors import BeltramiError
from beltrami.spectrum.frames import Frame
from beltrami.spectrum.kernel import Kernel
from beltrami.spectrum.kernels import smooth_step


@dataclass(frozen=True)
class MeyerBand(Kernel):
    r""":math:`\sin(\frac\pi2 s(\lambda/a - 1)) \cos(\frac\pi2 s(\lambda/b - 1))`: Meyer's band.

    It rises over [a, 2a] and falls over [b, 2b] by ``smooth_step`` s; the squares of bands with
    the same ends, one after the other, add to 1.

    Parameters
    ----------
    low, high
        a < b with 2a <= b. a = 0: no rise, the scaling function; b = inf: no fall.
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        if not 0 <= 2 * self.low <= self.high or not self.high:
            raise BeltramiError(f"a band of Meyer needs 0 <= 2 low <= high > 0, not {self!r}")

    def _at(self, x: Floats) -> Floats:
        rise = np.sin(np.pi / 2 * smooth_step(x / self.low - 1)) if self.low else np.ones_like(x)
        return np.asarray(rise * np.cos(np.pi / 2 * smooth_step(x / self.high - 1)))


@dataclass(frozen=True)
class MexicanHat(Kernel):
    r""":math:`h(\lambda) = \frac\lambda p\, e^{1 - \lambda/p}`: 1 at its peak p, 0 at 0.

    On a plane, where λ is the square of a wave number, minus the Laplacian of a Gaussian.

    Parameters
    ----------
    peak
        p > 0.
    """

    peak: float

    def __post_init__(self) -> None:
        if not 0 < self.peak < np.inf:
            raise BeltramiError(f"the peak of a Mexican hat must be finite and > 0, not {self!r}")

    def _at(self, x: Floats) -> Floats:
        return np.asarray(x / self.peak * np.exp(1 - x / self.peak))


@dataclass(frozen=True)
class Plateau(Kernel):
    r""":math:`h(\lambda) = e^{-(\lambda/c)^4}`: flat at 0, the scaling function of Mexican hats."""

    cutoff: float

    def _at(self, x: Floats) -> Floats:
        return np.asarray(np.exp(-((x / self.cutoff) ** 4)))


@checked
def meyer_frame(bound: float, scales: int = 4) -> Frame:
    r"""Make a tight frame of a scaling function and wavelets in dyadic bands: A = B = 1.

    Band j falls where the next one rises, over [c, 2c] with :math:`c = 2^{-j} \cdot` bound / 2; all
    are smooth, so that Chebyshev polynomials find them, and energies are kept.

    Parameters
    ----------
    bound
        Largest eigenvalue, ``laplacian.spectral_bound()`` for one.
    scales
        Number of wavelets, >= 1; with the scaling function there are ``scales + 1`` kernels.

    Notes
    -----
    After Leonardi and Van De Ville, *Tight wavelet frames on multislice graphs* (2013), with a step
    that has all derivatives.

    Examples
    --------
    >>> frame = meyer_frame(8.0, 3)
    >>> frame.kernels[0], [round(x, 12) for x in frame.bounds]
    (MeyerBand(low=0.0, high=1.0), [1.0, 1.0])
    """
    whole("scales", scales, 1, 60)
    ends = [0.0, *(bound * 2.0**-j for j in range(scales, 0, -1)), np.inf]
    return Frame(tuple(MeyerBand(a, b) for a, b in pairwise(ends)), bound)


@checked
def mexican_hat_frame(bound: float, scales: int = 5) -> Frame:
    r"""Make a frame of Mexican hats with dyadic peaks, and a plateau below them.

    The peaks are at bound, bound / 2, bound / 4 ...; the plateau ends at the lowest one. Not tight:
    ``frame.bounds`` tells A and B.

    Parameters
    ----------
    bound
        Largest eigenvalue, ``laplacian.spectral_bound()`` for one.
    scales
        Number of hats, >= 1.

    Notes
    -----
    After Hammond, Vandergheynst and Gribonval, *Wavelets on graphs via spectral graph theory*
    (2011).

    Examples
    --------
    >>> A, B = mexican_hat_frame(8.0).bounds
    >>> round(A, 2), round(B, 2)
    (1.0, 2.6)
    """
    whole("scales", scales, 1, 60)
    peaks = [bound * 2.0**-j for j in range(scales - 1, -1, -1)]
    return Frame((Plateau(peaks[0]), *(MexicanHat(p) for p in peaks)), bound)
