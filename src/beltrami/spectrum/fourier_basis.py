"""fourier_basis: the smallest eigenpairs of a pair (L, B)."""

from __future__ import annotations

import numpy as np
import scipy.linalg

from beltrami.operators.pair import Laplacian
from beltrami.spectrum.basis import FourierBasis


def fourier_basis(laplacian: Laplacian, k: int) -> FourierBasis:
    r"""Return the k smallest eigenpairs of (L, B), :math:`L\varphi = \lambda B\varphi`.

    Cost: O(n³) operations and O(n²) memory.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> fourier_basis(laplacian(icosphere(2)), 4).eigenvalues.round(1).tolist()
    [0.0, 2.0, 2.0, 2.0]
    """
    L, B = laplacian.stiffness, laplacian.mass
    values, vectors = scipy.linalg.eigh(L.toarray(), B.toarray(), subset_by_index=[0, k - 1])
    heaviest = np.abs(vectors).argmax(axis=0)
    vectors = vectors * np.where(vectors[heaviest, np.arange(k)] < 0, -1.0, 1.0)
    values = np.abs(values)
    force = values * (B @ vectors)
    norm = np.linalg.norm(L @ vectors - force, axis=0)
    residuals = norm / np.maximum(np.linalg.norm(force, axis=0), np.finfo(float).tiny)
    return FourierBasis(values, vectors, B, residuals)
