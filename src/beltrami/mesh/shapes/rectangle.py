"""The rectangle: a planar grid of squares cut in two."""

from __future__ import annotations

import numpy as np

from beltrami._kinds import checked
from beltrami.errors import check_name
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes.lattice import lattice_faces
from beltrami.mesh.shapes.parameters import flat, positive, whole


@checked
def grid(
    nx: int = 20,
    ny: int = 20,
    width: float = 1.0,
    height: float = 1.0,
    *,
    diagonals: str = "parallel",
    dimension: int = 2,
) -> Mesh:
    """Mesh the rectangle [0, width] x [0, height] by nx times ny rectangles, each cut in two.

    Parameters
    ----------
    nx, ny
        The numbers of squares along x and y, 1 or more: n = (nx + 1) (ny + 1), m = 2 nx ny.
    width, height
        The lengths of the sides.
    diagonals
        ``"parallel"``: all from the lower left to the upper right; ``"alternating"``: each
        square is the mirror image of its neighbours, which favours no direction.
    dimension
        2 for vertices (x, y), 3 for (x, y, 0).

    Returns
    -------
    Mesh
        Vertex i + j (nx + 1) is at (i width / nx, j height / ny).

    Raises
    ------
    MeshError
        If a parameter is out of range.
    UnknownNameError
        If the kind of ``diagonals`` does not exist.

    Examples
    --------
    >>> grid(2, 1).vertices.tolist()
    [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 1.0], [1.0, 1.0]]
    """
    nx, ny = whole("nx", nx, least=1), whole("ny", ny, least=1)
    width, height = positive("width", width), positive("height", height)
    check_name("diagonals", diagonals, ("parallel", "alternating"))
    y, x = np.meshgrid(np.linspace(0, height, ny + 1), np.linspace(0, width, nx + 1), indexing="ij")
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    faces = lattice_faces(ny, nx, alternating=diagonals == "alternating")
    return Mesh(flat(points, dimension), faces)
