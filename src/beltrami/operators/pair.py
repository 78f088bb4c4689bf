"""Laplacian: the pair (stiffness L, mass B) that everything else uses (definitions 13 to 15)."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Floats, Integers, as_function, read_only, read_only_matrix
from beltrami._carded import Carded
from beltrami.errors import DimensionError, MeshError, NegativeWeightError, check_name
from beltrami.mesh.edge_matrix import symmetric_matrix
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology
from beltrami.operators import bounds
from beltrami.operators.areas import diagonal_matrix
from beltrami.operators.gradient import edge_gradient, incidence_matrix
from beltrami.operators.guarantees import (
    GIVEN,
    WEIGHT_KINDS,
    LaplacianProperties,
    properties_of,
)
from beltrami.operators.intrinsic import IntrinsicTriangulation
from beltrami.operators.intrinsic_parts import face_pairs
from beltrami.operators.soundness import require_degrees

GRAPH_MASSES = ("degree", "unit")
MASSES = ("degree", "barycentric", "voronoi", "consistent", "unit")
INTRINSIC = "intrinsic_delaunay"
TUFTED = "tufted"


@dataclass(frozen=True, eq=False, repr=False)
class Laplacian(Carded):
    r"""A stiffness :math:`L = D - W`, symmetric positive semi-definite with L1 = 0, and a mass B.

    ``laplacian`` makes it. The operator is :math:`B^{-1} L`; it is self-adjoint for
    :math:`\langle f, g\rangle_B = f^T B g`, which ``inner``, ``norm`` and ``mean`` use. With
    cotangent weights :math:`\langle Lf, f\rangle = \int |\nabla f|^2` and
    :math:`B^{-1}L \approx -\Delta`: positive, with the factor ½ in the weights (E29, E30).

    Chapter items: D7, D14, T7, R1, P36, P38.

    Attributes
    ----------
    stiffness : (n, n) csr_array
    mass : (n, n) csr_array, diagonal unless consistent
    edges : (p, 2) int, i < j
    edge_weight : (p,) weights w_ij of the edges
    weight_kind, mass_kind : their names

    All its matrices are read-only: ``pair.stiffness.copy()`` is yours.
    """

    stiffness: csr_array
    mass: csr_array
    edges: Integers
    edge_weight: Floats
    weight_kind: str
    mass_kind: str
    domain: Mesh | Topology | IntrinsicTriangulation | None = field(default=None)

    def __post_init__(self) -> None:
        read_only_matrix(self.stiffness)
        read_only_matrix(self.mass)

    def __repr__(self) -> str:
        certain = self._of_a_surface or not len(self._negative_edges)
        definite = ", positive semi-definite" if certain else ", of either sign"
        half = ", (cot α + cot β)/2" if self._of_a_surface else ""
        return (
            f"<Laplacian: {self.n} vertices, {self.weight_kind} weights{half}, "
            f"{self.mass_kind} mass{definite}>"
        )

    @property
    def n(self) -> int:
        """Number of vertices n."""
        return int(self.stiffness.shape[0])

    # ---------------------------------------------------------------- matrices

    @cached_property
    def weights(self) -> csr_array:
        """(n, n) symmetric W, zero diagonal."""
        return read_only_matrix(symmetric_matrix(self.edges, self.edge_weight, self.n))

    @cached_property
    def degrees(self) -> Floats:
        """(n,) degrees d_i = Σ_j w_ij; positive for cotangent weights too (S1 of the errata)."""
        return read_only(self.stiffness.diagonal())

    @cached_property
    def masses(self) -> Floats:
        """(n,) row sums of B: the integrals of the hat functions, or the degrees."""
        if self.mass_kind == "consistent":
            return read_only(np.asarray(self.mass.sum(axis=1)))
        return read_only(self.mass.diagonal())

    @cached_property
    def averaging(self) -> csr_array:
        r"""(n, n) :math:`\tilde W = D^{-1} W`, rows that add to 1 (definition 9).

        Raises NegativeWeightError, with the edges, if a weight is negative.

        Chapter items: D9, P18.
        """
        self.require_non_negative("averaging")
        require_degrees(self.degrees)
        return read_only_matrix(csr_array(diagonal_matrix(1 / self.degrees) @ self.weights))

    @cached_property
    def normalized(self) -> csr_array:
        r"""(n, n) :math:`\tilde L = D^{-1/2} L D^{-1/2}`, unit diagonal (definition 15, E43).

        Chapter items: D15, T7, U20, R1, P32, P33.
        """
        require_degrees(self.degrees)
        root = diagonal_matrix(1 / np.sqrt(self.degrees))
        return read_only_matrix(csr_array(root @ self.stiffness @ root))

    @cached_property
    def incidence(self) -> csr_array:
        """(p, n) signed incidence G0; L = G0' diag(edge_weight) G0 for weights of any sign."""
        return read_only_matrix(incidence_matrix(self.edges, self.n))

    @cached_property
    def gradient(self) -> csr_array:
        """(p, n) edge gradient G with G'G = L (theorem 6); NegativeWeightError if w < 0 (E40).

        Chapter items: D13, T6, U18, X5, P30.
        """
        slightly = (self.edge_weight < 0) & (self.edge_weight >= -self._rounding)
        kept = np.where(slightly, 0, self.edge_weight)
        return read_only_matrix(edge_gradient(self.edges, kept, self.n))

    # ---------------------------------------------------------------- functions

    def apply(self, f: ArrayLike) -> Floats:
        """B⁻¹ L f for (n,) or (n, c); not defined for the consistent mass, which needs a solve.

        Chapter items: D7, U30, P35.
        """
        values = as_function(f, self.n)
        self._require_diagonal("apply")
        return np.asarray(((self.stiffness @ values).T / self.masses).T)

    def inner(self, f: ArrayLike, g: ArrayLike) -> float:
        """<f, g>_B = f' B g, summed over the columns (definition 6 with a mass, E12).

        Raises DimensionError if f and g have not as many columns.

        Chapter items: D6.
        """
        left, right = as_function(f, self.n), as_function(g, self.n)
        if left.size != right.size:
            raise DimensionError(
                f"an inner product needs functions with as many columns, not {left.shape} and "
                f"{right.shape}"
            )
        return float(np.vdot(left, self.mass @ right))

    def norm(self, f: ArrayLike) -> float:
        """Norm sqrt(<f, f>_B).

        Chapter items: D6.
        """
        return float(np.sqrt(self.inner(f, f)))

    def mean(self, f: ArrayLike) -> Floats:
        """Mean <1, f>_B / <1, 1>_B of each column: what diffusion preserves and tends to.

        Chapter items: T14, T15.
        """
        return np.asarray(self.masses @ as_function(f, self.n) / self.masses.sum())

    def dirichlet_energy(self, f: ArrayLike) -> float:
        """<Lf, f>, summed over the columns; ∫|∇f|² of the linear interpolant for cotangents.

        Chapter items: Q3.5, U19, P23.
        """
        values = as_function(f, self.n)
        return float(np.vdot(values, self.stiffness @ values))

    # ---------------------------------------------------------------- guarantees

    @cached_property
    def properties(self) -> LaplacianProperties:
        """What is true of these weights on this mesh."""
        return properties_of(
            self.weight_kind,
            self.edges,
            self.edge_weight,
            self.n,
            self._negative_edges,
            self.spectral_bound(),
        )

    def spectral_bound(self, mass: str | None = None) -> float:
        r"""Return a proven upper bound on the eigenvalues of (L, B), or of L with another mass.

        The largest eigenvalue over the pairs of the faces (edges, for a graph). With B = D and
        cotangent weights it is the bound of E62, :math:`(3 + \sqrt{1 - 8 \cos A \cos B
        \cos C}) / 2 < 3`; with area masses it grows like the inverse square of the shortest
        edges. Explicit steps must stay below twice its inverse. Cost: O(m).

        Chapter items: T9, T16, R3.
        """
        kind = self.mass_kind if mass is None else check_name("mass", mass, MASSES)
        if self.domain is None:
            if kind == self.mass_kind:
                masses = self.masses
            else:
                check_name("mass of a graph", kind, GRAPH_MASSES)
                masses = self.degrees if kind == "degree" else np.ones(self.n)
            return bounds.largest_edge_eigenvalue(
                self.edges, self.edge_weight, self.degrees, masses
            )
        if isinstance(self.domain, IntrinsicTriangulation):
            parts = face_pairs(self.domain, kind)
        else:
            sides = bounds.side_weights(self.domain, self.edge_weight, self.weight_kind)
            parts = sides, bounds.corner_masses(self.domain, sides, kind)
        bound = bounds.largest_face_eigenvalue(*parts)
        # in needles the sum of two cotangents rounds to 0; E62 does not
        return min(bound, 3.0) if kind == "degree" and self._of_a_surface else bound

    def require_non_negative(self, what: str) -> None:
        """Raise NegativeWeightError, with the edges, if a weight is negative."""
        if len(self._negative_edges):
            raise NegativeWeightError(
                f"{what} needs non-negative weights, and some {self.weight_kind} ones are negative",
                edges=self._negative_edges,
                remedy='Use laplacian(mesh, "combinatorial") or "distance", or heat(), which '
                "needs no sign.",
            )

    def require_semi_definite(self, what: str) -> None:
        """Raise NegativeWeightError if <Lf, f> >= 0 is not proven: negative weights of yours."""
        if len(self._negative_edges) and not self._of_a_surface:
            raise NegativeWeightError(
                f"{what} needs a positive semi-definite stiffness, and with negative weights that "
                "are no cotangents nothing is proven",
                edges=self._negative_edges,
            )

    @cached_property
    def _negative_edges(self) -> Integers:
        """Return the edges with a negative weight."""
        return read_only(self.edges[self.edge_weight < -self._rounding])

    @property
    def _rounding(self) -> float:
        """What a weight may be off: the cotangents of right angles come out as ±1e-16."""
        return 1e-12 if self._of_a_surface else 0.0

    @property
    def _of_a_surface(self) -> bool:
        return WEIGHT_KINDS.get(self.weight_kind, GIVEN).of_a_surface

    def _require_diagonal(self, what: str) -> None:
        if self.mass_kind == "consistent":
            raise MeshError(
                f"{what} needs a diagonal mass, and the consistent mass is not",
                remedy='Use mass="voronoi", or solve with factorize(laplacian.mass).',
            )
