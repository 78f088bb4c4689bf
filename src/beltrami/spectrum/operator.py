"""B⁻¹L as a function, for any mass."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from beltrami._arrays import Floats
from beltrami.operators.pair import Laplacian
from beltrami.solvers.factorize import factorize

Operator: TypeAlias = Callable[[Floats], Floats]


def as_operator(laplacian: Laplacian) -> Operator:
    r"""Return the function that applies :math:`B^{-1}L` to (n,) or (n, c) values.

    ``laplacian.apply`` for diagonal masses, without its checks; the consistent mass is factorised,
    once.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami.mesh.mesh import Mesh
    >>> from beltrami.operators.laplacian import laplacian
    >>> triangle = Mesh([[0, 0], [2, 0], [0, 1]], [[0, 1, 2]])
    >>> as_operator(laplacian(triangle, mass="consistent"))(np.array([0.0, 1.0, 1.0])).round(9)
    array([-15.,   3.,  12.])
    """
    stiffness, masses = laplacian.stiffness, laplacian.masses
    if laplacian.mass_kind == "consistent":
        factor = factorize(laplacian.mass)
        return lambda x: factor.solve(stiffness @ x)
    return lambda x: ((stiffness @ x).T / masses).T
