"""Heat and waves frequency by frequency (equation 3.10, section 3.3.4)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from beltrami._arrays import Floats
from beltrami._kinds import require_kind
from beltrami.diffusion.held import FreePart
from beltrami.errors import BeltramiError, TruncationError
from beltrami.spectrum.basis import FourierBasis

MOST_DENSE = 2000  # free vertices of which all eigenpairs are computed: some seconds
_MATCHING = 1e-3  # a basis with larger residuals is that of another pair


@dataclass(frozen=True, eq=False)
class Modes:
    """Eigenpairs of (K, M) on the free vertices.

    Attributes
    ----------
    part : FreePart
    values : (k,) λ >= 0
    vectors : (q, k), orthonormal for M
    """

    part: FreePart
    values: Floats
    vectors: Floats

    def forward(self, u: Floats) -> Floats:
        """Return the coefficients (k,) or (k, c)."""
        return np.asarray(self.vectors.T @ (self.part.mass @ u))

    def multiplied(self, coefficients: Floats, factors: Floats) -> Floats:
        """Return the function with these coefficients, each times its factor."""
        return np.asarray(self.vectors @ (coefficients.T * factors).T)

    def left_out(self, u: Floats) -> float:
        """Return the norm, for M, of what no mode of these represents."""
        if len(self.values) == len(u):
            return 0.0
        return norm(self.part, u - self.vectors @ self.forward(u))

    def decayed(self, u: Floats, time: float, tolerance: float) -> Floats:
        r"""Return :math:`e^{-t M^{-1}K} u`, each coefficient times exp(-λt) (equation 3.10).

        Raises
        ------
        TruncationError
            If what is left out may be more than the tolerance times the norm of u.
        """
        rest = self.left_out(u) * float(np.exp(-time * self.values[-1]))
        require_complete(rest, norm(self.part, u), tolerance, len(self.values))
        return self.multiplied(self.forward(u), np.exp(-time * self.values))


def find_modes(part: FreePart, basis: FourierBasis | None) -> Modes:
    """Take the modes of a basis, or compute all of a small pair.

    Raises
    ------
    BeltramiError
        If there is no basis and the pair is large, or the basis is that of another pair.
    """
    require_kind("basis", basis, ("FourierBasis", "None"))
    q = part.stiffness.shape[0]
    if basis is None:
        if q > MOST_DENSE:
            raise BeltramiError(
                f"the spectral method computes all eigenpairs only up to {MOST_DENSE} free "
                f"vertices, and here are {q}: give basis=fourier_basis(laplacian, k)"
            )
        values, vectors = scipy.linalg.eigh(part.stiffness.toarray(), part.mass.toarray())
        return Modes(part, np.maximum(values, 0), vectors)
    if basis.n != len(part.free):
        raise BeltramiError(f"the basis is one of {basis.n} vertices, not of {len(part.free)}")
    if basis.eigenvectors[~part.free].any():
        raise BeltramiError(
            "the functions of the basis are not zero at the held vertices. Leave the basis out "
            "(small meshes), or use another method"
        )
    modes = Modes(part, np.maximum(basis.eigenvalues, 0), basis.eigenvectors[part.free])
    last, value = modes.vectors[:, -1], modes.values[-1]
    force, own = part.stiffness @ last, value * (part.mass @ last)
    scale = np.linalg.norm(abs(part.stiffness) @ np.abs(last)) + np.linalg.norm(own)
    length = float(last @ (part.mass @ last))
    if np.linalg.norm(force - own) > _MATCHING * scale or abs(length - 1) > _MATCHING:
        raise BeltramiError("the basis is that of another pair: L φ = λ B φ does not hold")
    return modes


def norm(part: FreePart, u: Floats) -> float:
    """Return the norm of u for M, over all columns."""
    return float(np.sqrt(max(np.vdot(u, part.mass @ u), 0.0)))


def require_complete(rest: float, scale: float, tolerance: float, count: int) -> None:
    """Raise TruncationError if the rest is more than the tolerance allows."""
    if rest > tolerance * scale:
        raise TruncationError(rest / scale, count)
