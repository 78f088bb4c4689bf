"""PointCloud: positions without faces, as a domain."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import cKDTree

from beltrami._arrays import Floats, frozen
from beltrami._frozen import Frozen
from beltrami.errors import MeshError, check_name
from beltrami.operators.laplacian import laplacian
from beltrami.operators.neighbours import GRAPH_WEIGHTS, as_points, checked_number, knn_graph
from beltrami.operators.pair import Laplacian
from beltrami.operators.tufted import cloud_laplacian

CLOUD_WEIGHTS = (*GRAPH_WEIGHTS, "tufted")


class PointCloud(Frozen):
    """Points of a surface whose faces are not known; ``laplacian`` takes it as a domain.

    Weights are ``"combinatorial"`` (default), ``"distance"`` or ``"gaussian"``, on the graph of
    the nearest neighbours (``knn_graph``) with the mass ``"degree"`` (default) or ``"unit"``; or
    ``"tufted"``, which sees the surface: 〈Lf, f〉 is about the Dirichlet energy, and the masses
    (``"barycentric"``, default, or the same two) are areas. Tufted weights want the extra
    ``robust`` and 2 or 3 coordinates (N. Sharp and K. Crane, 2020).

    Chapter items: P4, P7.

    Parameters
    ----------
    points
        (n, d) positions.
    n_neighbors
        Number of neighbours of each point, below n; 30 suits tufted weights.

    Raises
    ------
    DimensionError, NonFiniteError
        If the points are no (n, d) array of finite numbers.
    MeshError
        If the number of neighbours is no integer in 1..n-1.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> cloud = PointCloud(icosphere(2).vertices, n_neighbors=8)
    >>> cloud
    <PointCloud: 162 points in 3 coordinates, 8 neighbours>
    >>> laplacian(cloud, "gaussian", "unit")
    <Laplacian: 162 vertices, gaussian weights, unit mass, positive semi-definite>
    """

    points: Floats
    n_neighbors: int

    def __init__(self, points: ArrayLike, n_neighbors: int = 30) -> None:
        positions = frozen(as_points(points), np.float64)
        k = checked_number(n_neighbors, len(positions))
        self.__dict__.update(points=positions, n_neighbors=k)

    def __reduce__(self) -> Any:
        return PointCloud, (self.points, self.n_neighbors)

    def __repr__(self) -> str:
        n, d = self.points.shape
        return f"<PointCloud: {n} points in {d} coordinates, {self.n_neighbors} neighbours>"

    def make_laplacian(self, weights: str | None, mass: str | None) -> Laplacian:
        """Make the pair; see the class for the names, and ``laplacian`` for what is raised."""
        kind = check_name(
            "weights of points", "combinatorial" if weights is None else weights, CLOUD_WEIGHTS
        )
        if kind == "tufted":
            self._refuse_coincident()
            return cloud_laplacian(self.points, self.n_neighbors, mass)
        pair = laplacian(knn_graph(self.points, self.n_neighbors, kind), mass=mass)
        return Laplacian(
            pair.stiffness, pair.mass, pair.edges, pair.edge_weight, kind, pair.mass_kind
        )

    def _refuse_coincident(self) -> None:
        nearest = np.asarray(cKDTree(self.points).query(self.points, 2)[0])[:, 1]
        if (nearest == 0).any():
            raise MeshError(
                "tufted weights need points that do not coincide",
                vertices=np.flatnonzero(nearest == 0),
                remedy="Keep one of each: numpy.unique(points, axis=0).",
            )
