"""FourierBasis: eigenpairs of (L, B), and the transform that they make (definition 19)."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Floats, as_floats, as_function, read_only, read_only_matrix, whole
from beltrami._carded import Carded
from beltrami._kinds import checked
from beltrami.errors import BeltramiError, DimensionError, NonFiniteError
from beltrami.solvers.computation import Computation
from beltrami.spectrum.basis_file import write_basis
from beltrami.spectrum.kernel import Response, evaluate


@dataclass(frozen=True, eq=False, repr=False)
class FourierBasis(Carded):
    r"""Eigenpairs :math:`L\varphi_i = \lambda_i B\varphi_i` with :math:`\Phi^T B\Phi = Id`.

    ``fourier_basis`` makes it. With the degree mass :math:`\varphi = D^{-1/2}u` for the
    eigenvectors u of the normalised Laplacian, and the transform is the :math:`U^T D^{1/2} f` of
    the chapter (E72).

    Chapter items: D19, T8, U27, U28, U29, P50, P57, P64.

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

    @checked
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
        r"""Transform a function: :math:`\hat f = \Phi^T B f`, (n,) to (k,) or (n, c) to (k, c).

        Chapter items: D19, U28.
        """
        return np.asarray(self.eigenvectors.T @ (self.mass @ as_function(f, self.n)))

    def inverse(self, coefficients: ArrayLike) -> Floats:
        r"""Return the function :math:`\Phi\hat f` of the coefficients, (k,) or (k, c).

        Chapter items: D19, U28.
        """
        values = as_floats(coefficients)
        if values.ndim not in (1, 2) or len(values) != self.k:
            raise DimensionError(
                f"coefficients have the shape {values.shape} where ({self.k},) or ({self.k}, c) "
                "is needed"
            )
        if not np.isfinite(values).all():
            raise NonFiniteError("coefficients have values that are NaN or infinite")
        return np.asarray(self.eigenvectors @ values)

    def energy(self, f: ArrayLike) -> Floats:
        r"""Return the energy at each frequency, :math:`|\hat f_i|^2`, (k,) or (k, c).

        With a complete basis they add to :math:`\|f\|_B^2` (Parseval), and weighted with the
        eigenvalues to :math:`\langle Lf, f\rangle`.

        Chapter items: U29, P61.
        """
        return np.asarray(self.forward(f) ** 2)

    @checked
    def filter(self, f: ArrayLike, h: Response | ArrayLike, *, rest: float = 0.0) -> Floats:
        r"""Return :math:`\sum_i h(\lambda_i) \hat f_i \varphi_i`, (n,) or (n, c) as f.

        Chapter items: T13, Q3.10, P46.

        Parameters
        ----------
        h
            A kernel of ``bt.kernels``, a function of the eigenvalues, or (k,) factors.
        rest
            The factor of what lies outside the span of a basis that is not complete: 0 drops it.

        Raises
        ------
        DimensionError, NonFiniteError, BeltramiError
            If f, or the factors, are not as many as needed, or not finite.

        Notes
        -----
        Cost: O(n k), twice; ``bt.filter`` needs no basis, and is often faster (l. 603).
        """
        values = as_function(f, self.n)
        if not math.isfinite(rest):
            raise BeltramiError(f"the factor of the rest must be finite, not {rest}")
        factors = evaluate(h, self.eigenvalues) if callable(h) else self._factors(h)
        coefficients = self.forward(values)
        result = self.inverse((factors * coefficients.T).T)
        return result + rest * (values - self.inverse(coefficients)) if rest else result

    @checked
    def truncate(self, f: ArrayLike, m: int, *, largest: bool = False) -> Floats:
        r"""Return the first m terms, :math:`f_m = \sum_{i<m} \hat f_i \varphi_i` (definition 21).

        The projection of f on the m lowest frequencies, in the norm of B: constants are kept from
        the first term on, and moving a mesh moves its approximation, which is not so if the
        eigenvectors of the normalised Laplacian are taken with plain inner products (E78). It
        leaves out high frequencies, whatever their coefficients (E86).

        With ``largest`` the m terms of the largest :math:`|\hat f_i|` instead, of each column its
        own and of equals the lowest: the best approximation by m terms, which is not linear in f.

        Chapter items: D21, P66.

        Raises
        ------
        BeltramiError
            If m is not a whole number from 0 to k.
        """
        count = whole("the number of terms", m, 0, self.k)
        if largest:
            coefficients = self.forward(f)
            order = np.argsort(-np.abs(coefficients), axis=0, kind="stable")
            np.put_along_axis(coefficients, order[count:], 0.0, axis=0)
            return self.inverse(coefficients)
        kept = self.eigenvectors[:, :count]
        return np.asarray(kept @ (kept.T @ (self.mass @ as_function(f, self.n))))

    @checked
    def error_decay(self, f: ArrayLike, *, largest: bool = False) -> Floats:
        r"""Return the errors :math:`\|f - f_m\|_B` of m = 0, 1 ... k terms, (k + 1,) or (k + 1, c).

        The root of the energy left out, :math:`E(m) = \sum_{i \ge m} \hat f_i^2` (l. 615), and of
        what lies outside the span: sums of small terms first, not differences of large ones. Where
        coefficients decay like :math:`i^{-s}`, E decays like :math:`m^{1-2s}`; the converse fails
        (E79). With ``largest`` the m largest coefficients are kept, as ``truncate`` does then.

        Chapter items: U35, P61, P66.
        """
        values = as_function(f, self.n)
        scale = float(np.abs(values).max(initial=0.0)) or 1.0
        scaled = values / scale
        coefficients = self.forward(scaled)
        outside = scaled - self.inverse(coefficients)
        left = np.maximum((outside * (self.mass @ outside)).sum(axis=0, keepdims=True), 0.0)
        squares = coefficients[::-1] ** 2
        parts = np.concatenate([left, np.sort(squares, axis=0) if largest else squares])
        return np.asarray(scale * np.sqrt(np.cumsum(parts, axis=0)[::-1]))

    def _factors(self, h: ArrayLike) -> Floats:
        """Check given factors, (k,)."""
        factors = as_floats(h)
        if factors.shape != (self.k,):
            raise DimensionError(
                f"a filter has the shape {factors.shape} where ({self.k},) or a function of the "
                "eigenvalues is needed"
            )
        if not np.isfinite(factors).all():
            raise NonFiniteError("the factors of a filter must be finite")
        return factors
