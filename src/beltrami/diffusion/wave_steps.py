"""Waves in steps: M u'' = b - K u on the free vertices, state by state."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from beltrami._arrays import Floats
from beltrami.diffusion.heat_steps import mass_division, shifted_factor
from beltrami.diffusion.held import FreePart

_SAME = 1e-9  # of a step: what rounding makes of times that are meant to be equal


def leapfrog_states(
    part: FreePart, u: Floats, v: Floats, load: Floats, times: Floats, step: float
) -> Iterator[Floats]:
    """Yield u at each time; steps of one length, and a part of one to a time between two steps.

    With the velocities this is the chapter's recursion for u alone, with the start that makes it
    of second order (E58): u' = u + δ v + (δ²/2) a, v' = v + (δ/2) (a + a').

    Examples
    --------
    >>> from beltrami.diffusion.held import free_part
    >>> from scipy.sparse import csr_array
    >>> L, B = csr_array([[1.0, -1.0], [-1.0, 1.0]]), csr_array(np.eye(2))
    >>> part = free_part(L, B, np.zeros(2, bool))
    >>> u, nothing = np.array([1.0, -1.0]), np.zeros(2)
    >>> [round(float(w[0]), 3) for w in
    ...  leapfrog_states(part, u, nothing, nothing, np.array([0, 0.5, 1, 1.25]), 0.5)]
    [1.0, 0.75, 0.125, -0.211]
    """
    divide = mass_division(part, u.ndim)
    a = divide(load - part.stiffness @ u)
    done = 0
    for time in times:
        for _ in range(math.floor(time / step + _SAME) - done):
            v = v + (step / 2) * a
            u = u + step * v
            a = divide(load - part.stiffness @ u)
            v = v + (step / 2) * a
            done += 1
        rest = time - done * step
        yield u.copy() if rest <= _SAME * step else u + rest * v + (rest**2 / 2) * a


def implicit_states(
    part: FreePart, u: Floats, v: Floats, load: Floats, times: Floats, step: float
) -> Iterator[Floats]:
    """Yield u at each time; between two times, the fewest equal steps that are not longer.

    The trapezoidal rule for (u, v), Newmark's scheme with β = 1/4 and γ = 1/2: the middle w of a
    step, u' = 2 w - u, solves (M + (δ²/4) K) w = M (u + (δ/2) v) + (δ²/4) b.

    Examples
    --------
    >>> from beltrami.diffusion.held import free_part
    >>> from scipy.sparse import csr_array
    >>> L, B = csr_array([[1.0, -1.0], [-1.0, 1.0]]), csr_array(np.eye(2))
    >>> part = free_part(L, B, np.zeros(2, bool))
    >>> u, nothing = np.array([1.0, -1.0]), np.zeros(2)
    >>> [round(float(w[0]), 3) for w in
    ...  implicit_states(part, u, nothing, nothing, np.array([0, 0.5, 1]), 0.5)]
    [1.0, 0.778, 0.21]
    """
    gaps = np.diff(times, prepend=0.0)
    counts = np.maximum(np.ceil(gaps / step - _SAME), 0).astype(np.int64)
    lengths = gaps / np.maximum(counts, 1)
    delta = float(lengths[counts > 0][0]) if counts.any() else step
    factor = shifted_factor(part, delta**2 / 4)
    for count, length in zip(counts.tolist(), lengths.tolist(), strict=True):
        if count and abs(length - delta) > _SAME * delta:
            delta, factor = length, shifted_factor(part, length**2 / 4)
        for _ in range(count):
            force = load - part.stiffness @ u
            half = factor.solve((delta / 2) * (part.mass @ v) + (delta**2 / 4) * force)
            u, v = u + 2 * half, 4 * half / delta - v
        yield u.copy()
