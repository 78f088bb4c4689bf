"""Is a list of eigenvalues complete? Sylvester's law of inertia counts them without computing."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from beltrami._arrays import Floats
from beltrami.errors import SingularMatrixError
from beltrami.solvers.ldl import factorize_ldl
from beltrami.solvers.pencil import Pencil

_CLEAR = 10.0  # times what is not known about two neighbours, for a gap to count in


class Census(NamedTuple):
    """``there`` eigenvalues are nearer than ``radius`` to a number; ``found`` are listed."""

    radius: float
    there: int
    found: int


def count_below(pencil: Pencil, shift: float) -> int:
    """Count the eigenvalues below a shift: the number of negative pivots of L - σB.

    Raises
    ------
    SingularMatrixError
        If the shift is an eigenvalue, to working precision.
    """
    return factorize_ldl(pencil.shifted(shift), pencil.elimination).inertia[1]


def census(
    pencil: Pencil, values: Floats, doubts: Floats, near: float, k: int, definite: bool
) -> Census:
    """Count the eigenvalues that are as near to ``near`` as the k nearest of a list.

    It is done in a gap that is wide beside the ``doubts`` (the largest errors of the values): that
    beyond the k-th, or the last one before it, or else the first one after it. ``definite``: no
    eigenvalue is below ``near``.

    Raises
    ------
    SingularMatrixError
        If there is no such gap, or all tries meet an eigenvalue.
    """
    order = np.argsort(np.abs(values - near), kind="stable")
    distance, doubt = np.abs(values - near)[order], doubts[order]
    distance, doubt = np.concatenate([[0.0], distance]), np.concatenate([[0.0], doubt])
    last = min(k, len(values) - 1)
    for i in (*range(last, -1, -1), *range(last + 1, len(values))):
        gap = distance[i + 1] - distance[i]
        if not gap > _CLEAR * (doubt[i + 1] + doubt[i]):
            continue
        for part in (0.5, 0.4, 0.65):
            radius = float(distance[i] + part * gap)
            try:
                there = count_below(pencil, near + radius)
                there -= 0 if definite else count_below(pencil, near - radius)
            except SingularMatrixError:
                continue
            return Census(radius, there, i)
    raise SingularMatrixError("there is no gap between the eigenvalues to count in")
