"""Graphs of nearest neighbours: points without faces (l. 41, 161 of the chapter)."""

from __future__ import annotations

import math
import numbers

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from beltrami._arrays import Floats, Integers, rectangular, require_finite
from beltrami.errors import DimensionError, MeshError, check_name, shown
from beltrami.mesh.edge_matrix import symmetric_matrix

GRAPH_WEIGHTS = ("combinatorial", "distance", "gaussian")
JOINS = ("either", "both")
_LEAST = 1e-150  # of the largest coordinate: smaller squares are no numbers


def knn_graph(
    points: ArrayLike,
    k: int,
    weights: str = "combinatorial",
    *,
    scale: float | None = None,
    join: str = "either",
) -> csr_array:
    r"""Join each point with its k nearest ones, and return the symmetric weights: a graph.

    ``laplacian`` makes a pair of it, with the degree or the unit mass.

    Chapter items: P4, P7, X3.

    Parameters
    ----------
    points
        (n, d) positions, in any dimension.
    k
        Number of neighbours of each point, 1 to n - 1.
    weights
        ``"combinatorial"`` 1, ``"distance"`` :math:`1/|x_i - x_j|^2`, or ``"gaussian"``
        :math:`\exp(-|x_i - x_j|^2 / 2\sigma^2)`.
    scale
        σ of the gaussian, a length: by default the mean length of the edges.
    join
        Two points are joined where ``"either"`` is among the k nearest of the other, or
        ``"both"`` are. With "both" a point may be left alone.

    Returns
    -------
    (n, n) csr_array, symmetric, zero diagonal.

    Raises
    ------
    DimensionError
        If the points are no (n, d) array.
    NonFiniteError
        If a coordinate is not finite; ``error.vertices`` lists the points.
    MeshError
        If k or the scale is out of range; with distance weights, if points coincide.
    UnknownNameError
        If a name is misspelt.

    Notes
    -----
    Cost: O(k n log n). Among points at equal distance the choice is that of the tree.

    Examples
    --------
    >>> W = knn_graph([[0.0], [1.0], [3.0], [10.0]], 1)
    >>> W.toarray().astype(int).tolist()
    [[0, 1, 0, 0], [1, 0, 1, 0], [0, 1, 0, 1], [0, 0, 1, 0]]
    >>> knn_graph([[0.0], [1.0], [3.0], [10.0]], 1, "distance", join="both").nnz
    2
    """
    check_name("weights of a graph of neighbours", weights, GRAPH_WEIGHTS)
    check_name("way to join neighbours", join, JOINS)
    positions = as_points(points)
    edges = _nearest(positions, k, join)
    lengths = np.linalg.norm(positions[edges[:, 0]] - positions[edges[:, 1]], axis=1)
    values = _weigh(edges, lengths, weights, scale)
    return symmetric_matrix(edges, values, len(positions))


def as_points(points: ArrayLike) -> Floats:
    """Check (n, d) finite positions."""
    positions = np.ascontiguousarray(rectangular(points), dtype=np.float64)
    if positions.ndim != 2 or not positions.size:
        raise DimensionError(f"points have the shape {positions.shape} where (n, d) is needed")
    require_finite(positions, "the cloud")
    largest = float(np.abs(positions).max())
    if largest and not _LEAST < largest < 1 / _LEAST:
        raise MeshError(
            f"coordinates of {largest:.0e} leave no room for squared distances",
            remedy="Choose another unit.",
        )
    return positions


def checked_number(k: int, n: int) -> int:
    """Return k if it is an integer in 1..n-1; 2.0 is one."""
    if not isinstance(k, numbers.Real) or not 1 <= k < n or int(k) != k:
        raise MeshError(
            f"{shown(k)} neighbours among {n} points", remedy=f"Choose an integer in 1..{n - 1}."
        )
    return int(k)


def _nearest(positions: Floats, k: int, join: str) -> Integers:
    """Return the edges i < j, sorted."""
    n, k = len(positions), checked_number(k, len(positions))
    found = np.asarray(cKDTree(positions).query(positions, k + 1)[1])
    others = found != np.arange(n)[:, None]  # where points coincide, oneself may be missing
    others[others.all(axis=1), -1] = False
    pairs = np.stack([np.repeat(np.arange(n), k), found[others]], axis=1)
    keys = np.sort(pairs, axis=1) @ np.array([n, 1])
    keys, seen = np.unique(keys, return_counts=True)
    kept = keys if join == "either" else keys[seen == 2]
    return np.stack(np.divmod(kept, n), axis=1).astype(np.int64)


def _weigh(edges: Integers, lengths: Floats, weights: str, scale: float | None) -> Floats:
    if weights != "gaussian" and scale is not None:
        raise MeshError("only gaussian weights have a scale")
    if weights == "combinatorial":
        return np.ones(len(edges))
    if weights == "distance":
        with np.errstate(divide="ignore", over="ignore"):
            values = 1 / lengths**2
        if not np.isfinite(values).all():
            raise MeshError(
                "distance weights need points that do not coincide",
                edges=edges[~np.isfinite(values)],
            )
        return values
    if scale is None and not len(edges):
        return lengths
    sigma = float(lengths.mean()) if scale is None else scale
    if not isinstance(sigma, numbers.Real) or not math.isfinite(sigma) or sigma <= 0:
        raise MeshError(f"the scale of gaussian weights is a positive length, not {shown(sigma)}")
    with np.errstate(over="ignore"):  # so far away that the weight is 0
        return np.asarray(np.exp(-((lengths / float(sigma)) ** 2) / 2))
