"""Gradients: along the edges (definition 13) and inside the faces."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats, Integers
from beltrami.errors import NegativeWeightError
from beltrami.mesh.mesh import Mesh
from beltrami.operators.areas import diagonal_matrix
from beltrami.operators.soundness import require_sound


def incidence_matrix(edges: Integers, n: int) -> csr_array:
    """Return the (p, n) signed incidence G0: (G0 f)_(i,j) = f_j - f_i for each edge i < j (E38).

    Chapter items: U17.
    """
    p = len(edges)
    values = np.tile([-1.0, 1.0], p)
    pointers = np.arange(0, 2 * p + 1, 2)
    return csr_array((values, edges.ravel(), pointers), shape=(p, n))


def edge_gradient(edges: Integers, edge_weight: Floats, n: int) -> csr_array:
    r"""Return the (p, n) gradient :math:`(Gf)_{(i,j)} = \sqrt{w_{ij}} (f_j - f_i)` (definition 13).

    Then G'G = D - W (theorem 6), which needs non-negative weights (E40).

    Chapter items: D13, U18, X5, P30.

    Raises
    ------
    NegativeWeightError
        If a weight is negative; ``error.edges`` lists the edges.
    """
    if (edge_weight < 0).any():
        raise NegativeWeightError(
            "the gradient needs the square roots of the weights, and some are negative",
            edges=edges[edge_weight < 0],
            remedy="L = incidence.T @ diag(edge_weight) @ incidence holds for any sign; "
            "combinatorial and distance weights are positive.",
        )
    return csr_array(diagonal_matrix(np.sqrt(edge_weight)) @ incidence_matrix(edges, n))


def face_gradient(mesh: Mesh) -> csr_array:
    """Return the (d m, n) gradient of the linear interpolant in each face.

    The rows are stacked by coordinate, all the first ones first: ``(G @ f).reshape(d, m)``.
    The gradient of the hat function of a vertex is the height over the opposite side, divided by
    its squared length, in any dimension d. Unit: that of f over length.

    Raises
    ------
    EmptyMeshError, NonFiniteError, DegenerateFaceError
        If the mesh is not sound.

    Examples
    --------
    >>> mesh = Mesh([[0, 0], [2, 0], [0, 1]], [[0, 1, 2]])
    >>> (face_gradient(mesh) @ (3 * mesh.vertices[:, 0] - mesh.vertices[:, 1])).tolist()
    [3.0, -1.0]
    """
    require_sound(mesh)
    m, d = mesh.n_faces, mesh.dimension
    corners = mesh.vertices[mesh.faces]
    values = np.empty((d, m, 3))
    for c in range(3):
        origin = corners[:, (c + 1) % 3]
        side = corners[:, (c + 2) % 3] - origin
        arm = corners[:, c] - origin
        foot = (arm * side).sum(axis=1) / (side**2).sum(axis=1)
        height = arm - foot[:, None] * side
        values[:, :, c] = (height / (height**2).sum(axis=1)[:, None]).T
    columns = np.tile(mesh.faces.ravel(), d)
    pointers = np.arange(0, 3 * d * m + 1, 3)
    matrix = csr_array((values.ravel(), columns, pointers), shape=(d * m, mesh.n_vertices))
    matrix.sort_indices()
    return matrix


def face_divergence(mesh: Mesh) -> csr_array:
    """Return the (n, d m) integrated divergence of a field that is constant in each face.

    It is minus the adjoint of ``face_gradient`` for the areas: -<u, ∇f> summed over the faces is
    <div u, f>, so the stiffness of cotangent weights is -(divergence @ gradient). Divide by the
    vertex areas for the divergence at a point.

    Chapter items: P38.

    Raises
    ------
    EmptyMeshError, NonFiniteError, DegenerateFaceError
        If the mesh is not sound.
    """
    gradient = face_gradient(mesh)
    areas = diagonal_matrix(np.tile(mesh.face_areas, mesh.dimension))
    return csr_array(-(gradient.T @ areas))
