"""laplacian: from a mesh, a topology or a graph to the pair (L, B)."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from scipy.sparse import csr_array, issparse, triu

from beltrami._arrays import Floats, read_only
from beltrami.errors import DimensionError, MeshError, check_name, shown
from beltrami.mesh.door import require_mesh, topology_of
from beltrami.mesh.edge_matrix import laplacian_matrix
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology
from beltrami.operators.accumulate import accumulate
from beltrami.operators.areas import (
    AREA_KINDS,
    consistent_mass,
    diagonal_matrix,
    vertex_areas,
)
from beltrami.operators.domain import Domain
from beltrami.operators.intrinsic import IntrinsicTriangulation, intrinsic_delaunay
from beltrami.operators.intrinsic_pair import intrinsic_laplacian
from beltrami.operators.pair import GRAPH_MASSES, INTRINSIC, MASSES, TUFTED, Laplacian
from beltrami.operators.soundness import refuse_unreferenced, require_degrees
from beltrami.operators.weights import SYMMETRIC_WEIGHTS, Weigher, weigh_edges

Source: TypeAlias = "Mesh | Topology | Domain | Any"  # Any: a symmetric sparse matrix of weights


def laplacian(
    domain: Source, weights: str | Weigher | None = None, mass: str | None = None
) -> Laplacian:
    r"""Make the pair (L, B) of a mesh, of a topology, or of a graph.

    Chapter items: D14, X3, P7, P16, P17, P21, P35.

    Parameters
    ----------
    domain
        A Mesh; a Topology (combinatorial weights); a symmetric sparse matrix of weights; an
        IntrinsicTriangulation; a Grid, or another object that makes its own pair
        (``make_laplacian``, which names its weights).
    weights
        ``"cotangent"`` (default on a Mesh), ``"combinatorial"`` (default elsewhere),
        ``"distance"``, ``"clamped"``, or a callable: see ``edge_weights``.
        ``"intrinsic_delaunay"``: the cotangents, and the areas, of other triangles with the same
        vertices on the same surface, made by ``intrinsic_delaunay``: on a closed mesh none is
        negative. ``"tufted"``: the same on the surface taken twice, front and back: none is
        negative on any mesh, also where it is neither a manifold nor orientable, but at the
        boundary linear functions are not kept.
    mass
        ``"voronoi"`` (default for cotangents, clamped ones too), ``"barycentric"``,
        ``"consistent"`` (full finite elements), ``"degree"`` (default otherwise: B = D) or
        ``"unit"``. Those of areas add to the area of the surface.

    Raises
    ------
    UnknownNameError
        If a name is misspelt; the error lists the right ones.
    EmptyMeshError, NonFiniteError, DegenerateFaceError, UnreferencedVertexError
        If the mesh is not sound: the error names the vertices or faces, and the repair.
    MeshError
        If weights are not symmetric: those of the mean value, or a matrix that is not square,
        symmetric and finite, or has a diagonal.
    NegativeWeightError
        If a callable returns negative weights.

    Notes
    -----
    Non-manifold meshes are accepted: an edge sums the cotangents of all its faces.
    Cost: O(n + m); the topology is paired once and shared by ``with_vertices``.

    Examples
    --------
    >>> mesh = Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    >>> pair = laplacian(mesh)
    >>> pair
    <Laplacian: 4 vertices, cotangent weights, (cot α + cot β)/2, voronoi mass,
     positive semi-definite>
    >>> round(pair.dirichlet_energy(mesh.vertices[:, 0]), 12), pair.masses.sum()
    (1.0, np.float64(1.0))
    """
    if callable(weights) and not isinstance(domain, Mesh | Topology):
        raise DimensionError("a callable weighs the edges of a Mesh or of a Topology only")
    name: Any = weights
    if issparse(domain):
        matrix: Any = domain
        return _of_graph(csr_array(matrix), name, mass)
    if isinstance(domain, IntrinsicTriangulation):
        own = INTRINSIC if domain.sheets == 1 else TUFTED
        check_name("weights", own if name is None else name, (own,))
        return intrinsic_laplacian(domain, mass)
    if isinstance(domain, Domain):
        return domain.make_laplacian(name, mass)
    if not isinstance(domain, Mesh | Topology):
        raise DimensionError(
            f"cannot make a Laplacian of an object of type {type(domain).__name__}",
            remedy="Give a Mesh (see as_mesh), a Topology, a Grid, PointCloud(points), or a "
            "symmetric sparse matrix.",
        )
    default = "cotangent" if isinstance(domain, Mesh) else "combinatorial"
    rule = default if weights is None else weights
    weight_kind = "given" if callable(rule) else _checked_kind(rule)
    if weight_kind in (INTRINSIC, TUFTED):
        mesh = require_mesh(domain, "intrinsic triangles")
        return intrinsic_laplacian(intrinsic_delaunay(mesh, cover=weight_kind == TUFTED), mass)
    natural = "voronoi" if weight_kind in ("cotangent", "clamped") else "degree"
    mass_kind = check_name("mass", natural if mass is None else mass, MASSES)
    topology = topology_of(domain)
    edge_weight, areas = _weights_and_areas(domain, rule, mass_kind)
    stiffness = laplacian_matrix(topology.edges, edge_weight, topology.n_vertices)
    if (np.diff(stiffness.indptr) == 1).any():  # a row that holds its diagonal alone
        refuse_unreferenced(topology)
    masses = _mass_matrix(domain, stiffness, mass_kind, areas)
    if mass_kind == "degree" and weight_kind == "given":
        require_degrees(masses.diagonal())
    return Laplacian(stiffness, masses, topology.edges, edge_weight, weight_kind, mass_kind, domain)


def _checked_kind(name: object) -> str:
    if isinstance(name, str) and name == "mean_value":  # an array would compare its entries
        raise MeshError(
            "mean value weights are not symmetric: they serve maps, and no Laplacian",
            remedy='Use "clamped" weights, which are positive too, or edge_weights(mesh, '
            '"mean_value") for a map.',
        )
    return check_name("weights", name, (*SYMMETRIC_WEIGHTS, INTRINSIC, TUFTED))


def _weights_and_areas(
    domain: Mesh | Topology, weights: str | Weigher, mass: str
) -> tuple[Floats, Floats | None]:
    """Weigh the edges; cotangents and areas come out of one pass over the faces."""
    if mass not in ("degree", "unit"):
        require_mesh(domain, f"the {mass} mass")
    if isinstance(domain, Mesh) and weights == "cotangent" and mass in AREA_KINDS:
        edge_weight, areas = accumulate(domain, True, AREA_KINDS[mass])
        return read_only(edge_weight), areas
    return read_only(weigh_edges(domain, weights)), None


def _mass_matrix(
    domain: Mesh | Topology, stiffness: csr_array, kind: str, areas: Floats | None
) -> csr_array:
    if kind == "unit":
        return diagonal_matrix(np.ones(stiffness.shape[0]))
    if kind == "degree" or not isinstance(domain, Mesh):
        return diagonal_matrix(stiffness.diagonal())
    if kind == "consistent":
        return consistent_mass(domain)
    return diagonal_matrix(vertex_areas(domain, kind) if areas is None else areas)


def _of_graph(matrix: csr_array, weights: object, mass: str | None) -> Laplacian:
    """Make the pair of a graph given by its symmetric weights."""
    n = matrix.shape[0]
    if not n or matrix.dtype.kind not in "biuf":
        raise MeshError("a matrix of weights is real, and not empty")
    if matrix.shape != (n, n) or not np.isfinite(matrix.data).all():
        raise MeshError(f"a matrix of weights is square and finite, and this is {matrix.shape}")
    if abs(matrix - matrix.T).max() > 1e-12 * abs(matrix).max() or matrix.diagonal().any():
        raise MeshError("a matrix of weights is symmetric, with a zero diagonal")
    if weights is not None and not (isinstance(weights, str) and weights == "combinatorial"):
        raise DimensionError(f"{shown(weights)} weights need a Mesh: a graph has its own")
    upper = triu(matrix, 1).tocsr()
    upper.sum_duplicates()
    upper.eliminate_zeros()
    upper.sort_indices()
    rows = np.repeat(np.arange(n), np.diff(upper.indptr))
    edges = read_only(np.stack([rows, upper.indices.astype(np.int64)], axis=1))
    edge_weight = read_only(np.ones(len(edges)) if weights else upper.data.astype(np.float64))
    stiffness = laplacian_matrix(edges, edge_weight, n)
    kind = check_name("mass of a graph", "degree" if mass is None else mass, GRAPH_MASSES)
    masses = stiffness.diagonal() if kind == "degree" else np.ones(n)
    require_degrees(masses)
    name = "combinatorial" if weights else "given"
    return Laplacian(stiffness, diagonal_matrix(masses), edges, edge_weight, name, kind)
