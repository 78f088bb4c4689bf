"""Checks of the parameters of shapes."""

from __future__ import annotations

import math
import operator

import numpy as np

from beltrami._arrays import Floats
from beltrami.errors import MeshError


def whole(name: str, value: int, least: int) -> int:
    """Return a whole number that is at least ``least``.

    Raises
    ------
    MeshError
        If it is not an integer, or too small.

    Examples
    --------
    >>> whole("nx", 4, least=1)
    4
    """
    try:
        number = operator.index(value)
    except TypeError:
        raise MeshError(f"{name} is {value!r} where a whole number is needed") from None
    if number < least:
        raise MeshError(f"{name} is {number} where {least} or more is needed")
    return number


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
    length = float(value)
    if not (math.isfinite(length) and length > 0):
        raise MeshError(f"{name} is {value!r} where a positive finite number is needed")
    return length


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
    if dimension not in (2, 3):
        raise MeshError(f"dimension is {dimension!r} where 2 or 3 is needed")
    return points if dimension == 2 else np.column_stack([points, np.zeros(len(points))])
