"""Projection onto the span of some functions (l. 121 of the chapter)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import cho_factor, cho_solve

from beltrami._arrays import Floats, as_function
from beltrami.errors import DimensionError, SingularMatrixError
from beltrami.operators.domain import require_laplacian
from beltrami.operators.pair import Laplacian

_DEPENDENT = 1e-13  # least eigenvalue of the products of functions of norm 1


def project(laplacian: Laplacian, f: ArrayLike, basis: ArrayLike) -> Floats:
    r"""Return the function of span(basis) that is nearest to f in the norm of the mass B.

    :math:`P f = \Phi (\Phi^T B \Phi)^{-1} \Phi^T B f`; what is left, f - P f, is B-orthogonal to
    the basis, and :math:`\|f\|_B^2 = \|Pf\|_B^2 + \|f - Pf\|_B^2`. Cost: O(n k²).

    Chapter items: D6, P14.

    Parameters
    ----------
    laplacian
        The pair whose mass measures lengths.
    f
        (n,) or (n, c).
    basis
        (n, k) functions, independent, not necessarily orthogonal; or one of them, (n,).

    Returns
    -------
    (n,) or (n, c), as f.

    Raises
    ------
    DimensionError, NonFiniteError
        If f or the basis are no functions on the vertices, or the basis is empty.
    SingularMatrixError
        If the functions of the basis depend on each other.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> sphere = icosphere(2)
    >>> pair = laplacian(sphere)
    >>> x, y, z = sphere.vertices.T
    >>> nearest = project(pair, x**3, sphere.vertices)  # 3/5 x, about, on a sphere
    >>> round(pair.inner(nearest, x) / pair.inner(x, x), 2)
    0.6
    >>> round(abs(pair.inner(x**3 - nearest, x)), 9)
    0.0
    """
    require_laplacian(laplacian, "a projection")
    values = as_function(f, laplacian.n)
    functions = as_function(basis, laplacian.n, "the basis").reshape(laplacian.n, -1)
    if not functions.shape[1]:
        raise DimensionError("the basis has no functions")
    largest = np.abs(functions).max(axis=0)
    if not (largest > 0).all():
        raise SingularMatrixError("a function of the basis is zero")
    functions = functions / largest  # so that no square overflows
    weighted = laplacian.mass @ functions
    norms = np.sqrt(np.einsum("ik,ik->k", functions, weighted))
    functions, weighted = functions / norms, weighted / norms
    products = functions.T @ weighted
    if np.linalg.eigvalsh(products)[0] < _DEPENDENT * len(products):
        raise SingularMatrixError("the functions of the basis depend on each other")
    factor = cho_factor(products)
    nearest = functions @ cho_solve(factor, weighted.T @ values)
    nearest += functions @ cho_solve(factor, weighted.T @ (values - nearest))  # what was rounded
    return np.asarray(nearest)
