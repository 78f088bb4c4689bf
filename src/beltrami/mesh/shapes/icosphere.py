"""The icosphere: an icosahedron, subdivided, on the sphere."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from beltrami._arrays import Floats, Integers, read_only
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes.parameters import positive, whole
from beltrami.mesh.shapes.subdivide import split_faces, with_midpoints


def icosphere(subdivisions: int = 3, radius: float = 1.0) -> Mesh:
    """Mesh the sphere: an icosahedron whose faces are cut in four, each time projected.

    Parameters
    ----------
    subdivisions
        s, 0 or more: n = 10 4^s + 2 and m = 20 4^s.
    radius
        Of the sphere on which all vertices are. Area and volume tend to 4 pi radius^2 and
        4/3 pi radius^3 from below as 4^-s.

    Returns
    -------
    Mesh
        Closed, oriented outward; twelve vertices have five neighbours, the others six. The
        vertices of fewer subdivisions come first.

    Raises
    ------
    MeshError
        If a parameter is out of range.

    Examples
    --------
    >>> icosphere(2).n_vertices, icosphere(2).n_faces
    (162, 320)
    """
    subdivisions = whole("subdivisions", subdivisions, least=0)
    radius = positive("radius", radius)
    vertices, faces = _icosahedron()
    for _ in range(subdivisions):
        n = len(vertices)
        faces, edges = split_faces(faces, n)
        vertices = with_midpoints(vertices, edges)
        vertices[n:] /= np.linalg.norm(vertices[n:], axis=1, keepdims=True)
    return Mesh(read_only(radius * vertices), read_only(faces))


def _icosahedron() -> tuple[Floats, Integers]:
    """Put twelve vertices at (0, ±1, ±φ) and its cyclic shifts; edges are the pairs 2 apart."""
    golden = (1 + np.sqrt(5)) / 2
    corners = [(0.0, s, t * golden) for s in (1.0, -1.0) for t in (1.0, -1.0)]
    vertices = np.array([np.roll(corner, shift) for shift in range(3) for corner in corners])
    squared = ((vertices[:, None] - vertices[None]) ** 2).sum(axis=2)
    triples = np.array(list(combinations(range(12), 3)))
    sides = squared[triples, np.roll(triples, 1, axis=1)]
    faces = triples[(np.abs(sides - 4) < 0.1).all(axis=1)]
    inward = np.linalg.det(vertices[faces]) < 0
    faces[inward] = faces[inward, ::-1]
    return vertices / np.linalg.norm(vertices[0]), faces
