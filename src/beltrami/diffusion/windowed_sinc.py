"""The windowed sinc filter: a polynomial of W̃ that is near 1, then near 0 (Taubin 1996)."""

from __future__ import annotations

import math

import numpy as np

from beltrami._arrays import Floats
from beltrami.errors import BeltramiError


def sinc_coefficients(pass_band: float, degree: int) -> Floats:
    r"""Return c with :math:`\sum_i c_i T_i(1 - k)` near 1 for k < k_PB, and near 0 beyond.

    The Chebyshev coefficients of the ideal low-pass filter on the frequencies 0 <= k <= 2 of
    Id - W̃, times a Hamming window, which trades the ripples of a cut series for a wider edge of
    about :math:`8\pi/N` in the angle :math:`\arccos(1 - k)`. They are scaled to add to 1, so that
    constants stay (Taubin, Zhang and Golub 1996).

    Raises
    ------
    BeltramiError
        If the pass band is not between 0 and 2, or the degree below 1.

    Examples
    --------
    >>> c = sinc_coefficients(0.1, 20)
    >>> gain = np.polynomial.chebyshev.chebval(1 - np.array([0, 0.01, 0.1, 1]), c)
    >>> gain.round(2).tolist()
    [1.0, 1.0, 0.5, -0.0]
    """
    if not 0 < pass_band < 2:
        raise BeltramiError(f"the pass band must be between 0 and 2, not {pass_band}")
    if degree < 1 or degree != int(degree):
        raise BeltramiError(f"steps must be a whole number >= 1, not {degree}")
    edge = math.acos(1 - pass_band)
    i = np.arange(1, int(degree) + 1)
    window = 0.54 + 0.46 * np.cos(np.pi * i / (degree + 1))
    c = np.concatenate([[edge / np.pi], 2 * window * np.sin(i * edge) / (i * np.pi)])
    return np.asarray(c / c.sum())
