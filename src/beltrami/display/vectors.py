"""Single vectors of space: checked, and brought to length one."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_floats, as_function, frozen
from beltrami.errors import DimensionError


def as_vector(vector: ArrayLike, what: str) -> Floats:
    """Check one vector of space and freeze it.

    Raises
    ------
    DimensionError
        If it has not the shape (3,).
    NonFiniteError
        If a coordinate is NaN or infinite.

    Examples
    --------
    >>> as_vector([1, 2, 3], "the target").tolist()
    [1.0, 2.0, 3.0]
    """
    values = as_floats(vector)
    if values.shape != (3,):
        raise DimensionError(f"{what} has the shape {values.shape} where (3,) is needed")
    return frozen(as_function(values, 3, what), np.float64)


def as_points(points: ArrayLike, what: str) -> Floats:
    """Check points of space, (n, 3).

    Raises
    ------
    DimensionError
        If they have not the shape (n, 3).
    NonFiniteError
        If a coordinate is NaN or infinite.
    """
    values = as_floats(points)
    if values.ndim != 2 or values.shape[1] != 3:
        raise DimensionError(f"{what} have the shape {values.shape} where (n, 3) is needed")
    return as_function(values, len(values), what)


def unit_vector(vector: Floats) -> Floats:
    """Divide by the length, whatever the unit; the vector zero stays zero.

    Examples
    --------
    >>> unit_vector(np.array([0.0, 3e-200, 4e-200])).round(12).tolist()
    [0.0, 0.6, 0.8]
    """
    scale = np.abs(vector).max()
    if scale == 0:
        return vector
    return np.asarray(vector / scale / np.linalg.norm(vector / scale))
