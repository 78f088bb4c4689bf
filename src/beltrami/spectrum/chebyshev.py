"""ChebyshevSeries: a kernel as a polynomial, with the error that it has."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.chebyshev import chebval
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_floats, read_only
from beltrami.errors import ApproximationError
from beltrami.spectrum.interval import Interval, probes
from beltrami.spectrum.kernel import Kernel, Response, evaluate

_FEWEST, _MOST = 2048, 2**16  # nodes; orders go up to half of the most


@dataclass(frozen=True, eq=False, repr=False)
class ChebyshevSeries:
    r"""A polynomial :math:`p(\lambda) = \sum_k c_k T_k(x)`; x = -1 at ``low``, 1 at ``high``.

    ``chebyshev_series`` makes it.

    Attributes
    ----------
    coefficients : (order + 1,) c_k
    interval : Interval of λ
    size : the largest |h| met in the interval
    error : an estimate of max |p - h| over the interval, rounding included; as
        good as the samples of h. A jump has an error of half its height, whatever the order.
    """

    coefficients: Floats
    interval: Interval
    size: float
    error: float

    def __post_init__(self) -> None:
        read_only(self.coefficients)

    def __repr__(self) -> str:
        return f"<ChebyshevSeries: order {self.order}, error about {self.error:.2g}>"

    @property
    def order(self) -> int:
        """Degree of the polynomial: the number of products with the matrix."""
        return len(self.coefficients) - 1

    def __call__(self, eigenvalues: ArrayLike) -> Floats:
        """Return p(λ), in the shape of λ."""
        low, high = self.interval
        x = as_floats(eigenvalues)
        middle, half = (low + high) / 2, (high - low) / 2
        return np.asarray(chebval((x - middle) / half if half else 0 * x, self.coefficients))


def chebyshev_series(
    h: Response, interval: Interval, tolerance: float = 1e-8, order: int | None = None
) -> ChebyshevSeries:
    r"""Expand a kernel in Chebyshev polynomials, to the order that a wanted error needs.

    The coefficients are those of the interpolant at 2048, 4096 ... nodes, by a cosine transform,
    until their tail is small and the series agrees with h at points between, which come near both
    ends of the interval. The order is the least whose tail of coefficients,
    :math:`\sum_{k > N} |c_k| \ge \max|p_N - p|`, is below half the tolerance. Analytic kernels need
    about :math:`\sqrt{t\lambda_n}` terms or fewer (heat); kernels with a kink never get far.

    Parameters
    ----------
    h
        A ``Kernel``, or a function of an array of eigenvalues.
    interval
        What contains the spectrum, from ``spectral_interval``.
    tolerance
        Error wanted, beside the largest \|h\|.
    order
        The order itself: then nothing is promised, and ``.error`` tells what was reached.

    Raises
    ------
    ApproximationError
        If no order up to 32768 reaches the tolerance, or rounding does not let it, or h jumps;
        ``error.estimate`` is what was reached.
    DimensionError, NonFiniteError, BeltramiError
        If h is not a function with finite real values.

    Notes
    -----
    Source: the adaptive construction of Chebyshev interpolants of Trefethen, *Approximation Theory
    and Approximation Practice* (2013), chapters 3 to 8; filters on graphs by it in Hammond,
    Vandergheynst and Gribonval (2011).

    Examples
    --------
    >>> series = chebyshev_series(lambda x: np.exp(-x), Interval(0.0, 8.0))
    >>> series.order, bool(abs(series(3.0) - np.exp(-3.0)) < 1e-8)
    (14, True)
    """
    low, high = interval
    if low == high:
        value = evaluate(h, np.array([low]))
        return ChebyshevSeries(value.copy(), interval, abs(float(value[0])), 0.0)
    jumps = [jump for jump in h.jumps if low <= jump < high] if isinstance(h, Kernel) else []
    if jumps and order is None:
        raise ApproximationError(
            f"h jumps at λ = {jumps[0]:g}, and no polynomial comes near a jump", 0.5, REMEDY
        )
    places = probes(interval)
    truth = evaluate(h, places)
    nodes = _FEWEST if order is None else max(_FEWEST, 4 << order.bit_length())
    while True:
        series = _interpolant(h, interval, nodes, tolerance, order, places, truth)
        if order is not None or series.error <= tolerance * series.size:
            return series
        if nodes >= _MOST:
            reached = series.error / series.size
            raise ApproximationError(
                f"polynomials of an order up to {nodes // 2} leave an error of about {reached:.1g} "
                f"beside the largest |h|, and {tolerance:.1g} is wanted",
                reached,
                REMEDY,
            )
        nodes *= 2


REMEDY = (
    'Use method="exact" on a small mesh, method="lanczos", a smoother kernel (with a width) or a '
    "larger tolerance; fourier_basis(laplacian, k).filter(f, h) if h is small beyond the first k "
    "eigenvalues; or give the order, and nothing is promised."
)


def _interpolant(
    h: Response,
    interval: Interval,
    nodes: int,
    tolerance: float,
    order: int | None,
    places: Floats,
    truth: Floats,
) -> ChebyshevSeries:
    """Interpolate at so many nodes, cut the series, and measure what is left."""
    from scipy.fft import dct

    low, high = interval
    angles = np.pi * (np.arange(nodes) + 0.5) / nodes
    values = evaluate(h, low + (high - low) * np.cos(angles / 2) ** 2)
    c = dct(values, type=2) / nodes
    c[0] /= 2
    size = max(float(np.abs(values).max()), float(np.abs(truth).max()))
    tails = np.concatenate([np.cumsum(np.abs(c[:0:-1]))[::-1], [0.0]])
    if order is None:
        enough = np.flatnonzero(tails <= tolerance * size / 2)
        order = min(int(enough[0]), nodes // 2)
    kept = c[: order + 1]
    missed = np.abs(ChebyshevSeries(kept.copy(), interval, size, 0.0)(places) - truth).max()
    return ChebyshevSeries(kept.copy(), interval, size, max(float(missed), float(tails[order])))
