"""The order of elimination: by positions where they are known, else by the graph of the matrix."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csc_array

from beltrami._arrays import Floats, rectangular, require_finite
from beltrami.errors import BeltramiError, DimensionError
from beltrami.solvers.dissection import dissect
from beltrami.solvers.elimination import Elimination, eliminate

ORDERINGS = ("auto", "positions", "graph")
_USUAL = 8  # times n log2 n: what the squares of the blocks of a surface do not reach


def order(matrix: csc_array, positions: Floats | None, ordering: str) -> Elimination:
    """Order a matrix with symmetric pattern, and find the shape of its factor.

    ``"auto"`` takes positions if there are any; where they do not cut well (unknowns that lie far
    from their neighbours in the matrix) it tries the graph too, and takes the better.

    The positions are those of ``as_positions``.

    Raises
    ------
    BeltramiError
        If the ordering is by positions, and there are none.
    """
    indptr, indices = matrix.indptr.astype(np.int64), matrix.indices.astype(np.int32)
    n = len(indptr) - 1
    if ordering == "positions" and positions is None:
        raise BeltramiError('the ordering "positions" needs coordinates')
    if ordering == "graph" or positions is None:
        return eliminate(indptr, indices, dissect(indptr, indices, None))
    found = dissect(indptr, indices, positions)
    if ordering == "auto" and found.squares > _USUAL * n * np.log2(n + 1):
        other = dissect(indptr, indices, None)
        found = other if other.squares < found.squares else found
    return eliminate(indptr, indices, found)


def as_positions(coordinates: ArrayLike, n: int) -> Floats:
    """Return (n, 3) positions of size 1: of d > 3 axes the three longest, of d < 3 all.

    Raises
    ------
    DimensionError, NonFiniteError
        If coordinates are not (n, d) finite numbers.
    """
    given = rectangular(coordinates)
    if given.ndim != 2 or len(given) != n or given.shape[1] < 1:
        raise DimensionError(f"coordinates have the shape {given.shape} where ({n}, d) is needed")
    require_finite(given, "the coordinates")
    x = given.astype(np.float64)
    x /= np.abs(x).max() or 1.0
    x -= x.mean(axis=0)
    if x.shape[1] > 3:
        x = x @ np.linalg.eigh(x.T @ x)[1][:, -3:]
    return np.ascontiguousarray(np.pad(x, ((0, 0), (0, 3 - x.shape[1]))))
