"""From a functional map to a map of points, and back (Ovsjanikov et al. 2012)."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats, Integers


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
    (n_target,) indices of source vertices. Cost: a KD-tree of the source, a query for each
    target vertex.
    """
    return _nearest(source @ C.T, target)


def nearest_points_back(C: Floats, source: Floats, target: Floats) -> Integers:
    r"""Send each source vertex x to the target vertex y whose :math:`\psi(y)` is next to Cφ(x).

    Returns
    -------
    (n_source,) indices of target vertices.
    """
    return _nearest(target, source @ C.T)


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


def _nearest(among: Floats, queries: Floats) -> Integers:
    from scipy.spatial import KDTree  # slow to load

    return np.asarray(KDTree(among).query(queries)[1], dtype=np.int64)
