"""Edge weights w_ij: combinatorial, distance and cotangent (example 3, equation 3.3)."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats
from beltrami.errors import DimensionError, MeshError, check_name
from beltrami.mesh.edge_matrix import symmetric_matrix
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology
from beltrami.operators.accumulate import NONE, accumulate
from beltrami.operators.soundness import require_faces, require_positions

WEIGHTS = ("combinatorial", "distance", "cotangent")


def edge_weights(domain: Mesh | Topology, kind: str) -> csr_array:
    r"""Return the symmetric matrix W of the weights of the edges (example 3).

    ==================  =====================================================
    ``"combinatorial"``  :math:`w_{ij} = 1`; a Topology is enough
    ``"distance"``       :math:`w_{ij} = 1 / |x_j - x_i|^2`
    ``"cotangent"``      :math:`w_{ij} = (\cot\alpha_{ij} + \cot\beta_{ij}) / 2`
    ==================  =====================================================

    The angles face the edge (E17); a boundary edge has one (E18). With the ½, :math:`\langle Lf,
    f\rangle` is the Dirichlet energy (E29). Where they add to more than π the weight is negative,
    and stays so.

    Chapter items: Q3.3, X3, P16.

    Returns
    -------
    (n, n) csr_array
        Zero diagonal, rows sorted, each edge stored twice, also where its weight is zero.

    Raises
    ------
    UnknownNameError
        If there are no weights of that name.
    EmptyMeshError, NonFiniteError, DegenerateFaceError
        If the mesh is not sound; the error names the vertices or faces.
    MeshError
        With distance weights, if an edge has no length; ``error.edges`` lists them.

    Notes
    -----
    Units: none for combinatorial and cotangent weights, 1/length² for distance weights. A face
    contributes half of a cotangent, so an edge of several faces sums theirs. Cost: O(n + m).

    Examples
    --------
    >>> square = Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    >>> edge_weights(square, "cotangent").toarray().round(12) + 0.0
    array([[0. , 0.5, 0. , 0.5],
           [0.5, 0. , 0.5, 0. ],
           [0. , 0.5, 0. , 0.5],
           [0.5, 0. , 0.5, 0. ]])
    """
    topology = domain.topology if isinstance(domain, Mesh) else domain
    return symmetric_matrix(topology.edges, weigh_edges(domain, kind), topology.n_vertices)


def weigh_edges(domain: Mesh | Topology, kind: str) -> Floats:
    """Return the (p,) weights in the order of ``edges``: see ``edge_weights``."""
    check_name("weights", kind, WEIGHTS)
    topology = domain.topology if isinstance(domain, Mesh) else domain
    require_faces(topology)
    if isinstance(domain, Mesh):
        require_positions(domain)
    if kind == "combinatorial":
        return np.ones(topology.n_edges)
    if not isinstance(domain, Mesh):
        raise DimensionError(f"{kind} weights need the positions of the vertices: give a Mesh")
    return _distance_weights(domain) if kind == "distance" else accumulate(domain, True, NONE)[0]


def _distance_weights(mesh: Mesh) -> Floats:
    lengths = mesh.edge_lengths
    with np.errstate(divide="ignore", over="ignore"):
        weights = 1 / lengths**2
    if not (np.isfinite(weights) & (weights > 0)).all():
        raise MeshError(
            "distance weights need edges of positive length",
            edges=mesh.edges[~(np.isfinite(weights) & (weights > 0))],
            remedy="Weld their ends: repair(mesh, merge_duplicate_vertices=True, "
            "remove_degenerate_faces=True).",
        )
    return weights
