"""Signature: functions on the vertices that a spectrum makes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from beltrami._arrays import Floats, read_only
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
