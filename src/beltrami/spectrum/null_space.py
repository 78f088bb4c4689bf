"""The kernel of L in a basis: which of its eigenvalues are zero, and what that parts."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Booleans, Floats
from beltrami.errors import BeltramiError, MeshError
from beltrami.spectrum.basis import FourierBasis

ZERO = 1e-9  # beside the largest eigenvalue of the basis: rounding leaves 1e-16 to 1e-12
_NOISE = 0.1  # the residual of an eigenvalue without digits


def kernel_size(basis: FourierBasis, tolerance: float = ZERO) -> int:
    r"""Count the eigenvalues that are zero: :math:`\lambda_i \le` tolerance :math:`\lambda_k`.

    There is one for each component of the surface (theorem 7), if the basis is as long. Where
    the last eigenpair has a residual above 0.1, its eigenvalue is rounding and nothing else: the
    basis has nothing but the kernel.

    Chapter items: T7.

    Raises
    ------
    BeltramiError
        If the tolerance is not in [0, 1).
    MeshError
        If an eigenvalue is negative beyond the tolerance: weights of yours can do that, and then
        heat grows and no distance is real.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> from beltrami.spectrum.fourier_basis import fourier_basis
    >>> kernel_size(fourier_basis(laplacian(icosphere(1)), 5))
    1
    """
    if not 0 <= tolerance < 1:
        raise BeltramiError(f"the tolerance of zero must be in [0, 1), not {tolerance}")
    if not basis.k:
        raise MeshError("the basis is empty", remedy="Ask fourier_basis for more eigenpairs.")
    values = basis.eigenvalues
    if basis.residuals[-1] > _NOISE:
        return basis.k
    limit = tolerance * abs(values[-1])
    if values[0] < -limit:
        raise MeshError(
            f"the basis has a negative eigenvalue, {values[0]:.6g}: the Laplacian is not positive "
            "semi-definite",
            remedy="Use cotangent weights, or weights that are not negative.",
        )
    return int(np.count_nonzero(values <= limit))


def positive_modes(basis: FourierBasis, what: str, tolerance: float = ZERO) -> int:
    """Return the number of zero eigenvalues; MeshError if there is none behind them."""
    zeros = kernel_size(basis, tolerance)
    if zeros == basis.k:
        raise MeshError(
            f"{what} needs an eigenvalue above zero, and the {basis.k} of the basis are all zero",
            remedy="Ask fourier_basis for more eigenpairs than there are components.",
        )
    return zeros


def true_zeros(basis: FourierBasis, tolerance: float = ZERO) -> Floats:
    """Return the (k,) eigenvalues, with those that are zero exactly so."""
    values = basis.eigenvalues.copy()
    values[: kernel_size(basis, tolerance)] = 0.0
    return values


def apart(basis: FourierBasis, vertex: int, tolerance: float = ZERO) -> Booleans:
    """Mark the (n,) vertices in other components than this one, all of whose zeros must be there.

    The rows of the zero eigenvectors are equal within a component and orthogonal between two: a
    squared difference is then 0 or the sum of the two squares.
    """
    rows = basis.eigenvectors[:, : kernel_size(basis, tolerance)]
    squares = (rows**2).sum(axis=1)
    gap = ((rows - rows[vertex]) ** 2).sum(axis=1)
    return np.asarray(gap > 0.5 * (squares + squares[vertex]))
