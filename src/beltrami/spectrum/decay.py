"""decay_bound: the coefficients of smooth functions decay with the eigenvalue."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_function, rectangular
from beltrami.errors import BeltramiError
from beltrami.operators.pair import Laplacian
from beltrami.spectrum.operator import as_operator
from beltrami.spectrum.whole import whole


def decay_bound(laplacian: Laplacian, f: ArrayLike, eigenvalues: ArrayLike, power: int) -> Floats:
    r"""Return :math:`\lambda^{-k}\,\|(B^{-1}L)^k f\|_B`, which bounds :math:`|\hat f|` at λ.

    For :math:`\langle f, \varphi\rangle_B = \lambda^{-k} \langle (B^{-1}L)^k f, \varphi\rangle_B`,
    exactly, and φ has the norm 1. On a surface the operator is -Δ, so that in terms of Δ there is a
    sign :math:`(-1)^k`, and with the largest value of :math:`|\Delta^k f|` for the norm a factor
    :math:`\sqrt{\mathrm{Area}}`, which the printed bound lacks; a function of class C^a has k = a/2
    (E84). Where a surface ends, f must satisfy the boundary conditions, else
    :math:`\|(B^{-1}L)^k f\|` grows as the mesh is refined (E85). The error of m terms follows:
    :math:`E(m) \le \lambda_{m+1}^{-2k}\,\|(B^{-1}L)^k f\|_B^2`.

    Chapter items: U37, P63.

    Parameters
    ----------
    f
        (n,) or (n, c).
    eigenvalues
        λ > 0, (q,); 0, at which nothing is known, gives infinity.
    power
        k, a whole number from 0 to 20: how often the operator is applied.

    Returns
    -------
    (q,) or (q, c). Unit: that of f times the root of the mass.

    Raises
    ------
    DimensionError, NonFiniteError, BeltramiError
        If f is no function of the mesh, or the numbers are not valid.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> mesh = icosphere(2)
    >>> decay_bound(laplacian(mesh), mesh.vertices[:, 2], [2.0, 6.0, 12.0], 2).round(2)
    array([2.13, 0.24, 0.06])
    """
    values = as_function(f, laplacian.n)
    x = rectangular(eigenvalues).astype(np.float64)
    count = whole("the power", power, 0, 20)
    if x.ndim != 1 or not (np.isfinite(x) & (x >= 0)).all():
        raise BeltramiError("eigenvalues are finite numbers >= 0, in one row")
    apply = as_operator(laplacian)
    for _ in range(count):
        values = apply(values)
    norms = np.sqrt((values * (laplacian.mass @ values)).sum(axis=0))
    with np.errstate(divide="ignore"):
        factors = x ** -float(count)
    return np.multiply.outer(factors, norms)
