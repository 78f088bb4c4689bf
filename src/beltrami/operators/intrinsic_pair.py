"""The pair (L, B) of an intrinsic triangulation."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from beltrami._arrays import Floats, Integers, read_only
from beltrami.errors import check_name
from beltrami.mesh.edge_matrix import laplacian_matrix, symmetric_matrix
from beltrami.operators.areas import diagonal_matrix
from beltrami.operators.flips import ROUNDING
from beltrami.operators.intrinsic import IntrinsicTriangulation
from beltrami.operators.intrinsic_parts import corner_masses
from beltrami.operators.pair import INTRINSIC, MASSES, TUFTED, Laplacian


def intrinsic_laplacian(triangles: IntrinsicTriangulation, mass: str | None = None) -> Laplacian:
    """Make the pair (L, B) of the intrinsic triangles: cotangent weights with ½, and their masses.

    Edges that join the same two vertices are summed into one; an edge from a vertex to itself
    gives nothing to L. Weights of inner edges that are negative by rounding alone are zero.

    Raises
    ------
    UnknownNameError
        If there is no such mass.
    """
    kind = check_name("mass", "voronoi" if mass is None else mass, MASSES)
    n = triangles.n_vertices
    edges, weights = _merged(*_ends(triangles), _edge_weights(triangles), n)
    stiffness = laplacian_matrix(edges, weights, n)
    masses = _mass_matrix(triangles, stiffness, kind)
    name = INTRINSIC if triangles.sheets == 1 else TUFTED
    return Laplacian(stiffness, masses, edges, weights, name, kind, triangles)


def _mass_matrix(triangles: IntrinsicTriangulation, stiffness: csr_array, kind: str) -> csr_array:
    n = triangles.n_vertices
    if kind == "unit":
        return diagonal_matrix(np.ones(n))
    if kind == "degree":
        return diagonal_matrix(stiffness.diagonal())
    if kind == "consistent":
        return _consistent_mass(triangles)
    parts = corner_masses(triangles, np.zeros(0), kind)
    return diagonal_matrix(_summed(triangles.faces.ravel(), parts.ravel(), n))


def _consistent_mass(triangles: IntrinsicTriangulation) -> csr_array:
    """Return ∫ φ_i φ_j; a side from i to itself adds twice its A/12 to the diagonal."""
    n = triangles.n_vertices
    twelfth = np.repeat(triangles.area_parts / 12, 3)
    diagonal = _summed(triangles.faces.ravel(), 2 * twelfth, n)
    start, end = (np.roll(triangles.faces, -k, axis=1).ravel() for k in (1, 2))
    loops = start == end
    diagonal += _summed(start[loops], 2 * twelfth[loops], n)
    edges, values = _merged(np.minimum(start, end), np.maximum(start, end), twelfth, n)
    return symmetric_matrix(edges, values, n, diagonal)


def _edge_weights(triangles: IntrinsicTriangulation) -> Floats:
    """Return the weight of each edge; what is negative by rounding alone is zero."""
    halves, numbers = triangles.half_cotangents.ravel(), triangles.side_edges.ravel()
    p = int(numbers.max()) + 1
    weights = _summed(numbers, halves, p)
    noise = ROUNDING * (1 + _summed(numbers, np.abs(halves), p))
    inner = triangles.twins.ravel() >= 0
    paired = np.zeros(p, np.bool_)
    paired[numbers[inner]] = True
    weights[paired & (weights < 0) & (weights >= -noise)] = 0
    return weights


def _ends(triangles: IntrinsicTriangulation) -> tuple[Integers, Integers]:
    """Return the smaller and the larger vertex of each edge."""
    numbers = triangles.side_edges.ravel()
    start, end = (np.roll(triangles.faces, -k, axis=1).ravel() for k in (1, 2))
    low, high = np.empty((2, int(numbers.max()) + 1), np.int64)
    low[numbers], high[numbers] = np.minimum(start, end), np.maximum(start, end)
    return low, high


def _merged(low: Integers, high: Integers, values: Floats, n: int) -> tuple[Integers, Floats]:
    """Sum values on equal pairs low < high, and drop low = high; sorted pairs, each once."""
    proper = low != high
    keys = low[proper] * n + high[proper]
    order = np.argsort(keys, kind="stable")
    keys = keys[order]
    first = np.flatnonzero(np.concatenate([[True], keys[1:] != keys[:-1]]))
    sums = np.add.reduceat(values[proper][order], first)
    edges = np.stack(np.divmod(keys[first], n), axis=1)
    return read_only(edges), read_only(sums)


def _summed(numbers: NDArray[Any], values: Floats, n: int) -> Floats:
    """Sum the values of each number 0..n-1."""
    return np.asarray(np.bincount(numbers, values, n), np.float64)
