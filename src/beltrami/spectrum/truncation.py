"""What the modes beyond a basis would add: bounds, from the mass alone."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Booleans, Floats
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.masses import vertex_masses
from beltrami.spectrum.signature import weighted_squares


def missing_squares(basis: FourierBasis) -> Floats:
    r"""Bound the (n,) sums of :math:`\varphi_i(x)^2` over the modes beyond the basis.

    All modes together give :math:`(B^{-1})_{xx}`. For a diagonal B this is 1/b, and the bound is
    an equality; the consistent mass is at least a quarter of its row sums (on one face its
    eigenvalues are 1/4, 1/4 and 1 times the lumped ones), so it is at most 4/b. Where all vectors
    are 0, vertices are held at 0, and nothing is missing.
    """
    if not missing_modes(basis):
        return np.zeros(basis.n)
    sums = vertex_masses(basis)
    diagonal = np.array_equal(sums, basis.mass.diagonal())
    whole = (1.0 if diagonal else 4.0) / sums
    seen = weighted_squares(basis, np.ones((basis.k, 1)))[:, 0]
    rounding = basis.k * np.finfo(np.float64).eps * whole  # of the sum
    return np.where(_free(basis), np.maximum(whole - seen, 0.0) + rounding, 0.0)


def missing_modes(basis: FourierBasis) -> int:
    """Return how many modes are beyond the basis."""
    return int(_free(basis).sum()) - basis.k


def _free(basis: FourierBasis) -> Booleans:
    return np.asarray(basis.eigenvectors.any(axis=1))


def worst_ratio(parts: Floats, values: Floats) -> Floats:
    """Return the (q,) largest part beside its value, 0 for nothing beside nothing."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ratios = np.where(parts > 0, parts / values, 0.0)
    return np.asarray(ratios.max(axis=0))
