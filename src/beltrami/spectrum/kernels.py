r"""Kernels of filters: heat, waves, Tikhonov, and low, high and band passes.

Each is a function :math:`h(\lambda)` of the eigenvalue for ``bt.filter`` and ``basis.filter``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import expit

from beltrami._arrays import Floats, as_floats
from beltrami.errors import BeltramiError
from beltrami.spectrum.kernel import Combined, Kernel

__all__ = [
    "BandPass",
    "Combined",
    "Heat",
    "HighPass",
    "Kernel",
    "LowPass",
    "Tikhonov",
    "Wave",
    "WaveImpulse",
    "smooth_step",
]


@dataclass(frozen=True)
class Heat(Kernel):
    r""":math:`h(\lambda) = e^{-t\lambda}`: heat after the time t (equation 3.10).

    Chapter items: Q3.10.

    Parameters
    ----------
    time
        t >= 0, of the unit of 1/λ: length² with area masses.

    Examples
    --------
    >>> bool(abs((Heat(1.0) * Heat(2.0))(1.0) - np.exp(-3)) < 1e-15)
    True
    """

    time: float

    def __post_init__(self) -> None:
        _require(self.time, "the time of heat")

    def _at(self, x: Floats) -> Floats:
        return np.asarray(np.exp(-self.time * x))


@dataclass(frozen=True)
class Wave(Kernel):
    r""":math:`h(\lambda) = \cos(t\sqrt\lambda)`: the wave that starts from f at rest.

    It solves equation 3.8, :math:`F'' = -B^{-1}LF`, with :math:`F_0 = f` and :math:`F_0' = 0`.

    Chapter items: P46.

    Parameters
    ----------
    time
        t >= 0, of the unit of 1/√λ: length with area masses.
    """

    time: float

    def __post_init__(self) -> None:
        _require(self.time, "the time of a wave")

    def _at(self, x: Floats) -> Floats:
        return np.asarray(np.cos(self.time * _root(x)).real)


@dataclass(frozen=True)
class WaveImpulse(Kernel):
    r""":math:`h(\lambda) = \sin(t\sqrt\lambda)/\sqrt\lambda`, t at 0: the wave of an impulse.

    It solves equation 3.8 with :math:`F_0 = 0` and :math:`F_0' = g`; to g, add ``Wave`` of f.

    Chapter items: P46.

    Parameters
    ----------
    time
        t >= 0, of the unit of 1/√λ.
    """

    time: float

    def __post_init__(self) -> None:
        _require(self.time, "the time of a wave")

    def _at(self, x: Floats) -> Floats:
        return np.asarray(self.time * np.sinc(self.time / np.pi * _root(x)).real)


@dataclass(frozen=True)
class Tikhonov(Kernel):
    r""":math:`h(\lambda) = 1/(1 + t\lambda)`: quadratic regularisation, one implicit heat step.

    It minimises :math:`\|g - f\|_B^2 + t\langle Lg, g\rangle` over g (theorem 17 in the B-norm,
    E76).

    Parameters
    ----------
    weight
        t >= 0, of the unit of 1/λ.
    """

    weight: float

    def __post_init__(self) -> None:
        _require(self.weight, "the weight of Tikhonov")

    def _at(self, x: Floats) -> Floats:
        return np.asarray(1 / (1 + self.weight * x))


@dataclass(frozen=True)
class LowPass(Kernel):
    r"""1 below the cutoff, 0 above: :math:`1 - s((\lambda - c)/w + \tfrac12)`, s = ``smooth_step``.

    Parameters
    ----------
    cutoff
        c >= 0; ``basis.eigenvalues[m]`` keeps the frequencies up to the m-th.
    width
        w >= 0, the length of the smooth descent around c. 0: the ideal filter, which keeps
        λ <= c and jumps; no polynomial comes near it, but a basis applies it.
    """

    cutoff: float
    width: float = 0.0

    def __post_init__(self) -> None:
        _require(self.cutoff, "the cutoff of a low pass")
        _require(self.width, "the width of a low pass")

    @property
    def jumps(self) -> tuple[float, ...]:
        """The cutoff, if the width is 0."""
        return () if self.width else (self.cutoff,)

    def _at(self, x: Floats) -> Floats:
        return 1 - _rise(x, self.cutoff, self.width)


@dataclass(frozen=True)
class HighPass(Kernel):
    r"""0 below the cutoff, 1 above: exactly what ``LowPass(cutoff, width)`` removes.

    Parameters
    ----------
    cutoff, width
        As for ``LowPass``; 0 at the cutoff itself if the width is 0.
    """

    cutoff: float
    width: float = 0.0

    def __post_init__(self) -> None:
        _require(self.cutoff, "the cutoff of a high pass")
        _require(self.width, "the width of a high pass")

    @property
    def jumps(self) -> tuple[float, ...]:
        """The cutoff, if the width is 0."""
        return () if self.width else (self.cutoff,)

    def _at(self, x: Floats) -> Floats:
        return _rise(x, self.cutoff, self.width)


@dataclass(frozen=True)
class BandPass(Kernel):
    r"""1 between two cutoffs, 0 elsewhere; bands that touch, and a low pass below, add to 1.

    Parameters
    ----------
    low, high
        Cutoffs 0 <= low < high.
    width
        Length of the smooth rise and descent, at most high - low; 0: ideal, low < λ <= high.
    """

    low: float
    high: float
    width: float = 0.0

    def __post_init__(self) -> None:
        for value, name in ((self.low, "low"), (self.high, "high"), (self.width, "width")):
            _require(value, f"{name} of a band pass")
        if not self.low + self.width <= self.high or self.low == self.high:
            raise BeltramiError(
                f"a band pass needs low < high and low + width <= high, not {self!r}"
            )

    @property
    def jumps(self) -> tuple[float, ...]:
        """Both cutoffs, if the width is 0."""
        return () if self.width else (self.low, self.high)

    def _at(self, x: Floats) -> Floats:
        return _rise(x, self.low, self.width) - _rise(x, self.high, self.width)


def smooth_step(x: ArrayLike) -> Floats:
    r"""Rise from 0 at x <= 0 to 1 at x >= 1 with all derivatives; s(x) + s(1 - x) = 1.

    :math:`s(x) = \psi(x)/(\psi(x) + \psi(1-x))` with :math:`\psi(x) = e^{-1/x}`.

    Examples
    --------
    >>> smooth_step(np.array([-1.0, 0.0, 0.5, 1.0, 2.0])).tolist()
    [0.0, 0.0, 0.5, 1.0, 1.0]
    """
    x = as_floats(x)
    inside = (x > 0) & (x < 1)
    y = np.where(inside, x, 0.5)
    with np.errstate(over="ignore"):  # 1 / 1e-320: the step is 0 there
        rise = expit(1 / (1 - y) - 1 / y)
    return np.where(inside, rise, np.where(x > 0, 1.0, 0.0))


def _rise(x: Floats, cutoff: float, width: float) -> Floats:
    """Rise from 0 to 1 around the cutoff; without a width, jump after it."""
    if width == 0:
        return np.where(x > cutoff, 1.0, 0.0)
    with np.errstate(over="ignore"):  # a tiny width: infinitely far from the cutoff
        return smooth_step((x - cutoff) / width + 0.5)


def _root(x: Floats) -> np.ndarray:
    """Root of λ, imaginary for the negative eigenvalues of weights of either sign."""
    return np.asarray(np.sqrt(x.astype(np.complex128)))


def _require(value: object, what: str) -> None:
    if not (isinstance(value, Real) and math.isfinite(value) and float(value) >= 0):
        raise BeltramiError(f"{what} must be finite and >= 0, not {value!r}")
