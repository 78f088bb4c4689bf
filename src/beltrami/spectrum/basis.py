"""FourierBasis: eigenpairs of (L, B), and the transform that they make (definition 19)."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Floats, as_function, read_only, read_only_matrix
from beltrami.errors import DimensionError, NonFiniteError
from beltrami.solvers.computation import Computation
from beltrami.spectrum.basis_file import write_basis


@dataclass(frozen=True, eq=False, repr=False)
class FourierBasis:
    r"""Eigenpairs :math:`L\varphi_i = \lambda_i B\varphi_i` with :math:`\Phi^T B\Phi = Id`.

    ``fourier_basis`` makes it. With the degree mass :math:`\varphi = D^{-1/2}u` for the
    eigenvectors u of the normalised Laplacian, and the transform is the :math:`U^T D^{1/2} f` of
    the chapter (E72).

    Chapter items: T8, U27, U28, U29, P50, P57, P64.

    Attributes
    ----------
    eigenvalues : (k,) ascending
    eigenvectors : (n, k), one in each column, B-orthonormal
    mass : (n, n) csr_array B
    residuals : (k,) norms of :math:`L\varphi - \lambda B\varphi` beside :math:`\lambda B\varphi`,
        of constants beside :math:`|L| |\varphi|`
    computation : how they were found: method, precision, steps, seconds, what is proven
    """

    eigenvalues: Floats
    eigenvectors: Floats
    mass: csr_array
    residuals: Floats
    computation: Computation = field(default_factory=Computation)

    def __post_init__(self) -> None:
        for array in (self.eigenvalues, self.eigenvectors, self.residuals):
            read_only(array)
        read_only_matrix(self.mass)

    def __repr__(self) -> str:
        return f"<FourierBasis: {self.k} of {self.n} eigenpairs>"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the basis to a file (npz), as a whole or not at all; ``load_basis`` reads it.

        The same basis gives the same bytes. Size: 8 n (k + 2) bytes.

        Raises
        ------
        OSError
            If the folder does not exist or cannot be written.
        """
        write_basis(
            path,
            self.eigenvalues,
            self.eigenvectors,
            self.mass,
            self.residuals,
            self.computation,
        )

    @property
    def n(self) -> int:
        """Number of vertices n."""
        return int(self.eigenvectors.shape[0])

    @property
    def k(self) -> int:
        """Number of eigenpairs k."""
        return int(self.eigenvectors.shape[1])

    @cached_property
    def orthogonality(self) -> float:
        r"""Largest entry of :math:`\Phi^T B \Phi - Id`; n k² operations, when asked for."""
        gram = self.eigenvectors.T @ (self.mass @ self.eigenvectors)
        return float(np.abs(gram - np.eye(self.k)).max(initial=0.0))

    def forward(self, f: ArrayLike) -> Floats:
        r"""Transform a function: :math:`\hat f = \Phi^T B f`, (n,) to (k,) or (n, c) to (k, c)."""
        return np.asarray(self.eigenvectors.T @ (self.mass @ as_function(f, self.n)))

    def inverse(self, coefficients: ArrayLike) -> Floats:
        r"""Return the function :math:`\Phi\hat f` of the coefficients, (k,) or (k, c)."""
        values = np.asarray(coefficients, dtype=np.float64)
        if values.ndim not in (1, 2) or len(values) != self.k:
            raise DimensionError(
                f"coefficients have the shape {values.shape} where ({self.k},) or ({self.k}, c) "
                "is needed"
            )
        if not np.isfinite(values).all():
            raise NonFiniteError("coefficients have values that are NaN or infinite")
        return np.asarray(self.eigenvectors @ values)
