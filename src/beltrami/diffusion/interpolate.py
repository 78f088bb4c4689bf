"""interpolate: a smooth function through given values (hard constraints)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Floats
from beltrami._kinds import checked
from beltrami.diffusion.held import FreePart, free_part, held_values, positions_of
from beltrami.errors import BeltramiError, MeshError
from beltrami.operators.areas import diagonal_matrix
from beltrami.operators.domain import require_laplacian
from beltrami.operators.pair import Laplacian
from beltrami.solvers.factorize import factorize


@checked
def interpolate(
    laplacian: Laplacian, vertices: ArrayLike, values: ArrayLike, order: int = 1
) -> Floats:
    r"""Return the smoothest function with given values at some vertices.

    Order 1 is harmonic: it minimises :math:`\langle Lf, f\rangle`, so Lf = 0 at the other
    vertices. Where weights are positive it stays between the least and the largest value, and it
    has a peak at a value that stands alone (in the limit of fine meshes it ignores it). Order 2 is
    biharmonic: it minimises :math:`\|B^{-1} L f\|_B^2 = \langle L B^{-1} L f, f\rangle`, and
    passes smoothly through every value, which it may overshoot.

    Parameters
    ----------
    laplacian
        The pair (L, B).
    vertices
        h vertices, indices or a mask; at least one in each component.
    values
        One number, (h,) or (h, c), in the order of the indices.
    order
        1 or 2.

    Returns
    -------
    (n,) or (n, c)

    Raises
    ------
    MeshError
        If a component has no value, all vertices have one, or a vertex has two; or if the order is
        2 and the mass is not diagonal.
    NegativeWeightError
        If L is not known to be positive semi-definite.
    DimensionError, NonFiniteError, BeltramiError
        If the values, their number or the order are not valid.

    Notes
    -----
    For values with noise see ``regularize`` with weights. At a boundary order 2 keeps the
    derivative across it at zero, because L does. Cost: one factorisation, for order 2 of a matrix
    with the second neighbours, whose condition grows like the fourth power of 1 / edge length.

    Examples
    --------
    >>> from beltrami.mesh.shapes import grid
    >>> from beltrami.operators.laplacian import laplacian
    >>> sheet = grid(4, 4)
    >>> x = sheet.vertices[:, 0]
    >>> ends = (x == 0) | (x == 1)
    >>> bool(abs(interpolate(laplacian(sheet), ends, x[ends]) - x).max() < 1e-12)
    True
    """
    if order not in (1, 2):
        raise BeltramiError(f"the order of interpolation is 1 or 2, not {order}")
    require_laplacian(laplacian, "interpolation")
    laplacian.require_semi_definite("interpolation")
    held, fixed = held_values(vertices, values, laplacian.n)
    positions = positions_of(laplacian)
    part = free_part(laplacian.stiffness, laplacian.mass, held, positions)
    require_reached(part, "no value is given")
    result = np.empty((laplacian.n, *fixed.shape[1:]))
    result[held] = fixed
    if order == 2:
        part = free_part(_squared(laplacian), laplacian.mass, held, positions)
    factor = factorize(part.stiffness, part.positions)
    result[part.free] = factor.solve(-(part.stiffness_border @ fixed))
    return result


def require_reached(part: FreePart, problem: str) -> None:
    """Raise MeshError, with one vertex of each, if components float: nothing fixes them.

    Examples
    --------
    >>> L = csr_array([[1.0, -1], [-1, 1]])
    >>> require_reached(free_part(L, csr_array(np.eye(2)), np.zeros(2, bool)), "no value is given")
    Traceback (most recent call last):
        ...
    beltrami.errors.MeshError: no value is given in 1 component (vertices 0). Name a vertex there,
    or drop the component.
    """
    count = part.floating.shape[1]
    if count:
        raise MeshError(
            f"{problem} in {count} component{'s' if count > 1 else ''}",
            vertices=np.flatnonzero(part.free)[part.pins],
            remedy="Name a vertex there, or drop the component.",
        )


def _squared(laplacian: Laplacian) -> csr_array:
    """Return L B⁻¹ L."""
    if laplacian.mass_kind == "consistent":
        raise MeshError(
            "biharmonic interpolation needs a diagonal mass, and the consistent mass is not",
            remedy='Use mass="voronoi".',
        )
    inverse = diagonal_matrix(1 / laplacian.masses)
    return csr_array(laplacian.stiffness @ inverse @ laplacian.stiffness)
