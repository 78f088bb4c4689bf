"""segment: part a surface by its eigenvectors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, Integers, as_indices, read_only, rectangular, whole
from beltrami._kinds import checked
from beltrami.errors import BeltramiError, DimensionError
from beltrami.mesh.connectivity import component_labels
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.distances import spectral_embedding
from beltrami.spectrum.k_means import in_order_of_appearance, k_means
from beltrami.spectrum.masses import vertex_masses
from beltrami.spectrum.null_space import ZERO, positive_modes

_FAR = 10.0  # from one component to another, in extents of the embedding


@dataclass(frozen=True, eq=False, repr=False)
class Segmentation:
    """A label for each vertex.

    Attributes
    ----------
    labels : (n,) int, 0 to count - 1, numbered in the order of the first vertex of each
    masses : (count,) the mass, that is the area, of each segment
    spread : the mean squared distance of the vertices from the centre of their cluster, in the
        embedding
    """

    labels: Integers
    masses: Floats
    spread: float

    def __post_init__(self) -> None:
        read_only(self.labels)
        read_only(self.masses)

    def __repr__(self) -> str:
        return f"<Segmentation: {len(self.labels)} vertices in {self.count} segments>"

    @property
    def count(self) -> int:
        """Number of segments."""
        return len(self.masses)


@checked
def segment(
    basis: FourierBasis,
    count: int,
    *,
    kind: str = "commute_time",
    time: float | None = None,
    edges: ArrayLike | None = None,
    seed: int = 0,
    tolerance: float = ZERO,
) -> Segmentation:
    r"""Part a surface into ``count`` segments, by k-means of a spectral embedding.

    Vertices are points with the coordinates :math:`w_i \varphi_i(x)` of ``spectral_embedding``,
    over the first ``count`` eigenvalues above zero; points weigh as much as their mass, so that
    the density of the vertices does not matter. Isometric surfaces are parted alike.

    Parameters
    ----------
    basis
        The k smallest eigenpairs of any pair (L, B).
    count
        How many segments.
    kind, time
        Of the embedding: ``"commute_time"``, ``"biharmonic"`` or ``"diffusion"``, which needs a
        time.
    edges
        (p, 2) pairs of vertices, such as ``mesh.edges``: segments that do not hang together along
        them are cut into their pieces, and there may be more than ``count`` of them. Without,
        labels are those of the clusters.
    seed
        Of the starts of k-means; the best of eight is taken. The same seed gives the same labels.
    tolerance
        Eigenvalues up to this part of the largest one are zero: one for each component. If there
        are several, the components are put far apart (but not for diffusion), so that none is cut
        before all are told from each other.

    Raises
    ------
    MeshError
        If no eigenvalue is above zero or one is negative, or an edge has a wrong vertex.
    BeltramiError, UnknownNameError
        If the count is not between 1 and n, or the kind and the time are not valid.
    ConvergenceError
        If k-means does not come to rest.

    Notes
    -----
    Cost: O(n count²) for each round of k-means.

    References
    ----------
    R. Liu, H. Zhang: Segmentation of 3D meshes through spectral clustering, Pacific Graphics 2004.
    R. Rustamov: Laplace-Beltrami eigenfunctions for deformation invariant shape representation,
    SGP 2007.

    Examples
    --------
    >>> from beltrami.mesh.shapes import cylinder
    >>> from beltrami.operators.laplacian import laplacian
    >>> from beltrami.spectrum.fourier_basis import fourier_basis
    >>> tube = cylinder(12, 60, height=20.0)
    >>> parts = segment(fourier_basis(laplacian(tube), 8), 3, edges=tube.edges)
    >>> parts, bool(parts.masses.min() > 0.3 * parts.masses.sum())
    (<Segmentation: 732 vertices in 3 segments>, True)
    """
    if whole("count", count, least=1) > basis.n:
        raise BeltramiError(f"{basis.n} vertices make no {count} segments")
    zeros = positive_modes(basis, "a segmentation", tolerance)
    points = spectral_embedding(basis, kind, time=time, tolerance=tolerance)
    points = points[:, : zeros + count]
    masses = vertex_masses(basis)
    if zeros > 1 and kind != "diffusion":
        extent = np.sqrt((points**2).sum(axis=1).max() * masses.sum())
        points[:, :zeros] = _FAR * extent * basis.eigenvectors[:, :zeros]
    labels, total = k_means(points, masses, count, whole("seed", seed, 0))
    if edges is not None:
        labels = _pieces(labels, _checked(edges, basis.n))
    return Segmentation(labels, _masses(labels, masses), total / masses.sum())


def _checked(edges: ArrayLike, n: int) -> Integers:
    """Return the edges as (p, 2) vertices."""
    given = rectangular(edges)
    if given.ndim != 2 or given.shape[1] != 2:
        raise DimensionError(f"edges are pairs (p, 2) of vertices, not of the shape {given.shape}")
    return as_indices(given, n, "the vertices of edges").reshape(-1, 2)


def _pieces(labels: Integers, edges: Integers) -> Integers:
    """Label the connected pieces of the segments."""
    inner = edges[labels[edges[:, 0]] == labels[edges[:, 1]]]
    return in_order_of_appearance(component_labels(inner, len(labels)))


def _masses(labels: Integers, masses: Floats) -> Floats:
    return np.bincount(labels, masses).astype(np.float64)
