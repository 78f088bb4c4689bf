"""filter: apply a function of the Laplacian, without its eigenvectors."""

from __future__ import annotations

import math

from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_function, whole
from beltrami._kinds import checked, require_kind
from beltrami._progress import Progress
from beltrami.errors import BeltramiError, DimensionError, check_name
from beltrami.operators.domain import require_laplacian
from beltrami.operators.pair import Laplacian
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.chebyshev import chebyshev_series
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.interval import spectral_interval
from beltrami.spectrum.kernel import Response
from beltrami.spectrum.lanczos import lanczos_filter
from beltrami.spectrum.recurrence import chebyshev_sums

FILTER_METHODS = ("chebyshev", "exact", "lanczos")
_LARGEST_DENSE = 4000  # vertices: three matrices of 128 MB each


@checked
def filter(  # noqa: A001
    laplacian: Laplacian,
    f: ArrayLike,
    h: Response,
    method: str = "chebyshev",
    *,
    tolerance: float = 1e-8,
    order: int | None = None,
    basis: FourierBasis | None = None,
    progress: Progress | None = None,
) -> Floats:
    r"""Return :math:`h(B^{-1}L) f = \sum_i h(\lambda_i) \langle f, \varphi_i\rangle_B\, \varphi_i`.

    Heat, waves, regularisation and other linear equations with the Laplacian are filters (l. 421);
    done directly they cost a few products with the matrix and no eigenvectors (l. 603).

    Chapter items: T13, Q3.10, P46, P59.

    Parameters
    ----------
    laplacian
        The pair (L, B), with any mass.
    f
        (n,) or (n, c): each column is filtered.
    h
        A kernel of ``bt.kernels``, or a function of an array of eigenvalues. λ has the unit
        1/length² with area masses, none with the degree mass.
    method
        ``"chebyshev"``: a polynomial, by a three-term recurrence; its order follows from the
        tolerance. ``"lanczos"``: in the Krylov space of each column; it needs fewer products where
        the bound on the spectrum is far from the truth, and finds jumps between eigenvalues of
        small meshes, but keeps all its vectors, and its error is an estimate. ``"exact"``: through
        all eigenvectors, for at most 4000 vertices or with a complete ``basis``.
    tolerance
        Error wanted in the norm of B, beside \|f\|_B times the largest \|h\| over the spectrum.
    order
        Degree of the polynomial, or number of Lanczos vectors: taken as it is, and then nothing is
        promised (``chebyshev_series`` tells the error). Default: what the tolerance needs.
    basis
        A complete basis of this pair, for ``"exact"``.
    progress
        Called with (steps done, steps in all).

    Returns
    -------
    (n,) or (n, c), as f.

    Raises
    ------
    ApproximationError
        If the tolerance is not reached: where h jumps no polynomial comes near, and says so.
    MeshError
        If no bound on the spectrum is known, or a mass is not positive; if the mesh is too large
        for ``"exact"``, or the basis incomplete.
    DimensionError, NonFiniteError, UnknownNameError, BeltramiError
        If f, h, the method or the numbers are not valid.

    Notes
    -----
    Cost of Chebyshev: N products with L for the order N, which grows like the root of the time of
    heat; the direct way wins over a basis of k vectors as long as N nnz(L) < n k, even if the basis
    comes for free.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> from beltrami.spectrum.kernels import Heat
    >>> mesh = icosphere(3)
    >>> pair = laplacian(mesh)
    >>> z = mesh.vertices[:, 2]  # an eigenfunction, with λ = 2 on the smooth sphere
    >>> ratio = filter(pair, z, Heat(0.5)) @ z / (z @ z)
    >>> round(float(ratio), 2)  # exp(-1)
    0.37
    """
    check_name("method of filtering", method, FILTER_METHODS)
    require_laplacian(laplacian, "filters")
    values = as_function(f, laplacian.n)
    if not (tolerance > 0 and math.isfinite(tolerance)):
        raise BeltramiError(f"tolerance must be finite and > 0, not {tolerance}")
    count = None if order is None else whole("order", order, 1, 10**6)
    if basis is not None and method != "exact":
        raise BeltramiError('a basis serves method="exact": the other methods need none')
    if method == "exact":
        if count is not None:
            raise BeltramiError("an exact filter has no order")
        require_kind("basis", basis, ("FourierBasis", "None"))
        return _complete_basis(laplacian, basis).filter(values, h)
    interval = spectral_interval(laplacian)
    columns = values.reshape(laplacian.n, -1)
    if method == "chebyshev":
        series = chebyshev_series(h, interval, tolerance, count)
        found = chebyshev_sums(laplacian, columns, [series], progress)[0]
    else:
        found = lanczos_filter(
            laplacian, columns, h, interval, tolerance=tolerance, order=count, progress=progress
        )
    return found.reshape(values.shape)


def _complete_basis(laplacian: Laplacian, basis: FourierBasis | None) -> FourierBasis:
    """Return all eigenpairs: those given, or computed ones if the mesh is small."""
    n = laplacian.n
    if basis is None and n > _LARGEST_DENSE:
        raise DimensionError(
            f"all {n} eigenvectors are too many to compute: {_LARGEST_DENSE} vertices at most",
            remedy='Use method="chebyshev", or fourier_basis(laplacian, k).filter(f, h) if h is '
            "small beyond the first k eigenvalues.",
        )
    if basis is not None and (basis.n != n or basis.k != n):
        raise DimensionError(
            f"an exact filter on {n} vertices needs all eigenpairs, and the basis has {basis.k} of "
            f"{basis.n}",
            remedy="basis.filter(f, h) filters within its span.",
        )
    return fourier_basis(laplacian, n) if basis is None else basis
