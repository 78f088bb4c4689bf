"""Stein's unbiased risk, and the mixture of candidates that makes it least (SURE-LET)."""

from __future__ import annotations

import numpy as np
from scipy.optimize import nnls

from beltrami._arrays import Floats

_RIDGE = 1e-10  # of the Gram matrix: candidates are nearly alike
_STIFF = 1e3  # how hard the sum of the weights is held at 1
_STEEP = 1e3  # from here on only the divergence counts: noise that is much larger than the mesh


def mixture_risk(weights: Floats, gram: Floats, divergence: Floats, sigma: float) -> float:
    r"""Return Stein's estimate of :math:`|x - x_0|^2 / n` for :math:`x = \sum_j w_j x_j`.

    With y = x_0 + noise and x_j = y + d_j(y) it is
    :math:`|\sum w_j d_j|^2/n - \sigma^2 + 2\sigma^2 \sum w_j\, \mathrm{div}\, x_j/n` (Stein 1981):
    unbiased for white Gaussian noise of the level σ, and for linear filters for any white noise.

    Parameters
    ----------
    gram
        (c, c) mean products <d_j, d_k>/n of the displacements of the candidates.
    divergence
        (c,) estimates of div x_j / n, noise along one direction at each vertex.
    """
    return float(weights @ gram @ weights - sigma**2 + 2 * sigma**2 * weights @ divergence)


def best_mixture(gram: Floats, divergence: Floats, sigma: float) -> Floats:
    r"""Return weights w >= 0 that add to 1 and make the risk of :math:`\sum w_j x_j` least.

    The risk of a mixture is quadratic in w,
    :math:`w^T G w - \sigma^2 + 2\sigma^2\, \mathrm{div} \cdot w` (Luisier, Blu and Unser 2007, for
    shrinkage of wavelets), so that the best mixture is found and not searched for. It is no worse
    than the best candidate by this estimate.

    Parameters
    ----------
    gram, divergence, sigma
        As ``mixture_risk``.

    Examples
    --------
    >>> G = np.diag([0.0, 1.0])  # keep the data, or flatten everything
    >>> best_mixture(G, np.array([1.0, 0.0]), 0.5).round(3).tolist()
    [0.75, 0.25]
    """
    c = len(divergence)
    size = float(np.trace(gram)) / c
    if size == 0:  # no candidate moves anything
        return np.full(c, 1 / c)
    factor = np.linalg.cholesky(gram / size + _RIDGE * np.eye(c))
    slope = sigma**2 / size * divergence
    slope *= min(1.0, _STEEP / max(float(np.abs(slope).max()), 1.0))
    target = np.linalg.solve(factor, -slope)
    system = np.vstack([factor.T, np.full((1, c), _STIFF)])
    weights, _ = nnls(system, np.append(target, _STIFF), maxiter=100 * c)
    return np.asarray(weights / weights.sum())
