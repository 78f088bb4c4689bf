"""From a functional map to a map of points, and back (Ovsjanikov et al. 2012)."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami.spectrum.nearest import nearest_rows


def nearest_points(C: Floats, source: Floats, target: Floats) -> Integers:
    r"""Send each target vertex to the source vertex x with the nearest :math:`C\varphi(x)`.

    Parameters
    ----------
    C
        (k_target, k_source), from coefficients of the source to those of the target.
    source, target
        (n_source, k_source) and (n_target, k_target): the eigenvectors.

    Returns
    -------
    (n_target,) indices of source vertices. Cost: that of ``nearest_rows``.
    """
    return nearest_rows(source @ C.T, target)


def nearest_points_back(C: Floats, source: Floats, target: Floats) -> Integers:
    r"""Send each source vertex x to the target vertex y whose :math:`\psi(y)` is next to Cφ(x).

    Returns
    -------
    (n_source,) indices of target vertices.
    """
    return nearest_rows(target, source @ C.T)


def map_of_points(points: Integers, source: Floats, weighted: Floats) -> Floats:
    r"""Return the :math:`C = \Psi^T B \Phi[T]` of the pull-back :math:`f \mapsto f \circ T`.

    Parameters
    ----------
    points
        (n_target,) the source vertex T(y) of each target vertex y.
    source
        (n_source, k_source) the eigenvectors Φ.
    weighted
        (n_target, k_target) the product BΨ of the mass and the eigenvectors of the target.
    """
    return np.asarray(weighted.T @ source[points])


def map_of_samples(points: Integers, source: Floats, target: Floats) -> Floats:
    r"""Return the C with the least :math:`\|\Psi C - \Phi[T]\|^2` over a sample of the target.

    Parameters
    ----------
    points
        (q,) the source vertex of each sample.
    source
        (n_source, k_source) the eigenvectors Φ.
    target
        (q, k_target) the rows of Ψ at the samples.
    """
    from scipy.linalg import lstsq  # slow to load

    return np.asarray(lstsq(target, source[points], lapack_driver="gelsy")[0])
