"""The disk: concentric rings of nearly equilateral triangles."""

from __future__ import annotations

import numpy as np

from beltrami._kinds import checked
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes.concentric import disk_faces, ring_points
from beltrami.mesh.shapes.parameters import flat, positive, whole


@checked
def disk(rings: int = 10, radius: float = 1.0, *, dimension: int = 2) -> Mesh:
    """Mesh a flat disk by rings of 6, 12, 18, ... vertices around its centre.

    Parameters
    ----------
    rings
        How many, 1 or more: n = 1 + 3 rings (rings + 1), m = 6 rings^2. The area tends to
        pi radius^2 as 1 / rings^2.
    radius
        Of the circle on which the boundary vertices are.
    dimension
        2 for vertices (x, y), 3 for (x, y, 0).

    Returns
    -------
    Mesh
        Vertex 0 is the centre, rings follow from the inside, each counter-clockwise from the x
        axis; a turn by 60 degrees maps the mesh to itself.

    Raises
    ------
    MeshError
        If a parameter is out of range.

    Examples
    --------
    >>> disk(2).n_vertices, disk(2).n_faces
    (19, 24)
    """
    rings, radius = whole("rings", rings, least=1), positive("radius", radius)
    counts = [1, *(6 * k for k in range(1, rings + 1))]
    points = ring_points(counts, [radius * k / rings for k in range(rings + 1)])
    numbers = np.split(np.arange(len(points)), np.cumsum(counts)[:-1])
    return Mesh(flat(points, dimension), disk_faces(numbers))
