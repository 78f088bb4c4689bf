"""The Dirichlet energy by three routes that agree (equations 3.4 and 3.5)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_function
from beltrami.errors import check_name
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.operators.differences import edge_derivative
from beltrami.operators.edge_areas import edge_areas
from beltrami.operators.gradient import face_gradient
from beltrami.operators.weights import weigh_edges

ROUTES = ("faces", "edges", "cotangent")


def dirichlet_energy(mesh: Mesh, f: ArrayLike, how: str = "cotangent") -> float:
    r"""Return :math:`\int |\nabla f|^2` of the linear interpolant, summed over the columns of f.

    ===============  ======================================================================
    ``"faces"``       :math:`\sum_f A_f |\nabla f|^2`, a gradient in each face
    ``"edges"``       :math:`2 \sum_e A_e (f_j - f_i)^2 / |e|^2` (equation 3.4): A_e that of the
                      circumcentres, and a factor 2 because an edge sees one direction of two (E26)
    ``"cotangent"``   :math:`\frac12 \sum_e (\cot\alpha + \cot\beta) (f_i - f_j)^2` (equation 3.5
                      with its ½, E27), which is <Lf, f>
    ===============  ======================================================================

    The three are equal on every mesh, obtuse and not Delaunay too. Each edge counts once. Unit:
    that of f, squared. Cost: O(n + m).

    Chapter items: Q3.4, Q3.5, P23.

    Raises
    ------
    UnknownNameError
        If there is no such route.
    DimensionError, NonFiniteError
        If f is no function on the vertices.
    EmptyMeshError, NonFiniteError, DegenerateFaceError
        If the mesh is not sound.

    Examples
    --------
    >>> mesh = Mesh([[0, 0], [4, 0], [1, 1]], [[0, 1, 2]])  # obtuse
    >>> [round(dirichlet_energy(mesh, mesh.vertices[:, 0], how), 12) for how in ROUTES]
    [2.0, 2.0, 2.0]
    """
    check_name("route to the energy", how, ROUTES)
    values = as_function(f, require_mesh(mesh).n_vertices)
    if how == "faces":
        slopes = face_gradient(mesh) @ values
        return _weighted(np.tile(mesh.face_areas, mesh.dimension), slopes)
    if how == "edges":
        return 2 * _weighted(edge_areas(mesh, "circumcenter"), edge_derivative(mesh, values))
    i, j = mesh.edges.T
    return _weighted(weigh_edges(mesh, "cotangent"), values[j] - values[i])


def _weighted(weights: Floats, differences: Floats) -> float:
    """Sum of weight times square."""
    return float((weights @ differences**2).sum())
