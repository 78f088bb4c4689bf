"""A proven interval around the spectrum of a pair (L, B)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from beltrami._arrays import Floats
from beltrami.errors import MeshError
from beltrami.operators.pair import Laplacian


class Interval(NamedTuple):
    """The eigenvalues of (L, B) lie in [low, high]."""

    low: float
    high: float


def spectral_interval(laplacian: Laplacian) -> Interval:
    r"""Return an interval that is proven to contain every eigenvalue of (L, B).

    The upper end is the smaller of two bounds: that of the faces, ``laplacian.spectral_bound()``,
    and that of the disks of Gershgorin, :math:`\max_i (L_{ii} + \sum_{j \ne i} |L_{ij}|) / b_i`,
    which is within a factor of 2 of the largest eigenvalue if no weight is negative, as that is at
    least :math:`\max_i L_{ii} / b_i`. The consistent mass is at least a quarter of its row sums, in
    each face, so 4 times their disks bound its pair. The lower end is 0 where L is known to be
    positive semi-definite.

    Chapter items: T9.

    Raises
    ------
    MeshError
        If a mass is not positive, or no bound is known.

    Notes
    -----
    Cost: O(m + n).

    Examples
    --------
    >>> from beltrami.mesh.topology import Topology
    >>> from beltrami.operators.laplacian import laplacian
    >>> spectral_interval(laplacian(Topology([[0, 1, 2]])))
    Interval(low=0.0, high=1.5)
    """
    masses = laplacian.masses
    if not (masses > 0).all():
        raise MeshError(
            "B⁻¹L needs positive masses",
            vertices=np.flatnonzero(~(masses > 0)),
            remedy='Use another mass, mass="unit" for one.',
        )
    low, high = 0.0, laplacian.spectral_bound()
    part = 0.25 if laplacian.mass_kind == "consistent" else 1.0
    centre = laplacian.stiffness.diagonal()
    radius = abs(laplacian.stiffness) @ np.ones(laplacian.n) - np.abs(centre)
    high = min(high, float(((centre + radius) / masses).max()) / part)
    if not laplacian.properties.positive_semidefinite:
        low = min(0.0, float(((centre - radius) / masses).min()) / part)
    if not math.isfinite(high):
        raise MeshError(
            f"no bound is known for the eigenvalues of {laplacian.weight_kind} weights with the "
            f"{laplacian.mass_kind} mass",
            remedy='Use another mass, mass="voronoi" for one.',
        )
    return Interval(low, max(high, 0.0))


def probes(interval: Interval) -> Floats:
    """Return places to look at a kernel: the ends, ever nearer to both of them, and between.

    Most are near the lower end, where the smooth functions are: 12 in each octave.

    Examples
    --------
    >>> places = probes(Interval(0.0, 1.0))
    >>> len(places), float(places.min()), float(places[places > 0].min()), float(places.max())
    (2300, 0.0, 1.0842021724855044e-19, 1.0)
    """
    part = np.concatenate([[0.0, 1.0], _LOW, _HIGH, _INSIDE])
    return interval.low + (interval.high - interval.low) * part


_LOW = 2.0 ** -(np.arange(12, 63 * 12 + 1) / 12)
_HIGH = 1 - 2.0 ** -np.arange(1, 54)
_INSIDE = (np.arange(1500) + 0.5) * 0.6180339887498949 % 1  # without a period
