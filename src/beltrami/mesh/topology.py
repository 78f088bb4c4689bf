"""Topology: the faces alone, and everything that follows from them (section 3.1.2)."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array

from beltrami._arrays import Booleans, Integers, read_only, read_only_matrix, whole
from beltrami._frozen import Frozen
from beltrami.errors import MeshError, NotOrientableError, check_name
from beltrami.mesh.connectivity import (
    component_labels,
    faces_joined_by_edges,
    parity_colouring,
)
from beltrami.mesh.face_pairs import FacePairs, pair_faces
from beltrami.mesh.faces import checked_faces
from beltrami.mesh.fans import Fans, group_corners
from beltrami.mesh.half_edges import BOUNDARY, NOT_MANIFOLD, HalfEdges, pair_sides
from beltrami.mesh.loops import order_boundary
from beltrami.mesh.requirements import require_manifold
from beltrami.mesh.rings import adjacency_matrix, incident_faces, vertex_ring


class Topology(Frozen):
    """M = (V, E, F): which vertices make a face, and no positions.

    Faces that name a vertex twice are kept, but have no sides: they make no edge, no fan and no
    component. What is derived is computed when first asked for, once.

    Chapter items: D3, D4, U2, U3, U4, U7, U8, U17, P4, P5, P6, P9, P10.

    Parameters
    ----------
    faces
        (m, 3) integers, 0-based, counter-clockwise seen from outside.
    n_vertices
        Number of vertices n; the largest index plus one if not given.

    Raises
    ------
    DimensionError
        If ``faces`` is not an (m, 3) array of integers.
    MeshError
        If a face names a vertex outside 0..n-1; ``error.faces`` lists these faces.

    Examples
    --------
    >>> tetrahedron = Topology([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    >>> tetrahedron.n_edges, tetrahedron.euler_characteristic, tetrahedron.is_closed
    (6, 2, True)
    """

    faces: Integers
    n_vertices: int

    def __init__(self, faces: ArrayLike, n_vertices: int | None = None) -> None:
        array, n = checked_faces(faces, n_vertices)
        self.__dict__.update(faces=array, n_vertices=n)

    def __reduce__(self) -> Any:  # what is derived is not stored
        return Topology, (self.faces, self.n_vertices)

    def __repr__(self) -> str:
        return f"<Topology: {self.n_vertices} vertices, {self.n_faces} faces>"

    @property
    def n_faces(self) -> int:
        """Number of faces m."""
        return len(self.faces)

    # ---------------------------------------------------------------- edges

    @cached_property
    def half_edges(self) -> HalfEdges:
        """The sides of the faces paired into edges: the one pass that all else rests on."""
        return pair_sides(self.faces, self.n_vertices)

    @property
    def edges(self) -> Integers:
        """(p, 2) int: each edge once, i < j, in lexicographic order (E38)."""
        return self.half_edges.edges

    @property
    def n_edges(self) -> int:
        """Number of edges p, each counted once."""
        return len(self.edges)

    @property
    def face_edges(self) -> NDArray[np.int32]:
        """(m, 3) int: the edge opposite each corner; -1 in a face that names a vertex twice."""
        return self.half_edges.face_edges

    @property
    def twins(self) -> NDArray[np.int32]:
        """(m, 3) int: the half-edge 3 f + c across each side; -1 boundary, -2 not manifold."""
        return self.half_edges.twins

    @cached_property
    def face_pairs(self) -> FacePairs:
        """The pairs of faces that share an edge which no third face has."""
        return pair_faces(self.faces, self.twins)

    @cached_property
    def edge_face_count(self) -> Integers:
        """(p,) int: how many faces share each edge."""
        sides = self.face_edges.ravel()
        return read_only(np.bincount(sides[sides >= 0], minlength=self.n_edges))

    @cached_property
    def edge_faces(self) -> csr_array:
        """(p, m) sparse: the faces of each edge."""
        sides = self.face_edges.ravel()
        kept = np.flatnonzero(sides >= 0)
        entries = (np.ones(len(kept)), (sides[kept], kept // 3))
        return read_only_matrix(csr_array(entries, shape=(self.n_edges, self.n_faces)))

    @cached_property
    def boundary_edges(self) -> Integers:
        """(b, 2) int: the edges with one face."""
        return self._edges_beside(BOUNDARY, self.half_edges.n_boundary)

    @cached_property
    def on_boundary(self) -> Booleans:
        """(n,) bool: whether the vertex is an end of an edge with one face."""
        return read_only(_named(self.boundary_edges, self.n_vertices))

    @cached_property
    def non_manifold_edges(self) -> Integers:
        """(q, 2) int: the edges with more than two faces."""
        return self._edges_beside(NOT_MANIFOLD, self.half_edges.n_crowded)

    def _edges_beside(self, mark: int, count: int) -> Integers:
        """Return the ``count`` edges with sides that have this mark for a twin."""
        if count == 0:  # as on most meshes: the sides need not be looked at
            return read_only(np.zeros((0, 2), np.int64))
        sides = self.face_edges[self.twins == mark]
        return read_only(self.edges[_named(sides[sides >= 0], self.n_edges)])

    # ---------------------------------------------------------------- rings

    @cached_property
    def adjacency(self) -> csr_array:
        """(n, n) sparse: the symmetric matrix A with 1 where (i, j) is an edge."""
        return read_only_matrix(adjacency_matrix(self.edges, self.n_vertices))

    @cached_property
    def vertex_faces(self) -> csr_array:
        """(n, m) sparse: row i marks the faces F_i around vertex i."""
        return read_only_matrix(incident_faces(self.faces, self.n_vertices))

    def ring(self, i: int, s: int = 1, kind: str = "exact") -> Integers:
        """Vertices of the s-ring of i, sorted: ``"exact"`` distance s, ``"ball"`` or ``"walk"``.

        The three readings of equation (3.2); see erratum E6.
        """
        radius = whole("the radius of a ring", s, least=0)
        return vertex_ring(self.adjacency, self._checked(i), radius, kind)

    def face_ring(self, i: int) -> Integers:
        """Faces around vertex i, ascending (definition 4 as it is meant, E7)."""
        v = self._checked(i)
        around = self.vertex_faces
        return np.asarray(around.indices[around.indptr[v] : around.indptr[v + 1]], dtype=np.int64)

    def _checked(self, i: int) -> int:
        vertex = whole("a vertex", i, least=-(2**53))
        if not 0 <= vertex < self.n_vertices:
            raise MeshError(f"there is no vertex {vertex}: they are 0..{self.n_vertices - 1}")
        return vertex

    @cached_property
    def referenced(self) -> Booleans:
        """(n,) bool: whether a face names the vertex."""
        return read_only(_named(self.faces, self.n_vertices))

    # ---------------------------------------------------------------- manifold and orientation

    @cached_property
    def fans(self) -> Fans:
        """The corners grouped into fans: the link test."""
        return group_corners(self.faces, self.twins, self.n_vertices)

    @cached_property
    def non_manifold_vertices(self) -> Integers:
        """The vertices whose link is neither one cycle nor one path."""
        bad = self.fans.of_vertex > 1
        bad[self.non_manifold_edges.ravel()] = True
        return read_only(np.flatnonzero(bad))

    @property
    def is_edge_manifold(self) -> bool:
        """Whether no edge has more than two faces."""
        return not len(self.non_manifold_edges)

    @property
    def is_manifold(self) -> bool:
        """Whether each link is one cycle (inside) or one path (boundary): the test of E9."""
        return not len(self.non_manifold_vertices)

    @property
    def is_closed(self) -> bool:
        """Whether there are faces, and no edge has fewer than two of them."""
        return bool(self.n_edges) and not len(self.boundary_edges)

    @property
    def is_oriented(self) -> bool:
        """Whether neighbouring faces run through their common side in opposite directions."""
        return self.half_edges.disoriented == 0

    @cached_property
    def orientation(self) -> Booleans | None:
        """(m,) bool: the faces to turn for a consistent orientation; None if there is none.

        The first face of each component is kept as it is.
        """
        pairs = self.face_pairs
        turned = parity_colouring(pairs.faces, ~pairs.agree, self.n_faces)
        return None if turned is None else read_only(turned)

    @property
    def is_orientable(self) -> bool:
        """Whether the faces can be oriented consistently (across edges of two faces)."""
        return self.is_oriented or self.orientation is not None

    @cached_property
    def inconsistent_edges(self) -> Integers:
        """(q, 2) int: the edges that their two faces run through in the same direction."""
        if self.is_oriented:
            return read_only(np.zeros((0, 2), np.int64))
        wrong = self.face_pairs.side[~self.face_pairs.agree]
        return read_only(self.edges[self.face_edges.ravel()[wrong]])

    # ---------------------------------------------------------------- global shape

    @cached_property
    def boundary_loops(self) -> tuple[Integers, ...]:
        """The vertices of each boundary loop in order, the longest first.

        Raises NotManifoldError where the boundary runs into an edge of more than two faces.
        """
        return order_boundary(self.faces, self.twins, self.fans.root)

    def components(self, through: str = "vertices") -> Integers:
        """Label of the component of each face, through common vertices or common ``"edges"``.

        A face that names a vertex twice joins nothing; it has the label of its first vertex.
        """
        if check_name("way to connect faces", through, ("vertices", "edges")) == "edges":
            return faces_joined_by_edges(self.face_edges, self.n_edges)
        of_vertex = component_labels(self.edges, self.n_vertices)[self.faces[:, 0]]
        _, first, labels = np.unique(of_vertex, return_index=True, return_inverse=True)
        return np.argsort(np.argsort(first))[labels].astype(np.int64)

    @property
    def n_components(self) -> int:
        """Number of components, through common vertices, of the faces that have sides."""
        labels = self.components()[self.face_edges[:, 0] >= 0]
        return int(np.count_nonzero(_named(labels, self.n_faces)))

    @property
    def euler_characteristic(self) -> int:
        """V - E + F over the faces that have sides, and their vertices."""
        ends = np.count_nonzero(_named(self.edges, self.n_vertices))
        return int(ends - self.n_edges + np.count_nonzero(self.face_edges[:, 0] >= 0))

    @property
    def genus(self) -> int:
        """Sum over the components of the number of handles: (2 c - loops - χ) / 2.

        Raises NotManifoldError or NotOrientableError where it has no meaning.
        """
        require_manifold(self, "the genus of a mesh that is not a manifold is not defined")
        if not self.is_orientable:
            raise NotOrientableError("the surface is not orientable, so it has no genus")
        loops = len(self.boundary_loops)
        return (2 * self.n_components - loops - self.euler_characteristic) // 2

    @cached_property
    def is_bipartite(self) -> bool:
        """Whether the graph (V, E) has a colouring with two colours: never, with a face (E63)."""
        differ = np.ones(self.n_edges, np.bool_)
        return parity_colouring(self.edges, differ, self.n_vertices) is not None


def _named(numbers: NDArray[Any], n: int) -> Booleans:
    """Mark which of 0..n-1 are among the numbers: faster than to sort or to hash them."""
    marks = np.zeros(n, np.bool_)
    marks[numbers.ravel()] = True
    return marks
