"""Sharp edges and the boundary, along which a mesh is smoothed and not across."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Booleans, Floats
from beltrami.errors import BeltramiError
from beltrami.mesh.edge_matrix import symmetric_matrix
from beltrami.mesh.mesh import Mesh
from beltrami.operators.areas import diagonal_matrix


def feature_edges(mesh: Mesh, angle: float) -> Booleans:
    """(p,) bool: edges whose faces' normals differ by more than ``angle`` degrees, or have no pair.

    Edges of one face, or of more than two, are features. Faces that disagree about the outside
    are compared as if they agreed; one without an area has no normal, and makes no features. In
    the plane the boundary alone is one.

    Raises
    ------
    BeltramiError
        If the angle is not between 0 and 180.

    Examples
    --------
    >>> from beltrami.mesh.shapes import cube
    >>> box = cube(3)
    >>> int(feature_edges(box, 45).sum())  # twelve edges of three sides each
    36
    """
    if not 0 < angle < 180:
        raise BeltramiError(f"the angle of features must be between 0 and 180, not {angle}")
    sides = mesh.topology.face_edges.ravel()
    count = np.bincount(sides, minlength=mesh.topology.n_edges)
    feature = np.ones(len(count), np.bool_)
    feature[count == 2] = False
    if mesh.dimension == 2:
        return feature
    pair = np.flatnonzero(~feature)
    first = np.concatenate([[0], np.cumsum(count)[:-1]])[pair]
    order = np.argsort(sides, kind="stable")
    left, right = order[first], order[first + 1]
    # side c of a face runs from corner c + 1 to corner c + 2
    forward = (np.roll(mesh.faces, -1, axis=1) < np.roll(mesh.faces, -2, axis=1)).ravel()
    normals = mesh.face_normals
    cosine = np.einsum("ij,ij->i", normals[left // 3], normals[right // 3])
    cosine[forward[left] == forward[right]] *= -1
    flat = np.linalg.norm(normals, axis=1) == 0
    cosine[flat[left // 3] | flat[right // 3]] = 1
    feature[pair] = cosine < np.cos(np.radians(angle))
    return feature


def weights_along(mesh: Mesh, edge_weight: Floats, feature: Booleans) -> tuple[csr_array, Booleans]:
    """Return the weights by which each vertex looks at its neighbours, and the corners.

    A vertex with two feature edges looks along them alone. One with a single one or more than two
    is a corner, and stays. The others look at all their neighbours; so the matrix is not
    symmetric.

    Returns
    -------
    (n, n) csr_array of weights, and (n,) bool: the corners.
    """
    topology = mesh.topology
    edges = topology.edges
    number = np.bincount(edges[feature].ravel(), minlength=mesh.n_vertices)
    W = symmetric_matrix(edges, edge_weight, mesh.n_vertices)
    along = symmetric_matrix(edges[feature], edge_weight[feature], mesh.n_vertices)
    off = number > 0
    away = diagonal_matrix(np.where(off, 0.0, 1.0)) @ W
    away.eliminate_zeros()
    return csr_array(away + along), (number == 1) | (number > 2)
