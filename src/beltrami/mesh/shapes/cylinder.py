"""The cylinder: an open tube, or a closed can."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._kinds import checked
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes.concentric import disk_faces, ring_points
from beltrami.mesh.shapes.lattice import lattice_faces
from beltrami.mesh.shapes.parameters import positive, whole


@checked
def cylinder(
    n_around: int = 32,
    n_along: int = 10,
    radius: float = 1.0,
    height: float = 2.0,
    *,
    caps: bool = False,
) -> Mesh:
    """Mesh a cylinder around the z axis, from -height/2 to height/2.

    Parameters
    ----------
    n_around
        How many vertices around the axis, 3 or more.
    n_along
        How many bands along the axis, 1 or more.
    radius, height
        The area of the side tends to 2 pi radius height.
    caps
        Close both ends by disks of concentric rings; otherwise the ends are two boundary loops.

    Returns
    -------
    Mesh
        Vertex i + j n_around is at the angle 2 pi i / n_around in ring j from below; the
        vertices of the lower, then of the upper cap follow, each from its centre outward.

    Raises
    ------
    MeshError
        If a parameter is out of range.

    Examples
    --------
    >>> cylinder(6, 1).n_vertices, cylinder(6, 1, caps=True).n_vertices
    (12, 14)
    """
    n_around, n_along = whole("n_around", n_around, least=3), whole("n_along", n_along, least=1)
    radius, height = positive("radius", radius), positive("height", height)
    circle = ring_points([n_around], [radius])
    levels = np.linspace(-height / 2, height / 2, n_along + 1)
    vertices = np.column_stack([np.tile(circle, (n_along + 1, 1)), np.repeat(levels, n_around)])
    faces = lattice_faces(n_along, n_around, ring=(False, True))
    if caps:
        points, numbers = _cap_rings(n_around, radius)
        n, rim = len(vertices), np.arange(n_around)
        below = disk_faces([*(n + ring for ring in numbers), rim])[:, ::-1]
        top = [n + len(points) + ring for ring in numbers]
        above = disk_faces([*top, n_along * n_around + rim])
        ends = [np.column_stack([points, np.full(len(points), z)]) for z in levels[[0, -1]]]
        vertices = np.concatenate([vertices, *ends])
        faces = np.concatenate([faces, below, above])
    return Mesh(vertices, faces)


def _cap_rings(n_around: int, radius: float) -> tuple[Floats, list[Integers]]:
    """Return the points of a cap inside its rim, and their numbers ring by ring.

    The rings are as far apart as their vertices, so that the triangles are nearly equilateral.
    """
    rings = max(1, round(n_around / 6))
    counts = [1, *(max(3, round(n_around * k / rings)) for k in range(1, rings))]
    points = ring_points(counts, [radius * k / rings for k in range(rings)])
    return points, np.split(np.arange(len(points)), np.cumsum(counts)[:-1])
