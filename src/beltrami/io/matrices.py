"""Sparse matrices as named arrays in a file, and back, checked."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from beltrami._arrays import Floats


def matrix_arrays(name: str, matrix: csr_array) -> dict[str, NDArray[Any]]:
    """Return the three arrays of a matrix: its numbers, their columns, and the starts of rows.

    Examples
    --------
    >>> sorted(matrix_arrays("mass", csr_array(np.eye(2))))
    ['mass', 'mass_columns', 'mass_starts']
    """
    return {name: matrix.data, f"{name}_columns": matrix.indices, f"{name}_starts": matrix.indptr}


def matrix_from(arrays: Mapping[str, NDArray[Any]], name: str, shape: tuple[int, int]) -> csr_array:
    """Return the matrix of three arrays.

    Raises
    ------
    LookupError
        If one of them is missing.
    ValueError
        If they do not make a matrix of this shape, with ascending columns and finite numbers.
    """
    data, starts = finite_floats(arrays[name]), arrays[f"{name}_starts"]
    columns = arrays[f"{name}_columns"]
    if data.ndim != 1 or columns.shape != data.shape or starts.shape != (shape[0] + 1,):
        raise ValueError(f"the {name} has other shapes")
    if starts.dtype.kind != "i" or columns.dtype.kind != "i":
        raise ValueError(f"the indices of the {name} are no integers")
    steps = np.diff(starts)
    if starts[0] != 0 or starts[-1] != len(data) or (steps < 0).any():
        raise ValueError(f"the rows of the {name} are out of order")
    follows = np.diff(columns, prepend=-1) > 0
    follows[starts[:-1][steps > 0]] = True  # the first of each row
    if not (follows & (columns >= 0) & (columns < shape[1])).all():
        raise ValueError(f"the columns of the {name} are out of order")
    return csr_array((data, columns, starts), shape)


def finite_floats(array: NDArray[Any]) -> Floats:
    """Return the array if it is one of finite float64; ValueError if not."""
    if array.dtype != np.float64:
        raise ValueError(f"numbers of the type {array.dtype}")
    if not np.isfinite(array).all():
        raise ValueError("numbers that are NaN or infinite")
    return array
