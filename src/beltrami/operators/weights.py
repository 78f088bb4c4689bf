"""Edge weights w_ij: combinatorial, distance, cotangent and more (example 3, equation 3.3)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Floats, rectangular
from beltrami.errors import (
    DimensionError,
    MeshError,
    NegativeWeightError,
    NonFiniteError,
    check_name,
)
from beltrami.mesh.door import require_mesh, topology_of
from beltrami.mesh.edge_matrix import symmetric_matrix
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology
from beltrami.operators.accumulate import NONE, accumulate
from beltrami.operators.mean_value import mean_value_weights
from beltrami.operators.soundness import require_faces, require_positions

WEIGHTS = ("combinatorial", "distance", "cotangent")  # those of the chapter
SYMMETRIC_WEIGHTS = (*WEIGHTS, "clamped")
LEAST_CLAMPED = 1e-3

Weigher: TypeAlias = Callable[[Any], ArrayLike]


def edge_weights(domain: Mesh | Topology, kind: str | Weigher) -> csr_array:
    r"""Return the matrix W of the weights of the edges (example 3).

    ===================  ====================================================
    ``"combinatorial"``  :math:`w_{ij} = 1`; a Topology is enough
    ``"distance"``       :math:`w_{ij} = 1 / |x_j - x_i|^2`
    ``"cotangent"``      :math:`w_{ij} = (\cot\alpha_{ij} + \cot\beta_{ij}) / 2`
    ``"clamped"``        the cotangent weight, but at least 0.001
    ``"mean_value"``     :math:`w_{ij} = (\tan(\gamma_{ij} / 2) + \tan(\delta_{ij} / 2)) / |e_{ij}|`
    a callable           what it returns for the domain: (p,), in the order of ``edges``
    ===================  ====================================================

    The angles α, β face the edge (E17); a boundary edge has one (E18). With the ½, :math:`\langle
    Lf, f\rangle` is the Dirichlet energy (E29). Where they add to more than π the weight is
    negative (E90), and stays so. Clamped weights are positive, for what needs that, and neither
    the energy nor linearly precise any more: cotangents have no unit (1/√3 between equilateral
    faces), so neither has their least value, which is not 0 lest vertices land on a segment (S5).

    Mean value weights have the angles at i beside the edge: positive and linearly precise, but
    :math:`w_{ij} \ne w_{ji}`. They serve maps; ``laplacian`` refuses them. All others are
    symmetric. What each kind promises is ``laplacian(...).properties``.

    Chapter items: Q3.3, X3, P16, P17.

    Returns
    -------
    (n, n) csr_array
        Zero diagonal, rows sorted, each edge stored twice, also where its weight is zero.

    Raises
    ------
    UnknownNameError
        If there are no weights of that name.
    DimensionError, NonFiniteError, NegativeWeightError
        If a callable does not return (p,) numbers, finite and not negative.
    EmptyMeshError, NonFiniteError, DegenerateFaceError
        If the mesh is not sound; the error names the vertices or faces.
    MeshError
        With distance weights, if an edge has no length; ``error.edges`` lists them.

    Notes
    -----
    Units: none for combinatorial and cotangent weights, 1/length² for distance weights, 1/length
    for those of the mean value. A face contributes half of a cotangent, so an edge of several
    faces sums theirs. Cost: O(n + m).

    Examples
    --------
    >>> square = Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    >>> edge_weights(square, "cotangent").toarray().round(12) + 0.0
    array([[0. , 0.5, 0. , 0.5],
           [0.5, 0. , 0.5, 0. ],
           [0. , 0.5, 0. , 0.5],
           [0.5, 0. , 0.5, 0. ]])
    >>> longer_is_weaker = edge_weights(square, lambda mesh: np.exp(-mesh.edge_lengths))
    >>> bool(longer_is_weaker[0, 2] < longer_is_weaker[0, 1])
    True
    """
    if not callable(kind):
        check_name("weights", kind, (*SYMMETRIC_WEIGHTS, "mean_value"))
        if kind == "mean_value":
            return _unsymmetric_matrix(domain)
    weights = weigh_edges(domain, kind)
    topology = topology_of(domain)
    return symmetric_matrix(topology.edges, weights, topology.n_vertices)


def weigh_edges(domain: Mesh | Topology, kind: str | Weigher) -> Floats:
    """Return the (p,) symmetric weights in the order of ``edges``: see ``edge_weights``."""
    if not callable(kind):
        check_name("weights", kind, SYMMETRIC_WEIGHTS)
        if kind != "combinatorial":
            return _of_positions(require_mesh(domain, f"{kind} weights"), kind)
    require_faces(topology_of(domain))
    if isinstance(domain, Mesh):
        require_positions(domain)
    return _called(domain, kind) if callable(kind) else np.ones(len(domain.edges))


def _of_positions(mesh: Mesh, kind: str) -> Floats:
    require_faces(mesh.topology)
    require_positions(mesh)
    if kind == "distance":
        return _distance_weights(mesh)
    weights = accumulate(mesh, True, NONE)[0]
    return np.maximum(weights, LEAST_CLAMPED) if kind == "clamped" else weights


def _called(domain: Mesh | Topology, weigh: Weigher) -> Floats:
    """Ask a callable for the weights, and check them."""
    weights = np.array(rectangular(weigh(domain)), dtype=np.float64)
    edges = domain.edges
    if weights.shape != (len(edges),):
        raise DimensionError(
            f"the callable returned weights of the shape {weights.shape} where ({len(edges)},) is "
            "needed",
            remedy="Give one weight for each row of mesh.edges.",
        )
    if not np.isfinite(weights).all():
        raise NonFiniteError(
            "the callable returned weights that are NaN or infinite",
            edges=edges[~np.isfinite(weights)],
        )
    if (weights < 0).any():
        raise NegativeWeightError(
            "the callable returned negative weights, with which L may have either sign",
            edges=edges[weights < 0],
            remedy="If they are meant, give laplacian() a symmetric sparse matrix of weights.",
        )
    return weights


def _unsymmetric_matrix(domain: Mesh | Topology) -> csr_array:
    """Return the mean value weights: row i holds those of the edges that leave i."""
    mesh = require_mesh(domain, "mean value weights")
    n, (i, j) = mesh.n_vertices, mesh.edges.T
    values = mean_value_weights(mesh).T.ravel()
    entries = (values, (np.concatenate([i, j]), np.concatenate([j, i])))
    matrix = csr_array(entries, shape=(n, n))
    matrix.sort_indices()
    return matrix


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
