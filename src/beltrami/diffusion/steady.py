"""The state at rest: K u = b on the free vertices, whatever floats with mean zero."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats
from beltrami.diffusion.held import FreePart
from beltrami.solvers.factorize import factorize


def steady_state(part: FreePart, load: Floats) -> Floats:
    """Solve K u = b for a b that adds to zero over each component that floats.

    There K is singular: one vertex of each is pinned, and then the mean of the mass subtracted.
    Cost: one factorisation, one solve.

    Examples
    --------
    >>> from beltrami.diffusion.held import free_part
    >>> L = csr_array([[1.0, -1, 0], [-1, 2, -1], [0, -1, 1]])
    >>> part = free_part(L, csr_array(np.eye(3)), np.zeros(3, bool))
    >>> steady_state(part, np.array([1.0, 0, -1])).round(12).tolist()
    [1.0, 0.0, -1.0]
    """
    kept = np.ones(len(load), np.bool_)
    kept[part.pins] = False
    u = np.zeros_like(load)
    if kept.any() and load.any():
        matrix = csr_array(part.stiffness[kept][:, kept])
        positions = None if part.positions is None else part.positions[kept]
        u[kept] = factorize(matrix, positions).solve(load[kept])
    return part.centred(u)
