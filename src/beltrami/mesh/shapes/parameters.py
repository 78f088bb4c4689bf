"""Checks of the parameters of shapes."""

from __future__ import annotations

import math
from numbers import Real

import numpy as np

from beltrami._arrays import Floats
from beltrami._arrays import whole as whole
from beltrami.errors import MeshError, shown


def positive(name: str, value: float) -> float:
    """Return a finite positive length.

    Raises
    ------
    MeshError
        If it is zero, negative, infinite, or NaN.

    Examples
    --------
    >>> positive("radius", 2)
    2.0
    """
    if not (isinstance(value, Real) and math.isfinite(value) and value > 0):
        raise MeshError(f"{name} is {shown(value)} where a positive finite number is needed")
    return float(value)


def flat(points: Floats, dimension: int) -> Floats:
    """Return planar points (n, 2) with two coordinates, or three of which the last is 0.

    Raises
    ------
    MeshError
        If ``dimension`` is neither 2 nor 3.

    Examples
    --------
    >>> import numpy as np
    >>> flat(np.ones((1, 2)), 3).tolist()
    [[1.0, 1.0, 0.0]]
    """
    if np.ndim(dimension) or dimension not in (2, 3):
        raise MeshError(f"dimension is {shown(dimension)} where 2 or 3 is needed")
    return points if dimension == 2 else np.column_stack([points, np.zeros(len(points))])
