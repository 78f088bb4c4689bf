"""Taubin's filter: a step that smooths, and one that grows back (Taubin 1995)."""

from __future__ import annotations

import math

import numpy as np

from beltrami._arrays import Floats
from beltrami.errors import BeltramiError, StepTooLongError

WIDEST = 2.0  # bound of the spectrum of Id - W̃ for weights that are not negative


def taubin_steps(step: float, pass_band: float, rounds: int) -> Floats:
    r"""Return λ, μ, λ, μ, ... with :math:`1/\lambda + 1/\mu = k_{PB}`, ``rounds`` pairs of them.

    One pair multiplies the frequency k of Id - W̃ by :math:`(1 - \lambda k)(1 - \mu k)`: exactly 1
    at 0 and at the pass band :math:`k_{PB}`, a little above 1 between (at most
    :math:`1 - \lambda\mu k_{PB}^2/4`), and smaller beyond.

    Raises
    ------
    StepTooLongError
        If the highest frequency, 2, would grow: ``error.longest`` is the longest λ that is stable.
    BeltramiError
        If the numbers are not 0 < λ, 0 < k_PB < 1.

    Examples
    --------
    >>> taubin_steps(0.5, 0.1, 2).round(4).tolist()
    [0.5, -0.5263, 0.5, -0.5263]
    """
    if not 0 < pass_band < 1:
        raise BeltramiError(f"the pass band must be between 0 and 1, not {pass_band}")
    if not (step > 0 and math.isfinite(step)):
        raise BeltramiError(f"the step must be > 0, not {step}")
    # 1 + λμ k (k - k_PB) >= -1 at k = 2, where λμ = -λ² / (1 - k_PB λ)
    limit = 2 / (WIDEST * (WIDEST - pass_band))
    half = pass_band * limit / 2
    longest = math.sqrt(half**2 + limit) - half
    if step > longest * (1 + 1e-12):
        raise StepTooLongError(step, longest, "Taubin's filter", "Take a shorter one")
    return np.tile([step, step / (pass_band * step - 1)], rounds)
