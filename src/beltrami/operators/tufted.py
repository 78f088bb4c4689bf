"""Tufted Laplacians of points, through robust_laplacian."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import csr_array, triu

from beltrami._arrays import Floats, read_only
from beltrami._optional import require
from beltrami.errors import BeltramiError, DimensionError, MeshError, check_name
from beltrami.mesh.edge_matrix import laplacian_matrix
from beltrami.operators.areas import diagonal_matrix
from beltrami.operators.pair import Laplacian

TUFTED_MASSES = ("barycentric", "degree", "unit")


def cloud_laplacian(points: Floats, n_neighbors: int, mass: str | None) -> Laplacian:
    """Make the tufted pair of the triangles that each point makes with its neighbours."""
    kind = _checked_mass(mass)
    robust = _robust_laplacian()
    positions = _in_space(points)
    make = lambda: robust.point_cloud_laplacian(positions, n_neighbors=n_neighbors)  # noqa: E731
    return _pair(make, len(points), kind)


def _checked_mass(mass: str | None) -> str:
    given = "barycentric" if mass is None else mass
    return check_name("mass of a tufted Laplacian", given, TUFTED_MASSES)


def _robust_laplacian() -> Any:
    return require("robust_laplacian", "robust", 'weights="tufted"')


def _in_space(positions: Floats) -> Floats:
    """Return a copy in R³."""
    n, d = positions.shape
    if d > 3:
        raise DimensionError(f"tufted weights need positions with 2 or 3 coordinates, not {d}")
    return np.concatenate([positions, np.zeros((n, 3 - d))], axis=1)


def _pair(make: Any, n: int, kind: str) -> Laplacian:
    """Turn what robust_laplacian returns, a stiffness with ½ and lumped areas, into a pair."""
    try:
        stiffness, areas = make()
    except RuntimeError as cause:
        raise BeltramiError(f"robust_laplacian found no tufted Laplacian: {cause}") from cause
    upper = triu(csr_array(stiffness), 1).tocsr()
    upper.sum_duplicates()
    upper.sort_indices()
    rows = np.repeat(np.arange(n), np.diff(upper.indptr))
    edges = read_only(np.stack([rows, upper.indices.astype(np.int64)], axis=1))
    edge_weight = read_only(-upper.data.astype(np.float64))
    matrix = laplacian_matrix(edges, edge_weight, n)
    masses = {
        "barycentric": areas.diagonal(), "degree": matrix.diagonal(), "unit": np.ones(n)
    }[kind]  # fmt: skip
    if not (np.isfinite(edge_weight).all() and (masses > 0).all()):
        raise MeshError(
            "the tufted Laplacian has vertices without a positive mass",
            vertices=np.flatnonzero(~(masses > 0)),
        )
    # no domain: these edges are not those of the mesh, so bounds go by them and not by its faces
    return Laplacian(matrix, diagonal_matrix(masses), edges, edge_weight, "tufted", kind)
