"""wave_kernel_signature: where a quantum particle of some energy is found (Aubry et al. 2011)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, whole
from beltrami._kinds import checked
from beltrami.errors import BeltramiError, MeshError
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.masses import total_mass
from beltrami.spectrum.null_space import ZERO, positive_modes
from beltrami.spectrum.numbers import as_samples
from beltrami.spectrum.signature import Signature, weighted_squares
from beltrami.spectrum.truncation import missing_modes, missing_squares, worst_ratio

_STEPS = 7  # the width of a band, in steps from one energy to the next (the paper's choice)


@checked
def wave_kernel_signature(
    basis: FourierBasis,
    energies: ArrayLike | None = None,
    *,
    count: int = 100,
    sigma: float | None = None,
    scale_invariant: bool = False,
    tolerance: float = ZERO,
) -> Signature:
    r"""Return :math:`\frac{\sum_i w_i(e) \varphi_i(x)^2}{\sum_i w_i(e)}`, weights of a band (WKS).

    :math:`w_i(e) = \exp(-(e - \log\lambda_i)^2 / 2\sigma^2)`: the probability, over all time, to
    find at x a particle whose energy is about :math:`E = \exp e`. A band-pass, where the heat
    kernel is a low-pass. It does not change under isometries, nor with the choice of eigenvectors
    within an eigenspace, as long as the basis does not end inside of one.

    Parameters
    ----------
    basis
        The k smallest eigenpairs of any pair (L, B).
    energies
        One or q logarithms e of eigenvalues. Default: ``count`` of them, evenly from
        :math:`\log\lambda_{first} + 2\sigma` to :math:`\log\lambda_{last} - 2\sigma`.
    count
        How many energies, if they are not given.
    sigma
        Width of the bands. Default: 7 steps between the energies, which for those of the default
        is :math:`7 \log(\lambda_{last} / \lambda_{first}) / (count + 27)`.
    scale_invariant
        Measure the surface with its own area A as the unit: ``energies`` and those of the result
        are :math:`\log(A\lambda)`, and the values are multiplied by A.
    tolerance
        Eigenvalues up to this part of the largest one of the basis are zero. They have no
        logarithm, and their modes are left out: on a surface of several components the values do
        not tell which is which.

    Returns
    -------
    Signature
        ``values`` (n, q), in length⁻² (no unit if scale-invariant), and ``at``, the energies.
        Modes beyond the basis are left out of both sums; ``truncation`` bounds what they would
        change, and says that energies near the last eigenvalue are those of this basis alone.

    Raises
    ------
    MeshError
        If no eigenvalue is above zero, or one is negative, or all those above zero are equal and
        energies are to be chosen.
    BeltramiError
        If sigma is not positive, an energy is not finite, or no mode of the basis is within
        38 sigma of an energy; if the count is not a whole number >= 2.

    Notes
    -----
    Cost: O(n k q).

    References
    ----------
    M. Aubry, U. Schlickewei, D. Cremers: The wave kernel signature: a quantum mechanical approach
    to shape analysis, ICCV Workshops 2011.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> from beltrami.spectrum.fourier_basis import fourier_basis
    >>> wave = wave_kernel_signature(fourier_basis(laplacian(icosphere(2)), 49), count=10)
    >>> bool(abs(4 * np.pi * wave.values - 1).max() < 0.12)  # the same everywhere on a sphere
    True
    """
    zeros = positive_modes(basis, "the wave kernel", tolerance)
    whole("count", count, least=2)
    unit = total_mass(basis) if scale_invariant else 1.0
    levels = np.log(basis.eigenvalues[zeros:]) + np.log(unit)
    width = _width(levels, energies, count) if sigma is None else float(sigma)
    if not 0 < width < np.inf:
        raise BeltramiError(f"sigma must be positive, not {sigma}")
    if energies is None:
        at = np.linspace(levels[0] + 2 * width, levels[-1] - 2 * width, count)
    else:
        at = as_samples(energies, "energies")
    band = np.exp(-(((at - levels[:, None]) / width) ** 2) / 2)
    sums = band.sum(axis=0)
    if not sums.all():
        far = at[sums == 0]
        raise BeltramiError(
            f"no eigenvalue of the basis is near the energies {far[:5].tolist()}: they must be "
            f"about {levels[0]:.4g} to {levels[-1]:.4g}, or sigma larger than {width:.4g}"
        )
    padded = np.concatenate([np.zeros((zeros, len(at))), band])
    values = weighted_squares(basis, padded)
    # of the modes beyond the last level: none is nearer than it to an energy below it
    edge = np.where(at < levels[-1], band[-1], 1.0)
    lost = np.maximum(
        worst_ratio(np.outer(missing_squares(basis), edge), values),
        edge * missing_modes(basis) / sums,
    )
    return Signature(values / sums * unit, at, "wave", lost)


def _width(levels: Floats, energies: ArrayLike | None, count: int) -> float:
    """Return 7 steps between the energies, given or to be chosen 2 sigma inside the levels."""
    span = levels[-1] - levels[0]
    if energies is not None:
        given = as_samples(energies, "energies")
        if len(given) > 1 and np.ptp(given) > 0:
            return float(_STEPS * np.ptp(given) / (len(given) - 1))
    if span <= ZERO:
        raise MeshError(
            "the energies need two different eigenvalues above zero",
            remedy="Ask fourier_basis for more eigenpairs, or give sigma.",
        )
    # step = (span - 4 sigma) / (count - 1) and sigma = 7 step
    return float(_STEPS * span / (count - 1 + 4 * _STEPS))
