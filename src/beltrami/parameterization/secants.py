"""Secants: what steps have shown of a Hessian corrects directions of a factor that is kept."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from beltrami._arrays import Floats

Secant = tuple[Floats, Floats]


def secant(step: Floats, change: Floats) -> Secant | None:
    """Return a step and the change of the gradient along it; None where they do not point alike.

    Only curvature that is clearly positive keeps the metric of ``descent`` definite.
    """
    along = float(step @ change)
    enough = 1e-10 * np.linalg.norm(step) * np.linalg.norm(change)
    return (step, change) if along > enough else None


def descent(
    gradient: Floats, secants: Sequence[Secant], solve: Callable[[Floats], Floats]
) -> Floats:
    r"""Return :math:`-B^{-1} g`, where B maps each step to the change of the gradient seen there.

    B is what the updates of Broyden, Fletcher, Goldfarb and Shanno make of the matrix that
    ``solve`` solves with, the oldest secant first (J. Nocedal, Updating quasi-Newton matrices
    with limited storage, 1980). With a definite matrix it is definite, so that the direction goes
    down. Cost: one solve, and two products for each secant.

    Examples
    --------
    >>> A = np.diag([1.0, 4.0])
    >>> step = np.array([0.0, 1.0])
    >>> descent(np.array([2.0, 8.0]), [(step, A @ step)], lambda r: r).tolist()
    [-2.0, -2.0]
    """
    rest = -gradient
    shares = []
    for step, change in reversed(secants):
        shares.append(float(step @ rest) / float(step @ change))
        rest = rest - shares[-1] * change
    direction = solve(rest)
    for (step, change), share in zip(secants, reversed(shares), strict=True):
        direction = direction + (share - float(change @ direction) / float(step @ change)) * step
    return direction
