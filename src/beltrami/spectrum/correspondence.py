"""FunctionalMap: a linear map of functions from one surface to another, and its points."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, Integers, as_function, as_indices, read_only, whole
from beltrami._kinds import checked
from beltrami.errors import BeltramiError, DimensionError
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.masses import total_mass
from beltrami.spectrum.null_space import positive_modes, true_zeros
from beltrami.spectrum.point_maps import map_of_points, nearest_points, nearest_points_back


@dataclass(frozen=True, eq=False, repr=False)
class FunctionalMap:
    r"""A linear map of functions on one surface to functions on another, in their bases.

    Coefficients of the source go to coefficients of the target. Both surfaces are taken in the
    unit in which their area is 1, so that the size of neither matters: a copy in another unit has
    C = Id, and constants go to constants.

    ``functional_map``, ``functional_map_from_points`` and ``zoomout`` make it.

    Attributes
    ----------
    matrix : (k_target, k_source) C
    point_map : (n_target,) for each target vertex y the source vertex T(y): C is about f ↦ f∘T
    source, target : the bases, of at least k_source and k_target eigenpairs
    descriptor_residual : ‖CA - B‖ beside ‖B‖ for the coefficients A, B of what was to be kept;
        None where there were no descriptors
    """

    matrix: Floats
    point_map: Integers
    source: FourierBasis
    target: FourierBasis
    descriptor_residual: float | None = None

    def __post_init__(self) -> None:
        read_only(self.matrix)
        read_only(self.point_map)

    def __repr__(self) -> str:
        rows, columns = self.matrix.shape
        return (
            f"<FunctionalMap: {self.source.n} to {self.target.n} vertices, {rows} x {columns}, "
            f"orthogonality {self.orthogonality:.3g}, "
            f"commutativity {self.commutativity_residual:.3g}>"
        )

    @property
    def orthogonality(self) -> float:
        r""":math:`\|C^T C - Id\| / \sqrt{k}`: 0 if areas are kept, as by any isometry."""
        k = self.matrix.shape[1]
        return float(np.linalg.norm(self.matrix.T @ self.matrix - np.eye(k)) / math.sqrt(k))

    @property
    def commutativity_residual(self) -> float:
        r""":math:`\|C\Lambda - \Lambda' C\|` beside ‖CΛ‖ + ‖Λ'C‖: 0 for an isometry, 1 at most."""
        right = self.matrix * unit_eigenvalues(self.source)[: self.matrix.shape[1]]
        left = self.matrix * unit_eigenvalues(self.target)[: self.matrix.shape[0], None]
        whole = np.linalg.norm(right) + np.linalg.norm(left)
        return float(np.linalg.norm(right - left) / whole) if whole > 0 else 0.0

    def transfer(self, f: ArrayLike) -> Floats:
        """Bring a function (n_source,) or (n_source, c) to the target, through C: a smooth one."""
        values = as_function(f, self.source.n)
        k_target, k_source = self.matrix.shape
        coefficients = self.source.eigenvectors[:, :k_source].T @ (self.source.mass @ values)
        growth = math.sqrt(total_mass(self.target) / total_mass(self.source))
        result = self.target.eigenvectors[:, :k_target] @ (self.matrix @ coefficients)
        return np.asarray(growth * result)

    def backward(self) -> Integers:
        """Return the (n_source,) target vertices nearest to the source vertices, through C."""
        k_target, k_source = self.matrix.shape
        return nearest_points_back(
            self.matrix,
            unit_vectors(self.source, k_source),
            unit_vectors(self.target, k_target),
        )


@checked
def functional_map_from_points(
    source: FourierBasis, target: FourierBasis, point_map: ArrayLike, *, k: int | None = None
) -> FunctionalMap:
    r"""Return the map :math:`C = \Psi^T B \Phi[T]` of f ↦ f∘T for a map T of the vertices.

    Parameters
    ----------
    source, target
        Bases Φ and Ψ, taken in the units in which the areas are 1.
    point_map
        (n_target,) for each target vertex a source vertex.
    k
        How many eigenpairs of each basis. Default: all there are.

    Returns
    -------
    FunctionalMap
        Its ``point_map`` is what C says, not the one given: a smooth version of it.

    Raises
    ------
    MeshError
        If the point map is not one source vertex for each target vertex.
    BeltramiError
        If k is not a whole number within the bases.

    Examples
    --------
    >>> from beltrami.mesh.shapes import blob
    >>> from beltrami.operators.laplacian import laplacian
    >>> from beltrami.spectrum.fourier_basis import fourier_basis
    >>> basis = fourier_basis(laplacian(blob(500)), 10)
    >>> same = functional_map_from_points(basis, basis, np.arange(basis.n))
    >>> bool(abs(same.matrix - np.eye(10)).max() < 1e-9)
    True
    """
    points = as_indices(point_map, source.n, "the vertices of a point map", repeated=True)
    if len(points) != target.n:
        raise DimensionError(
            f"a point map needs one source vertex for each of {target.n} target vertices, "
            f"not {len(points)}"
        )
    k_source, k_target = (size_of(basis, k) for basis in (source, target))
    weighted = target.mass @ unit_vectors(target, k_target) / total_mass(target)
    C = map_of_points(points, unit_vectors(source, k_source), weighted)
    return with_point_map(C, source, target)


def with_point_map(
    C: Floats, source: FourierBasis, target: FourierBasis, residual: float | None = None
) -> FunctionalMap:
    """Make the result of C and the point map nearest to it."""
    phi, psi = unit_vectors(source, C.shape[1]), unit_vectors(target, C.shape[0])
    return FunctionalMap(C, nearest_points(C, phi, psi), source, target, residual)


def unit_vectors(basis: FourierBasis, k: int) -> Floats:
    """Return the first k eigenvectors on the surface scaled to the area 1."""
    return basis.eigenvectors[:, :k] * math.sqrt(total_mass(basis))


def unit_eigenvalues(basis: FourierBasis) -> Floats:
    """Return the eigenvalues on the surface scaled to the area 1."""
    return true_zeros(basis) * total_mass(basis)


def size_of(basis: FourierBasis, k: int | None) -> int:
    """Return k, or all of the basis; BeltramiError if it is not within the basis."""
    positive_modes(basis, "a functional map")
    size = basis.k if k is None else whole("k", k, least=1)
    if size > basis.k:
        raise BeltramiError(f"k is {k}, and the basis has {basis.k} eigenpairs")
    return size
