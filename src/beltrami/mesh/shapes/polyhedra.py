"""Polyhedra: the cube, with any number of squares on its sides, the tetrahedron, the octahedron."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Integers
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes.lattice import lattice_faces
from beltrami.mesh.shapes.parameters import positive, whole


def cube(subdivisions: int = 1, size: float = 1.0) -> Mesh:
    """Mesh a cube around the origin, its sides sharing the vertices of the edges.

    Parameters
    ----------
    subdivisions
        s, 1 or more: s^2 squares on each side, n = 6 s^2 + 2, m = 12 s^2.
    size
        The length of an edge.

    Returns
    -------
    Mesh
        Closed, oriented outward; vertices in lexicographic order of (x, y, z).

    Raises
    ------
    MeshError
        If a parameter is out of range.

    Examples
    --------
    >>> cube().n_vertices, cube().n_faces, cube(2).n_vertices
    (8, 12, 26)
    """
    s, size = whole("subdivisions", subdivisions, least=1), positive("size", size)
    row, column = np.divmod(np.arange((s + 1) ** 2), s + 1)
    points: list[Integers] = []
    faces: list[Integers] = []
    for axis in range(3):
        for end, (u, v) in ((0, (column, row)), (s, (row, column))):
            point = np.empty((len(row), 3), dtype=np.int64)
            point[:, axis] = end
            point[:, (axis + 1) % 3] = v
            point[:, (axis + 2) % 3] = u
            faces.append(lattice_faces(s, s) + len(row) * len(points))
            points.append(point)
    keys = np.concatenate(points) @ np.array([(s + 1) ** 2, s + 1, 1])
    kept, number = np.unique(keys, return_inverse=True)
    corners = np.stack(np.unravel_index(kept, (s + 1,) * 3), axis=1)
    return Mesh(size * (corners / s - 0.5), number.ravel()[np.concatenate(faces)])


def tetrahedron(radius: float = 1.0) -> Mesh:
    """Mesh a regular tetrahedron: 4 vertices at this distance from the origin, 4 faces.

    Raises
    ------
    MeshError
        If the radius is not positive.

    Examples
    --------
    >>> tetrahedron(3**0.5).vertices.round(12).tolist()
    [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]]
    """
    corners = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    return Mesh(positive("radius", radius) * corners / np.sqrt(3), faces)


def octahedron(radius: float = 1.0) -> Mesh:
    """Mesh a regular octahedron: 6 vertices on the axes at this distance, 8 faces.

    Raises
    ------
    MeshError
        If the radius is not positive.

    Examples
    --------
    >>> octahedron().n_vertices, octahedron().n_faces
    (6, 8)
    """
    corners = np.concatenate([np.eye(3), -np.eye(3)])
    upper = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2]]
    lower = [[1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    return Mesh(positive("radius", radius) * corners, upper + lower)
