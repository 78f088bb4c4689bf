"""functional_map: how functions go from one surface to another (Ovsjanikov et al. 2012)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_function, as_indices, rectangular
from beltrami._kinds import checked
from beltrami.errors import BeltramiError, DimensionError, MeshError
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.correspondence import (
    FunctionalMap,
    size_of,
    unit_eigenvalues,
    unit_vectors,
    with_point_map,
)
from beltrami.spectrum.masses import total_mass

_RANK = 1e-12  # of the rows' systems: smaller singular values are not determined


@checked
def functional_map(
    source: FourierBasis,
    target: FourierBasis,
    source_descriptors: ArrayLike | None = None,
    target_descriptors: ArrayLike | None = None,
    *,
    landmarks: ArrayLike | None = None,
    k: int | None = None,
    commutativity: float = 0.1,
) -> FunctionalMap:
    r"""Find the C that keeps descriptors and commutes with the Laplacians, by least squares.

    Minimises :math:`\frac{1}{q}\|CA - B\|^2 + \alpha\|C\Lambda - \Lambda' C\|^2 / \lambda_{max}^2`,
    where A (k, q) and B (k, q) are the coefficients of the descriptors on the source and on the
    target. Since the second term is diagonal in the entries of C, each row of C is a small problem
    of its own, solved by a QR factorisation that tells the rank; what descriptors leave open is as
    small as possible.

    Parameters
    ----------
    source, target
        Bases of two surfaces, each taken in the unit in which its area is 1.
    source_descriptors, target_descriptors
        (n_source, q) and (n_target, q), functions that correspond, such as signatures: those of
        ``heat_kernel_signature`` and ``wave_kernel_signature`` if the sizes of the surfaces differ
        only with ``scale_invariant=True``. Each pair counts alike, whatever its size.
    landmarks
        (p, 2) pairs of a source and a target vertex that correspond; each is one more descriptor
        (a unit of mass at the vertex).
    k
        How many eigenpairs of each basis. Default: all there are.
    commutativity
        α >= 0. Surfaces that are no isometric copies want less.

    Returns
    -------
    FunctionalMap
        With the point map that is nearest to C.

    Raises
    ------
    DimensionError, NonFiniteError
        If descriptors do not fit the surfaces or each other.
    MeshError
        If there is no descriptor and no landmark, a landmark is no vertex, or no eigenvalue of a
        basis is above zero.
    BeltramiError
        If k or α are not valid.

    Notes
    -----
    Cost: O(k⁴) for the rows, O(nkq) for the coefficients, and the nearest neighbour of each
    vertex: O(n_source n_target k) at the speed of BLAS, or a KD-tree for up to 16 eigenpairs.

    References
    ----------
    M. Ovsjanikov, M. Ben-Chen, J. Solomon, A. Butscher, L. Guibas: Functional maps: a flexible
    representation of maps between shapes, ACM TOG 31(4), 2012.

    Examples
    --------
    >>> from beltrami.mesh.shapes import blob
    >>> from beltrami.operators.laplacian import laplacian
    >>> from beltrami.spectrum.fourier_basis import fourier_basis
    >>> basis = fourier_basis(laplacian(blob(500)), 30)
    >>> same = functional_map(basis, basis, landmarks=[[v, v] for v in range(0, 500, 10)])
    >>> bool((same.point_map == np.arange(basis.n)).all())
    True
    """
    if not (math.isfinite(commutativity) and commutativity >= 0):
        raise BeltramiError(f"commutativity must be finite and >= 0, not {commutativity}")
    k_source, k_target = (size_of(basis, k) for basis in (source, target))
    A, B = _coefficients(source, target, source_descriptors, target_descriptors, landmarks)
    A, B = A[:k_source], B[:k_target]
    C = _solved(A, B, _penalty(source, target, k_source, k_target, commutativity))
    norm = float(np.linalg.norm(B))
    residual = float(np.linalg.norm(C @ A - B)) / norm if norm > 0 else 0.0
    return with_point_map(C, source, target, residual)


def _coefficients(
    source: FourierBasis,
    target: FourierBasis,
    source_descriptors: ArrayLike | None,
    target_descriptors: ArrayLike | None,
    landmarks: ArrayLike | None,
) -> tuple[Floats, Floats]:
    """Return A and B, the coefficients of all pairs, each pair with the same norm together."""
    left, right = [np.zeros((source.k, 0))], [np.zeros((target.k, 0))]
    if (source_descriptors is None) != (target_descriptors is None):
        raise MeshError("descriptors are needed on both surfaces, or on none")
    if source_descriptors is not None and target_descriptors is not None:
        for basis, given, sides in (
            (source, source_descriptors, left),
            (target, target_descriptors, right),
        ):
            values = as_function(given, basis.n, "the descriptors")
            columns = values.reshape(basis.n, -1)
            sides.append(basis.forward(columns) / math.sqrt(total_mass(basis)))
        if left[-1].shape[1] != right[-1].shape[1]:
            raise DimensionError(
                f"there are {left[-1].shape[1]} descriptors on the source and "
                f"{right[-1].shape[1]} on the target"
            )
    if landmarks is not None:
        pairs = rectangular(landmarks)
        if pairs.ndim != 2 or pairs.shape[1] != 2:
            raise DimensionError("landmarks are pairs (p, 2) of a source and a target vertex")
        for column, (basis, sides) in enumerate(((source, left), (target, right))):
            vertices = as_indices(pairs[:, column], basis.n, "landmarks", repeated=True)
            sides.append(unit_vectors(basis, basis.k)[vertices].T)
    A, B = np.concatenate(left, axis=1), np.concatenate(right, axis=1)
    if not A.shape[1]:
        raise MeshError("a functional map needs descriptors or landmarks")
    norms = np.hypot(np.linalg.norm(A, axis=0), np.linalg.norm(B, axis=0))
    scale = 1 / np.where(norms > 0, norms, 1.0) / math.sqrt(A.shape[1])
    return A * scale, B * scale


def _penalty(
    source: FourierBasis, target: FourierBasis, k_source: int, k_target: int, alpha: float
) -> Floats:
    """Return (k_target, k_source) roots of the weights of the squares of the entries of C."""
    one, two = unit_eigenvalues(source)[:k_source], unit_eigenvalues(target)[:k_target]
    largest = max(one.max(), two.max())
    if largest == 0:
        return np.zeros((k_target, k_source))
    return math.sqrt(alpha) * np.abs(one[None, :] - two[:, None]) / largest


def _solved(A: Floats, B: Floats, penalty: Floats) -> Floats:
    """Minimise |c A - b|² + |penalty c|² row by row."""
    from scipy.linalg import lstsq, qr  # slow to load

    k = len(A)
    Q, R = qr(A.T, mode="economic")  # the same for all rows: at most k equations are left
    right = B @ Q
    rows = [
        lstsq(
            np.concatenate([R, np.diag(penalty[i])]),
            np.concatenate([right[i], np.zeros(k)]),
            cond=_RANK,
            lapack_driver="gelsy",
        )[0]
        for i in range(len(B))
    ]
    return np.array(rows)
