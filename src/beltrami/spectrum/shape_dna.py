"""shape_dna: the spectrum itself as a fingerprint (Reuter, Wolter, Peinecke 2006)."""

from __future__ import annotations

from beltrami._arrays import Floats
from beltrami._kinds import checked
from beltrami.errors import check_name
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.masses import total_mass
from beltrami.spectrum.null_space import ZERO, positive_modes, true_zeros

NORMALIZATIONS = ("area", "first", "none")


@checked
def shape_dna(
    basis: FourierBasis, normalization: str = "area", *, tolerance: float = ZERO
) -> Floats:
    r"""Return the (k,) eigenvalues, ascending, in a unit that serves comparison.

    Equal for isometric surfaces, and the same whatever the vertices are called; but there are
    surfaces that sound alike and are not. Compare two of equal length, say by the Euclidean
    distance.

    Parameters
    ----------
    basis
        The k smallest eigenpairs of any pair (L, B).
    normalization
        ``"area"``: :math:`A \lambda_i` with :math:`A = \langle 1, 1\rangle_B`, which grows like
        :math:`4\pi i` on every surface (Weyl). ``"first"``: :math:`\lambda_i / \lambda_1` with the
        first eigenvalue above zero. Both have no unit and are the same for every size.
        ``"none"``: :math:`\lambda_i` itself, in length⁻² with area masses.
    tolerance
        Eigenvalues up to this part of the largest one are zero exactly: one for each component.
        They are kept, so that entry i is that of mode i.

    Raises
    ------
    MeshError
        If an eigenvalue is negative; with ``"first"``, if none is above zero.
    UnknownNameError
        If there is no such normalization.

    References
    ----------
    M. Reuter, F.-E. Wolter, N. Peinecke: Laplace-Beltrami spectra as "Shape-DNA" of surfaces and
    solids, Computer-Aided Design 38, 2006.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> from beltrami.spectrum.fourier_basis import fourier_basis
    >>> shape_dna(fourier_basis(laplacian(icosphere(2)), 5), "first").round(1).tolist()
    [0.0, 1.0, 1.0, 1.0, 2.9]
    """
    check_name("normalization", normalization, NORMALIZATIONS)
    values = true_zeros(basis, tolerance)
    if normalization == "area":
        return values * total_mass(basis)
    if normalization == "first":
        return values / values[positive_modes(basis, "the normalization", tolerance)]
    return values
