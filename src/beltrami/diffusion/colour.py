"""The colour of noise: how strong it is in bands of frequencies, and noise alike."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.polynomial import Chebyshev

from beltrami._arrays import Booleans, Floats, Integers, read_only
from beltrami.diffusion.averaging_series import filter_rows, filter_rows_by
from beltrami.diffusion.noise import NoiseLevel
from beltrami.mesh.mesh import Mesh
from beltrami.solvers.locality import LocalRows

# gains k^a (2 - k)^b, largest at 2a/(a + b): polynomials of W̃, so that creases stay where they are
_EXPONENTS = ((3, 8), (4, 7), (4, 4), (5, 3), (6, 0))
_PEAKS = tuple(2 * a / (a + b) for a, b in _EXPONENTS)
_LOW, _MIDDLE, _HIGH, _HIGHER, _TOP = range(5)  # of these bands
_AREA = 12.0  # time of the heat that takes local means: radius of some 3.5 edges
_QUIET, _ROUGH = 0.1, 0.9  # shares of the vertices where there is less
_CLIP = 9.0  # variances beyond which squares do not count
_HALF_SQUARE = 0.45493642311957283  # median of the square of a standard normal variable
_EXCESSES = {_LOW: 0.55, _MIDDLE: 0.35}  # logarithms: see is_coloured
_UNEVEN = 1.5  # where there is shape all over
_DIP = 0.8
_BLUNT, _PEAKED = 2.4, 5.0  # kurtosis of what is not Gaussian
_FAINT = 0.12  # mean edges, below which it may be the texture of the shape
_STEP, _FALL, _RISE = 1.2, 1.3, 0.95  # of the highest bands, that a floor of white noise allows
_FLATTEST, _STEEPEST = 1.0, 6.0  # powers of 1 - k/2
_SHAPE = 1.5  # power of what is uneven that is shape
_CHANCE = 0.12  # by which noise alone may be uneven
_DRAWN, _MOST_DRAWS = 32_000, 4  # vertices that get noise again, by doing so some times
_MOST_MORE = 2.0  # times the level: a line that starts lower says little
_FITS = 10
_STEEPEST_LINE = 4.0  # a first result has half of the amplitudes of the shape, at least
_LEAST_FIT = 1e-3  # of the mean: a line through 0 has no relative errors there
_WHITE = 6  # columns of white noise to compare with
_SEED = 7
_DEGREE = 40


@dataclass(frozen=True)
class NoiseColour:
    """Levels of the noise in five bands of the frequencies of Id - W̃, the lowest first.

    Attributes
    ----------
    levels
        Standard deviation of the white noise that is as strong in the band, where the mesh is
        quiet: the tenth of the vertices with the least of it around them; or beside a first result.
    uneven
        How much stronger the band is where there is much of it than where there is little, over
        what white noise has there: 1 where there is noise alone, more where there is shape.
    kurtosis
        Of the second band; 3 if the noise is Gaussian, larger if it has spikes, and near 1 where a
        shape repeats: a thin tube.
    """

    levels: tuple[float, ...]
    uneven: tuple[float, ...]
    kurtosis: float

    def is_coloured(self, edge_length: float) -> bool:
        """Whether the noise is correlated: even, but stronger in the middle than at the top.

        What is left of a shape is stronger in the middle too, but not everywhere: the more uneven
        the band, the more it may have. Where few vertices make a shape, as edge collapses leave
        them, it is as even as noise; but white noise upon it is a floor, which the highest bands
        share. A shape never makes a band weaker than the next.
        """
        top, least = self.levels[_TOP], _FAINT * edge_length
        if not (_BLUNT < self.kurtosis < _PEAKED and min(self.levels) > 0):
            return False
        high, higher = self.levels[_HIGH], self.levels[_HIGHER]
        if _RISE * top < min(high, higher) and high < min(_STEP * higher, _FALL * top):
            return False
        for band, log in _EXCESSES.items():
            more = max(self.uneven[band] - 1, 0.0)
            excess = math.exp(log + more + 2 * more**2)
            if self.uneven[band] < _UNEVEN and self.levels[band] > max(excess * top, least):
                return True
        return top > least / 2 and self.levels[_HIGH] < _DIP * top

    def amplitude(self, k: Floats) -> Floats:
        """Return the standard deviation at the frequencies k, between bands in a straight line.

        What is uneven is taken for shape. Below the lowest band it grows as the power of 1 - k/2
        that fits the lowest two: that of white noise after rounds of averaging.
        """
        uneven = np.array(self.uneven)
        of_noise = np.sqrt(np.clip(uneven, 1, 1 + _CHANCE))  # from a quiet place to the middle
        levels = of_noise * np.array(self.levels) / np.maximum(uneven - _CHANCE, 1) ** _SHAPE
        rest = 1 - np.array(_PEAKS[:2]) / 2
        power = np.log(levels[0] / levels[1]) / np.log(rest[0] / rest[1])
        power = min(max(float(power), _FLATTEST), _STEEPEST)
        below = levels[0] * ((1 - np.minimum(k, _PEAKS[0]) / 2) / rest[0]) ** power
        return np.asarray(np.where(k < _PEAKS[0], below, np.interp(k, _PEAKS, levels)))

    def noise(self, rows: LocalRows, white: Floats) -> Floats:
        """Return noise (n, d) of this colour from white noise of variance 1."""
        series = Chebyshev.interpolate(lambda x: self.amplitude(1 - x), _DEGREE)
        return filter_rows(rows, white, np.asarray(series.coef, np.float64))

    def deviation(self, rows: LocalRows, degrees: Integers, f: Floats) -> float:
        r"""Return the standard deviation of :math:`\sum_i f_i z_i`, z noise of this colour.

        With :math:`z = A w`, w white, it is :math:`|A^T f|`, and :math:`A^T = D A D^{-1}`, as A is
        a polynomial of W̃; D are the ``degrees``.
        """
        weights = np.maximum(degrees, 1)
        back = self.noise(rows, (f / weights)[:, None])[:, 0] * weights
        return float(np.linalg.norm(back))

    def level(self, rows: LocalRows) -> float:
        """Return the standard deviation of all frequencies."""
        white = np.random.default_rng(_SEED).standard_normal((len(rows.order), 1))
        return float(np.sqrt((self.noise(rows, white) ** 2).mean()))


def noise_colour(rows: LocalRows, x: Floats, normals: Floats, core: Booleans) -> NoiseColour:
    r"""Measure it along the normals of a mesh, on the vertices of the core.

    Each band is compared with white noise in the same band, vertex by vertex, by means over some
    40 neighbours; so the degrees of vertices and the borders do not matter. Values of more than
    three standard deviations are cut off.

    Parameters
    ----------
    rows
        Of W̃.
    x, normals
        (n, 3).

    Notes
    -----
    Cost: O(n), some 400 products with W̃.
    """
    levels, uneven, kurtosis = [], [], 3.0
    bands = zip(_bands(rows, x, normals), _white_bands(rows), strict=True)
    for i, (found, (alike, gain)) in enumerate(bands):
        (quiet, rough), (white_quiet, white_rough) = (
            np.sqrt(np.quantile(_around(rows, _cut(f**2 / gain))[core], (_QUIET, _ROUGH)))
            for f in (found, alike)
        )
        levels.append(float(quiet / white_quiet) if white_quiet > 0 else 0.0)
        if i == _MIDDLE:
            squares = (found**2 / gain)[core]
            mean = float(squares.mean())
            kurtosis = float(np.mean((squares / mean) ** 2)) if mean > 0 else 3.0
        spread = quiet * white_rough
        uneven.append(float(rough * white_quiet / spread) if spread > 0 else np.inf)
    return NoiseColour(tuple(levels), tuple(uneven), kurtosis)


def colour_beside(
    colour: NoiseColour,
    rows: LocalRows,
    mesh: Mesh,
    clean: Mesh,
    filtered: Callable[[Mesh], Mesh],
    core: Booleans,
) -> NoiseColour:
    r"""Return the colour with the levels of the noise beside the shape, which a first result tells.

    In each band, mean squares around the vertices are those of the noise, the same everywhere, and
    those of the shape, which are large where the first result has much in this band. A line is
    fitted through the ones over the others; the noise is where it starts. It is steep if the first
    result has lost much of the shape, and too steep by the noise that was left in it: how much
    lower it starts for that is measured on noise of the same colour, put on the first result and
    filtered the same way.

    Parameters
    ----------
    colour, core
        As measured at first, on these vertices.
    rows
        Of W̃.
    mesh, clean
        The noisy mesh, and the first result.
    filtered
        The filter that leads from one to the other.

    Returns
    -------
    NoiseColour: even; ``colour`` itself, if there is a band where all may be shape.

    Notes
    -----
    Cost: O(n), some 400 products with W̃, and up to four times some 300 and one run of the
    filter.
    """
    gains = [gain for _, gain in _white_bands(rows)]
    found = _beside(rows, gains, mesh, clean, core)
    if not found.min() > 0:
        return colour
    even = replace(colour, levels=tuple(found.tolist()), uneven=(1.0,) * len(found))
    random = np.random.default_rng(_SEED)
    true, seen = np.zeros(len(found)), np.zeros(len(found))
    for _ in range(min(_MOST_DRAWS, math.ceil(_DRAWN / len(core)))):
        noise = even.noise(rows, random.standard_normal((len(core), 1)))
        again = mesh.with_vertices(clean.vertices + noise * clean.vertex_normals)
        seen += _beside(rows, gains, again, filtered(again), core) ** 2
        bands = zip(_bands(rows, noise, np.ones_like(noise)), gains, strict=True)
        true += [float((f[core] ** 2).sum() / gain[core].sum()) for f, gain in bands]
    more = np.sqrt(true / np.maximum(seen, true / _MOST_MORE**2))
    return replace(even, levels=tuple((found * more).tolist()))


def _beside(
    rows: LocalRows, gains: list[Floats], mesh: Mesh, clean: Mesh, core: Booleans
) -> Floats:
    """Return the levels of the bands where the first result has nothing."""
    both = (_bands(rows, one.vertices, clean.vertex_normals) for one in (mesh, clean))
    starts = [
        start_of_line(_around(rows, g**2 / gain)[core], _around(rows, _cut(f**2 / gain))[core])
        for f, g, gain in zip(*both, gains, strict=True)
    ]
    return np.sqrt(starts)


def start_of_line(x: Floats, y: Floats) -> float:
    """Return a >= 0 of the line a + b x that is near y, 0 <= b <= 4, x and y >= 0.

    Values far from 0 are uncertain in proportion: squares of relative errors are made least, those
    to the line before, some times.

    Examples
    --------
    >>> x = np.array([0.0, 1.0, 2.0, 3.0])
    >>> round(start_of_line(x, 5 + 2 * x), 9), round(start_of_line(x, 5 - x), 9)
    (5.0, 3.5)
    """
    start, fit = 0.0, np.ones_like(y)
    for _ in range(_FITS):
        w = fit**-2 / (fit**-2).sum()
        middle, mean = float(w @ x), float(w @ y)
        spread = float(w @ (x - middle) ** 2)
        slope = float(w @ ((x - middle) * y)) / spread if spread > 0 else 0.0
        slope = min(max(slope, 0.0), _STEEPEST_LINE)
        start = max(mean - slope * middle, 0.0)
        fit = np.maximum(start + slope * x, _LEAST_FIT * mean)
        if not fit.min() > 0:
            return start
    return start


def _white_bands(rows: LocalRows) -> list[tuple[Floats, Floats]]:
    """Return white noise in each band, and its mean square around the vertices."""
    white = np.random.default_rng(_SEED).standard_normal((len(rows.order), _WHITE))
    alike, least = filter_rows_by(rows, white, _series()), np.finfo(float).tiny
    return [(f[:, 0], np.maximum(_around(rows, (f**2).mean(axis=1)), least)) for f in alike]


def _bands(rows: LocalRows, x: Floats, normals: Floats) -> list[Floats]:
    """Return x in each band, along the normals."""
    return [np.einsum("ij,ij->i", f, normals) for f in filter_rows_by(rows, x, _series())]


def with_colour(found: NoiseLevel, colour: NoiseColour, rows: LocalRows) -> NoiseLevel:
    """Return the level of noise of the colour, of all its frequencies, and say that it has one."""
    sigma = colour.level(rows)
    more = colour.levels[_MIDDLE] / colour.levels[_TOP]
    text = (
        "the noise is not white: neighbours are alike (at middle frequencies there is "
        f"{more:.1f} times as much as at high ones)"
    )
    return replace(found, sigma=sigma, spread=sigma, warnings=(*found.warnings, text))


def _cut(squares: Floats) -> Floats:
    return np.minimum(squares, _CLIP * np.median(squares) / _HALF_SQUARE)


def _around(rows: LocalRows, values: Floats) -> Floats:
    heat = np.array(_heat())
    return np.maximum(filter_rows(rows, values[:, None], heat)[:, 0], 0.0)


@cache
def _series() -> tuple[Floats, ...]:
    """Return the coefficients of the gains of all bands."""

    def gain(x: Floats, a: int, b: int) -> Floats:
        peak = 2 * a / (a + b)
        return np.asarray(((1 - x) / peak) ** a * ((1 + x) / ((2 - peak) or 1.0)) ** b)

    series = (Chebyshev.interpolate(gain, a + b, args=(a, b)) for a, b in _EXPONENTS)
    return tuple(read_only(np.asarray(one.coef, np.float64)) for one in series)


@cache
def _heat() -> tuple[float, ...]:
    series = Chebyshev.interpolate(lambda x: np.exp(_AREA * (x - 1)), _DEGREE)
    return tuple(np.asarray(series.coef, np.float64).tolist())
