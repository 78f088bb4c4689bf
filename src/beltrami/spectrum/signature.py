"""Signature: functions on the vertices that a spectrum makes, and what its end leaves out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Booleans, Floats, as_function, read_only, rectangular
from beltrami.errors import BeltramiError
from beltrami.spectrum.basis import FourierBasis

_ROWS = 4096  # of the eigenvectors, squared at once


@dataclass(frozen=True, eq=False, repr=False)
class Signature:
    """A row of numbers for each vertex: the heat or the wave kernel signature.

    numpy takes it for its values: ``np.hstack([heat, wave])``, ``heat @ weights`` by
    ``np.asarray(heat)``.

    Attributes
    ----------
    values : (n, q)
    at : (q,) the times, or the energies (logarithms of eigenvalues)
    kind : ``"heat"`` or ``"wave"``
    truncation : (q,) a proven bound of what the modes beyond the basis would change, beside the
        value, at the worst vertex; 0 with all modes, and above 1 where the basis is too short
    """

    values: Floats
    at: Floats
    kind: str
    truncation: Floats

    def __post_init__(self) -> None:
        for array in (self.values, self.at, self.truncation):
            read_only(array)

    def __repr__(self) -> str:
        n, q = self.values.shape
        name = "times" if self.kind == "heat" else "energies"
        span = f"{self.at.min():.3g} to {self.at.max():.3g}" if q else "none"
        return f"<Signature: {self.kind}, {n} vertices, {q} {name} ({span})>"

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Floats:
        """Return the values; a copy if another type or a copy is asked for."""
        given = self.values if dtype is None else self.values.astype(dtype, copy=False)
        return given.copy() if copy and given is self.values else given


def weighted_squares(basis: FourierBasis, weights: Floats) -> Floats:
    r"""Sum :math:`\sum_i w_{iq} \varphi_i(x)^2` for weights (k, q): (n, q), in O(nkq)."""
    result = np.empty((basis.n, weights.shape[1]))
    for start in range(0, basis.n, _ROWS):
        rows = slice(start, start + _ROWS)
        result[rows] = basis.eigenvectors[rows] ** 2 @ weights
    return result


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
    return np.where(_free(basis), np.maximum(whole - seen, 0.0), 0.0)


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


def as_samples(samples: ArrayLike, what: str, *, positive: bool = False) -> Floats:
    """Check one number or a list of finite numbers, which must be >= 0 if they are positive."""
    given = np.atleast_1d(rectangular(samples)).astype(np.float64)
    if given.ndim != 1 or not len(given):
        raise BeltramiError(f"{what} must be a number or a list of numbers")
    values = as_function(given, len(given), what)
    if positive and values.min() < 0:
        raise BeltramiError(f"{what} must be >= 0, not {values.min():g}")
    return values


def as_count(count: int, what: str, least: int = 1) -> int:
    """Check a whole number from ``least`` on."""
    whole = rectangular(count)
    if whole.ndim or whole.dtype.kind not in "iu" or whole < least:
        raise BeltramiError(f"{what} must be a whole number >= {least}, not {count}")
    return int(whole)


def vertex_masses(basis: FourierBasis) -> Floats:
    """Return the (n,) row sums of B."""
    return np.asarray(basis.mass.sum(axis=1), dtype=np.float64).ravel()


def total_mass(basis: FourierBasis) -> float:
    """Return <1, 1>_B: the area of the surface with area masses."""
    return float(basis.mass.sum())
