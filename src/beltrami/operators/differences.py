"""Slopes along the edges (l. 230 of the chapter)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_function
from beltrami.errors import MeshError
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.operators.soundness import require_faces, require_positions


def edge_derivative(mesh: Mesh, f: ArrayLike) -> Floats:
    r"""Return the slope of f along each edge at its middle, from i to j: (f_j - f_i) / |x_j - x_i|.

    It approximates :math:`\langle \nabla f, (x_j - x_i) / |x_j - x_i| \rangle` at second order, and
    is exact for linear functions. It is Gf for distance weights (example 5). Edges run from the
    smaller index to the larger, as in ``mesh.edges``; turning one changes the sign of its slope.

    Chapter items: U15, X5, P30.

    Returns
    -------
    (p,) or (p, c), in the unit of f over length.

    Raises
    ------
    DimensionError, NonFiniteError
        If f is no function on the vertices.
    EmptyMeshError, NonFiniteError, DegenerateFaceError
        If there are no faces, a coordinate is not finite, or a face names a vertex twice.
    MeshError
        If an edge has no length; ``error.edges`` lists them.

    Examples
    --------
    >>> mesh = Mesh([[0, 0], [2, 0], [0, 1]], [[0, 1, 2]])
    >>> edge_derivative(mesh, [1.0, 5.0, 2.0]).round(3).tolist()
    [2.0, 1.0, -1.342]
    """
    values = as_function(f, require_mesh(mesh).n_vertices)
    require_faces(mesh.topology)
    require_positions(mesh)
    lengths = mesh.edge_lengths
    if not (lengths > 0).all():
        raise MeshError(
            "a slope along an edge needs its length",
            edges=mesh.edges[lengths == 0],
            remedy="Weld their ends: repair(mesh, merge_duplicate_vertices=True, "
            "remove_degenerate_faces=True).",
        )
    i, j = mesh.edges.T
    return np.asarray(((values[j] - values[i]).T / lengths).T)
