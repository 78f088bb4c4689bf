"""Areas of the vertices, and the mass matrices made of them (section 3.2.3)."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats
from beltrami.errors import check_name
from beltrami.mesh.edge_matrix import symmetric_matrix
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.triangle import BARYCENTRIC, CIRCUMCENTRIC, VORONOI
from beltrami.operators.accumulate import accumulate

AREA_KINDS = {"barycentric": BARYCENTRIC, "voronoi": VORONOI, "circumcentric": CIRCUMCENTRIC}


def vertex_areas(mesh: Mesh, kind: str = "voronoi") -> Floats:
    r"""Return the (n,) areas A_i of the cells of the vertices; they add to the area (theorem 3).

    =================== ============================================================
    ``"voronoi"``        cells of Voronoi, cut at obtuse angles (mixed): never negative
    ``"barycentric"``    a third of each face: exact integrals of linear functions
    ``"circumcentric"``  :math:`\frac18 \sum_j |e_{ij}|^2 (\cot\alpha_{ij} + \cot\beta_{ij})`,
                         theorem 3 with its constant corrected (E22); may be negative (E23)
    =================== ============================================================

    The unit is length². A vertex in no face has area 0.

    Chapter items: D10.

    Raises
    ------
    UnknownNameError
        If there are no areas of that name.
    EmptyMeshError, NonFiniteError, DegenerateFaceError
        If the mesh is not sound.

    Examples
    --------
    >>> right = Mesh([[0, 0], [2, 0], [0, 2]], [[0, 1, 2]])
    >>> {kind: vertex_areas(right, kind).round(3).tolist() for kind in AREA_KINDS}
    {'barycentric': [0.667, 0.667, 0.667], 'voronoi': [1.0, 0.5, 0.5],
     'circumcentric': [1.0, 0.5, 0.5]}
    """
    check_name("kind of vertex areas", kind, tuple(AREA_KINDS))
    return accumulate(mesh, False, AREA_KINDS[kind])[1]


def diagonal_matrix(values: Floats) -> csr_array:
    """Return the (n, n) diagonal matrix with these values."""
    n = len(values)
    pointers = np.arange(n + 1, dtype=np.int32)
    matrix = csr_array((values, np.arange(n, dtype=np.int32), pointers), shape=(n, n))
    matrix.has_canonical_format = True  # known: scipy need not look
    return matrix


def consistent_mass(mesh: Mesh) -> csr_array:
    """Return the mass matrix of linear finite elements: ∫ φ_i φ_j, symmetric, not diagonal.

    A face of area A adds A/6 to the diagonal at its corners and A/12 to its sides; the entries
    add to the area of the surface.

    Raises
    ------
    EmptyMeshError, NonFiniteError, DegenerateFaceError
        If the mesh is not sound.
    """
    diagonal = vertex_areas(mesh, "barycentric") / 2
    topology = mesh.topology
    twelfth = np.repeat(mesh.face_areas / 12, 3)
    sides = np.zeros(topology.n_edges)
    np.add.at(sides, topology.face_edges.ravel(), twelfth)
    return symmetric_matrix(topology.edges, sides, mesh.n_vertices, diagonal)
