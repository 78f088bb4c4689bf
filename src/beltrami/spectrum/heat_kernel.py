"""heat_kernel_signature: how much heat stays where it was (Sun, Ovsjanikov, Guibas 2009)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, whole
from beltrami._kinds import checked
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.masses import total_mass
from beltrami.spectrum.null_space import ZERO, positive_modes, true_zeros
from beltrami.spectrum.numbers import as_samples
from beltrami.spectrum.signature import Signature, weighted_squares
from beltrami.spectrum.truncation import missing_squares, worst_ratio


@checked
def heat_kernel_signature(
    basis: FourierBasis,
    times: ArrayLike | None = None,
    *,
    count: int = 100,
    scale_invariant: bool = False,
    tolerance: float = ZERO,
) -> Signature:
    r"""Return :math:`h(x, t) = k_t(x, x) = \sum_i e^{-\lambda_i t} \varphi_i(x)^2` (HKS).

    The heat at x at the time t after a unit of it was put there. For short times it is
    :math:`(1 + K t / 3 + \dots) / 4\pi t` with the Gaussian curvature K; for long ones it tends to
    1 / area of the component. It does not change under isometries, nor with the choice of
    eigenvectors within an eigenspace, as long as the basis does not end inside of one.

    Parameters
    ----------
    basis
        The k smallest eigenpairs of any pair (L, B).
    times
        One or q times, >= 0, in length² with area masses. Default: ``count`` of them, evenly
        in the logarithm, from :math:`4 \ln 10 / \lambda_{last}` to
        :math:`4 \ln 10 / \lambda_{first}` (the largest and the least eigenvalue above zero), as in
        the paper: there the last mode, and then the first, has decayed to 1e-4.
    count
        How many times, if they are not given.
    scale_invariant
        Measure the surface with its own area A as the unit: ``times`` and those of the result
        count in A, and the values are :math:`A h(x, A t)`, the same for every size.
    tolerance
        Eigenvalues up to this part of the largest one of the basis are zero exactly: one for each
        component. Their modes stay in the sum.

    Returns
    -------
    Signature
        ``values`` (n, q), in length⁻² (no unit if scale-invariant), and ``at``, the times.
        Modes beyond the basis are left out: values are too low by
        :math:`e^{-\lambda_k t}(1/b_x - \sum_i \varphi_i(x)^2)` at most, and ``truncation`` is the
        largest of these beside its value.

    Raises
    ------
    MeshError
        If times are to be chosen and no eigenvalue is above zero, or one is negative.
    BeltramiError
        If a time is negative, or the count is not a whole number >= 1.

    Notes
    -----
    Cost: O(n k q).

    References
    ----------
    J. Sun, M. Ovsjanikov, L. Guibas: A concise and provably informative multi-scale signature
    based on heat diffusion, SGP 2009.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> from beltrami.spectrum.fourier_basis import fourier_basis
    >>> heat = heat_kernel_signature(fourier_basis(laplacian(icosphere(2)), 49), [0.5, 3.0])
    >>> exact = [sum((2 * l + 1) * np.exp(-l * (l + 1) * t) for l in range(7)) / (4 * np.pi)
    ...          for t in heat.at]
    >>> (heat.values.mean(axis=0) / exact).round(1).tolist(), bool(heat.truncation.max() < 1e-3)
    ([1.0, 1.0], True)
    """
    whole("count", count, least=1)
    unit = total_mass(basis) if scale_invariant else 1.0
    if times is None:
        at = _automatic(basis, count, tolerance) / unit
    else:
        at = as_samples(times, "times", positive=True)
    with np.errstate(over="ignore"):  # e to the minus infinity is 0
        decay = np.exp(-np.outer(true_zeros(basis, tolerance) * unit, at))
    values = weighted_squares(basis, decay)
    missing = np.outer(missing_squares(basis), decay[-1])
    return Signature(values * unit, at, "heat", worst_ratio(missing, values))


def _automatic(basis: FourierBasis, count: int, tolerance: float) -> Floats:
    """Return times at which first the last and at the end the first mode has decayed to 1e-4."""
    zeros = positive_modes(basis, "the choice of times", tolerance)
    shortest, longest = 4 * np.log(10) / basis.eigenvalues[[-1, zeros]]
    return np.asarray(np.geomspace(shortest, longest, count))
