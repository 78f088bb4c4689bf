"""The Poisson equation B⁻¹ L u = ρ, plain and screened (section 3.2.5, E44)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Floats, as_function
from beltrami._kinds import checked
from beltrami.diffusion.held import FreePart, free_part, held_values, positions_of
from beltrami.diffusion.steady import steady_state
from beltrami.errors import BeltramiError, DimensionError, IncompatibleError
from beltrami.operators.domain import require_laplacian
from beltrami.operators.pair import Laplacian
from beltrami.solvers.factorize import factorize

_ROUNDING = 1e-9  # of the mean of |ρ|: what its mean may be off
_NAMED = 3  # components in a message


@checked
def poisson(
    laplacian: Laplacian,
    right: ArrayLike,
    *,
    hold: ArrayLike = (),
    values: ArrayLike = 0.0,
    screen: float = 0.0,
    integrated: bool = False,
    project: bool = False,
) -> Floats:
    r"""Solve :math:`(B^{-1} L + \sigma) u = \rho`, that is :math:`-\Delta u + \sigma u = \rho`.

    L is only semi-definite: constants have no energy (E44). So without a screen and without held
    values there is a solution only if the mean of ρ is zero, in each component; it is then fixed
    up to a constant, and the one of mean zero (in the mass B) is returned. No flux crosses the
    boundary, where no values are held.

    Chapter items: P34, P46.

    Parameters
    ----------
    laplacian
        The pair (L, B). L is positive: at a maximum of u, ρ is positive.
    right
        (n,) or (n, c): ρ, each column a problem of its own. Not used at held vertices.
    hold, values
        Vertices (indices or a mask) with given values: one number, (h,) or (h, c), in the order
        of the indices.
    screen
        σ >= 0, in 1 / length² with area masses.
    integrated
        ``right`` is B ρ already, as a divergence is: solve L u + σ B u = right.
    project
        Subtract from ρ its mean in each component where it must be zero, instead of refusing it.

    Returns
    -------
    (n,) or (n, c), as ``right``; (n, c) if the values are (h, c).

    Raises
    ------
    IncompatibleError
        If ρ has a mean where there is no solution then; the error names the components.
    NegativeWeightError
        If L is not known to be positive semi-definite.
    MeshError, DimensionError, NonFiniteError, BeltramiError
        If the numbers, the vertices or the shapes are not valid, or all vertices are held.

    Notes
    -----
    Cost: one factorisation for all columns.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> sphere = icosphere(4)
    >>> z = sphere.vertices[:, 2]
    >>> u = poisson(laplacian(sphere), z)  # -Δz = 2z on the unit sphere
    >>> bool(abs(u - z / 2).max() < 1e-4)
    True
    """
    require_laplacian(laplacian, "a Poisson problem")
    laplacian.require_semi_definite("a Poisson problem")
    given = as_function(right, laplacian.n, "the right-hand side")
    held, fixed = held_values(hold, values, laplacian.n)
    if not (math.isfinite(screen) and screen >= 0):
        raise BeltramiError(f"screen must be finite and >= 0, not {screen}")
    load, fixed = _alike(given if integrated else laplacian.mass @ given, fixed)
    result = np.empty_like(load)
    result[held] = fixed
    part = free_part(laplacian.stiffness, laplacian.mass, held, positions_of(laplacian))
    inner = load[part.free] - part.stiffness_border @ fixed
    if screen > 0:
        matrix = csr_array(part.stiffness + screen * part.mass)
        result[part.free] = _screened(part, matrix, inner - screen * (part.mass_border @ fixed))
        return result
    if not project and len(part.pins):
        _require_compatible(part, inner)
    result[part.free] = steady_state(part, inner - part.mass @ part.level(inner))
    return result


def _screened(part: FreePart, matrix: csr_array, load: Floats) -> Floats:
    return factorize(matrix, part.positions).solve(load)


def _alike(load: Floats, fixed: Floats) -> tuple[Floats, Floats]:
    """Give the right-hand side and the held values the same number of columns."""
    if fixed.ndim == load.ndim == 1:
        return load, fixed
    columns = {a.shape[1] for a in (load, fixed) if a.ndim == 2}
    if len(columns) > 1:
        raise DimensionError(
            f"the right-hand side has {load.shape[1]} columns, and the values {fixed.shape[1]}"
        )
    c = columns.pop()
    both = (a if a.ndim == 2 else np.repeat(a[:, None], c, axis=1) for a in (load, fixed))
    wide, narrow = both
    return wide, narrow


def _require_compatible(part: FreePart, load: Floats) -> None:
    """Raise if a component that floats has a source, so that nothing can be at rest."""
    means = part.means(load).reshape(part.floating.shape[1], -1)
    sizes = part.means(np.abs(load)).reshape(means.shape)
    wrong = (np.abs(means) > _ROUNDING * sizes).any(axis=1)
    if not wrong.any():
        return
    where = np.flatnonzero(part.free)[part.pins]
    largest = means[np.arange(len(means)), np.abs(means).argmax(axis=1)]
    told = ", ".join(
        f"{largest[k]:.6g} in the component of vertex {where[k]}"
        for k in np.flatnonzero(wrong)[:_NAMED]
    )
    more = int(wrong.sum()) - _NAMED
    raise IncompatibleError(
        f"there is no solution, because the mean of the right-hand side is {told}"
        + (f" and not zero in {more} more" if more > 0 else ""),
        vertices=where[wrong],
        remedy="Subtract the mean (project=True), hold values there, or give a screen.",
    )
