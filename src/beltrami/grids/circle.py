r"""Fourier series on the circle R/2πZ: atoms, coefficients, their decay (theorems 19 and 20)."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real

import numpy as np
import scipy.fft
from numpy.typing import ArrayLike, NDArray

from beltrami._arrays import Floats, Integers, read_only, rectangular
from beltrami.errors import BeltramiError, DimensionError, NonFiniteError, shown
from beltrami.grids.values import as_values, is_whole, refuse_overflow


def circle_atoms(frequencies: ArrayLike, x: ArrayLike) -> NDArray[np.complex128]:
    r"""Return :math:`u_\omega(x) = e^{i\omega x} / \sqrt{2\pi}` (l. 626).

    They are orthonormal on [0, 2π), and :math:`u_\omega'' = -\omega^2 u_\omega`: the second
    derivative is not compact, as printed, but unbounded; its resolvent is compact (E80).

    Parameters
    ----------
    frequencies
        Whole numbers ω of either sign, (k,) or one.
    x
        Angles in radians, of any shape.

    Returns
    -------
    Complex array of the shape of x, with one more axis for ω if there are several.

    Raises
    ------
    DimensionError, NonFiniteError
        If a frequency is not a whole number, or an angle not a finite one.

    Notes
    -----
    Cost: O(k) for each angle.

    Chapter items: U36, P62.

    Examples
    --------
    >>> np.abs(circle_atoms([0, 5], [0.0, 1.0])).round(4).tolist()
    [[0.3989, 0.3989], [0.3989, 0.3989]]
    """
    angles = rectangular(x).astype(np.float64)
    with np.errstate(over="ignore", invalid="ignore"):
        phases = np.multiply.outer(angles, _whole(frequencies))
    if not np.isfinite(phases).all():
        raise NonFiniteError("angles, and their products with the frequencies, must be finite")
    return np.asarray(np.exp(1j * phases) / _ROOT)


@dataclass(frozen=True, eq=False)
class FourierSeries:
    r"""Coefficients :math:`\langle f, u_\omega\rangle` of a function on the circle.

    Attributes
    ----------
    coefficients : (n,) complex
    frequencies : (n,) int, ascending
    """

    coefficients: NDArray[np.complex128]
    frequencies: Integers

    def error(self, terms: ArrayLike) -> Floats:
        r"""Return the squared errors :math:`E(M) = \sum_{|\omega| > M/2} |\hat f(\omega)|^2`.

        In one dimension the M terms kept are those with :math:`|\omega| \le M/2` (E82).

        Parameters
        ----------
        terms
            M, one number or several, >= 0.

        Returns
        -------
        Array of the shape of ``terms``. Unit: that of f, squared.

        Raises
        ------
        DimensionError
            If a number of terms is not finite and >= 0.

        Notes
        -----
        Cost: O(n log n) and O(log n) for each M.

        Chapter items: T20.

        Examples
        --------
        >>> x = 2 * np.pi * np.arange(8) / 8
        >>> fourier_coefficients_circle(np.cos(x) + 3).error([0, 1, 2]).round(4).tolist()
        [3.1416, 3.1416, 0.0]
        """
        wanted = rectangular(terms).astype(np.float64)
        if not (np.isfinite(wanted) & (wanted >= 0)).all():
            raise DimensionError("numbers of terms must be finite and >= 0")
        size = np.abs(self.frequencies)
        order = np.argsort(-size, kind="stable")  # small terms first: nothing is cancelled
        sums = np.concatenate([[0.0], np.cumsum(np.abs(self.coefficients[order]) ** 2)])
        return np.asarray(sums[np.searchsorted(-size[order], -wanted / 2, side="left")])


def fourier_coefficients_circle(f: ArrayLike) -> FourierSeries:
    r"""Return :math:`\hat f(\omega) = \int_0^{2\pi} f(x) \overline{u_\omega(x)}\,dx` from samples.

    The trapezoidal rule, by FFT: exact for trigonometric polynomials of degree < n/2, and off by
    the sum of the coefficients at ω + n, ω - n, ω + 2n ... for others.

    Parameters
    ----------
    f
        (n,) values at 2πk/n, k = 0..n-1, real or complex.

    Returns
    -------
    FourierSeries
        ω from -floor(n/2) to floor((n-1)/2); for even n the first one stands for both ±n/2.

    Raises
    ------
    DimensionError, NonFiniteError
        If f is not one row of finite numbers.

    Notes
    -----
    Cost: O(n log n). Σ|c|² is the trapezoidal value of ∫|f|².

    Chapter items: T19, U36.

    Examples
    --------
    >>> x = 2 * np.pi * np.arange(16) / 16
    >>> series = fourier_coefficients_circle(np.cos(x))
    >>> series.coefficients[series.frequencies == 1].round(4).tolist()  # sqrt(π/2)
    [(1.2533-0j)]
    """
    values = as_values(f)
    if values.ndim != 1:
        raise DimensionError(f"a function on the circle has one row of values, not {values.shape}")
    n = len(values)
    with np.errstate(over="ignore", invalid="ignore"):
        coefficients = scipy.fft.fftshift(scipy.fft.fft(values)) * (_ROOT / n)
    refuse_overflow(coefficients, "the array of coefficients")
    return FourierSeries(read_only(coefficients), read_only(np.arange(n, dtype=np.int64) - n // 2))


def coefficient_bound(frequencies: ArrayLike, order: int, supremum: float) -> Floats:
    r"""Return :math:`\sqrt{2\pi}\,\|f^{(a)}\|_\infty |\omega|^{-a} \ge |\hat f(\omega)|`.

    Theorem 19 as printed lacks the factor, and cos x breaks it (E81). :math:`e^{i\omega x}` reaches
    this one.

    Parameters
    ----------
    frequencies
        Whole numbers ω other than 0.
    order
        a, a whole number >= 0: how often f is differentiated.
    supremum
        A bound on the a-th derivative.

    Returns
    -------
    Array of the shape of ``frequencies``. Unit: that of f.

    Raises
    ------
    DimensionError
        If a frequency is 0 or not a whole number.
    BeltramiError
        If the order or the supremum is not as above.

    Chapter items: T19.

    Examples
    --------
    >>> float(coefficient_bound(1, 1, 1.0).round(4))
    2.5066
    """
    omega = _whole(frequencies)
    if not omega.all():
        raise DimensionError("the bound says nothing of frequency 0")
    if not is_whole(order) or order < 0:
        raise BeltramiError(f"the order is a whole number >= 0, not {shown(order)}")
    if not isinstance(supremum, Real) or not 0 <= supremum < np.inf:
        raise BeltramiError(f"the supremum is finite and >= 0, not {shown(supremum)}")
    power = np.abs(omega.astype(np.float64)) ** -float(min(order, _LARGEST_ORDER))
    with np.errstate(over="ignore"):
        return np.asarray(refuse_overflow(_ROOT * (supremum * power), "the bound"))


def decay_exponent(sizes: ArrayLike, errors: ArrayLike) -> float:
    r"""Return the slope of log(errors) over log(sizes), by least squares.

    For f with :math:`\sum |\omega|^{2a} |\hat f(\omega)|^2 < \infty` the squared error E(M) decays
    at least like :math:`M^{-2a}`, not :math:`M^{-a}` as printed (E82); the slope is negative.
    Over the steps h of grids it is the order of convergence, and positive: 2 for the differences of
    3.2.6 (l. 355, 369).

    Parameters
    ----------
    sizes, errors
        Two or more positive numbers each, in any units.

    Raises
    ------
    DimensionError
        If there are fewer than two, not as many of both, or some are not positive and finite.

    Chapter items: T20, U22, U25.

    Examples
    --------
    >>> round(decay_exponent([1, 2, 4], [5.0, 1.25, 0.3125]), 12)
    -2.0
    """
    x, y = (rectangular(row).astype(np.float64) for row in (sizes, errors))
    if x.ndim != 1 or x.shape != y.shape or len(np.unique(x)) < 2:
        raise DimensionError("a slope needs two rows of as many numbers, and two sizes or more")
    if not (np.isfinite(x) & np.isfinite(y) & (x > 0) & (y > 0)).all():
        raise DimensionError("the logarithms need positive, finite sizes and errors")
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


_ROOT = float(np.sqrt(2 * np.pi))
_LARGEST_ORDER = 2000  # 2 to the power of minus that is 0


def _whole(frequencies: ArrayLike) -> Integers:
    given = rectangular(frequencies)
    if given.dtype.kind not in "iu":
        raise DimensionError("the frequencies of a circle are whole numbers")
    if given.dtype.kind == "u" and given.size and given.max() > np.iinfo(np.int64).max:
        raise DimensionError("frequencies above 2**63 are too large")
    return given.astype(np.int64)
