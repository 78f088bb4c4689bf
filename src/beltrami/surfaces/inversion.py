"""From points on a surface back to their parameters: Gauss-Newton from the nearest sample."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from beltrami._arrays import Booleans, Floats

if TYPE_CHECKING:
    from beltrami.surfaces.chart import Chart

_SAMPLES, _ROUNDS = 4096, 60
_ON = 1e-8  # of the size of the surface: nearer points are on it
_RANK = 1e-9  # smaller singular values are those of a pole, where the parameter does not matter


def invert(chart: Chart, points: Floats) -> tuple[Floats, Booleans]:
    """Return the parameters of the nearest points of the surface, and whether they are those.

    Each round moves by the least-squares solution of J d = x - φ(u, v) and back into the domain;
    it converges quadratically for points on the chart. Points that are off it, or whose chart
    folds between the samples, come back as False.

    Parameters
    ----------
    points
        (n, k).

    Returns
    -------
    (n, 2) parameters and (n,) bool
    """
    starts = chart.domain.samples(_SAMPLES)
    _, nearest = cKDTree(chart(*starts)).query(points)
    u, v = starts[0][nearest], starts[1][nearest]
    for _ in range(_ROUNDS):
        missing = points - chart.immersion.points(u, v)
        if np.abs(missing).max(initial=0) <= 1e-15 * chart.size:
            break
        inverse = np.linalg.pinv(chart.immersion.tangents(u, v), rcond=_RANK)
        step = np.einsum("nic,nc->ni", inverse, missing)
        u, v = chart.domain.nearest(u + step[:, 0], v + step[:, 1])
        if (np.abs(step) <= 1e-15 * chart.domain.extent).all():
            break
    away = np.linalg.norm(points - chart.immersion.points(u, v), axis=1)
    return np.stack([u, v], axis=1), away <= _ON * chart.size
