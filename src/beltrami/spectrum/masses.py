"""The masses that a basis knows: of the vertices, and of all of the surface."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats
from beltrami.spectrum.basis import FourierBasis


def vertex_masses(basis: FourierBasis) -> Floats:
    """Return the (n,) row sums of B."""
    return np.asarray(basis.mass.sum(axis=1), dtype=np.float64).ravel()


def total_mass(basis: FourierBasis) -> float:
    """Return <1, 1>_B: the area of the surface with area masses."""
    return float(basis.mass.sum())
