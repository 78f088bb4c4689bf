r"""Where iterated averaging on a grid goes (theorem 5, E37)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Floats
from beltrami.grids.axis import Axes
from beltrami.operators.pair import Laplacian


@dataclass(frozen=True, eq=False)
class AveragingLimit:
    r"""Limits of :math:`\tilde W^k f` as k grows.

    Attributes
    ----------
    even, odd : as f
        Limits over the even and over the odd k. They agree where the grid is not bipartite.
    converges : bool
        Whether they agree for every function.
    """

    even: Floats
    odd: Floats
    converges: bool


def bipartite(axes: Axes) -> bool:
    """Whether the points have two colours such that no neighbours share one.

    So it is unless some circle has an odd number of points; one of a single point has no edges.
    """
    return not any(axis.periodic and axis.size % 2 and axis.size > 1 for axis in axes)


def averaging_limit(axes: Axes, pair: Laplacian, f: Floats, lazy: bool) -> AveragingLimit:
    r"""Return the limits for the pair of this grid; O(n c).

    On a bipartite graph :math:`\tilde W^2` mixes each colour by itself, and :math:`\tilde W`
    swaps the two: the limits are the means of the colours, weighted by the degrees.
    """
    if lazy or not bipartite(axes):
        mean = np.broadcast_to(_mean(pair.degrees, f), f.shape)
        return AveragingLimit(mean.copy(), mean.copy(), True)
    colour = np.indices([axis.size for axis in axes]).sum(axis=0).ravel() % 2
    means = np.stack([_mean(pair.degrees[colour == c], f[colour == c]) for c in (0, 1)])
    return AveragingLimit(means[colour], means[1 - colour], False)


def _mean(weights: Floats, f: Floats) -> Floats:
    return np.asarray(weights / weights.sum() @ f)  # a mean of finite values is finite
