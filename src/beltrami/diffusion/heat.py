"""The heat equation ∂F/∂t = -B⁻¹ L F, in steps (definition 17, equations 3.6 and 3.7)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Booleans, Floats, Integers, as_function, as_indices
from beltrami._progress import Progress, stages
from beltrami.errors import BeltramiError, StepTooLongError, check_name
from beltrami.mesh.mesh import Mesh
from beltrami.operators.pair import Laplacian
from beltrami.solvers.factorize import factorize

HEAT_METHODS = ("implicit", "explicit")
_MOST_STEPS = 10_000_000  # of the explicit scheme, if the caller does not insist


def heat(
    laplacian: Laplacian,
    f: ArrayLike,
    time: float,
    method: str = "implicit",
    steps: int | None = None,
    *,
    hold: ArrayLike = (),
    progress: Progress | None = None,
) -> Floats:
    r"""Diffuse a function for a time t: :math:`\partial F / \partial t = -B^{-1} L F`, F_0 = f.

    Chapter items: D17, T15, T16, Q3.6, Q3.7, U30, U31, U32, R3, R4, P40, P47.

    Parameters
    ----------
    laplacian
        The pair (L, B). With area masses the time has the unit length²; with the degree mass it
        has none, and :math:`B^{-1}L = \mathrm{Id} - \tilde W` (E50).
    f
        (n,) or (n, c): each column is diffused.
    time
        Total time, >= 0.
    method
        ``"implicit"``: :math:`(B + \delta L) F_{k+1} = B F_k` (equation 3.7 made symmetric, E54),
        stable for every step; one factorisation serves all steps and columns.
        ``"explicit"``: :math:`F_{k+1} = F_k - \delta B^{-1} L F_k` (equation 3.6, E51), stable for
        :math:`\delta \le 2 / \lambda_n` (E52).
    steps
        Number of steps of length δ = time / steps. Default: 10 implicit ones, or the fewest
        explicit ones for which no mode is overshot (δ <= 1 / bound).
    hold
        Vertices (indices or a mask) whose values stay as they are.
    progress
        Called with (steps done, steps in all).

    Returns
    -------
    (n,) or (n, c), as f. Both schemes are of first order in δ, with errors of opposite sign, and
    keep the mean of B if nothing is held. When the time is more than 1e8 times the area, the
    implicit system is nearly singular and digits of the mean are lost; in the end it is refused.

    Raises
    ------
    StepTooLongError
        If an explicit step is beyond 2 over ``laplacian.spectral_bound()``, the proven bound;
        ``error.longest`` is the longest allowed.
    SingularMatrixError
        If the time is so long that nothing of the mass is left beside δL.
    DimensionError, NonFiniteError, UnknownNameError, BeltramiError
        If f, the method or the numbers are not valid.

    Examples
    --------
    >>> from beltrami.mesh.mesh import Mesh
    >>> from beltrami.operators.laplacian import laplacian
    >>> mesh = Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    >>> pair = laplacian(mesh)
    >>> spread = heat(pair, [1, 0, 0, 0], time=0.1)
    >>> spread.round(3).tolist(), pair.mean(spread).round(12).tolist()
    ([0.704, 0.134, 0.028, 0.134], 0.25)
    """
    check_name("method of heat", method, HEAT_METHODS)
    values = as_function(f, laplacian.n)
    held = as_indices(hold, laplacian.n, "held vertices")
    if not (math.isfinite(time) and time >= 0):
        raise BeltramiError(f"time must be finite and >= 0, not {time}")
    if steps is not None and (steps < 1 or steps != int(steps)):
        raise BeltramiError(f"steps must be a whole number >= 1, not {steps}")
    if time == 0:
        return values.copy()
    if method == "implicit":
        return _implicit(laplacian, values, time, steps or 10, held, progress)
    bound = laplacian.spectral_bound()
    count = steps or math.ceil(min(max(1.0, time * bound), _MOST_STEPS + 1))
    if steps is None and count > _MOST_STEPS:
        raise BeltramiError(
            f"a time of {time:g} takes more than {_MOST_STEPS:.0e} explicit steps here: the "
            f"longest allowed is {2 / bound:.6g}. Use the implicit method, or give the steps"
        )
    if time / count * bound > 2 * (1 + 1e-12):
        raise StepTooLongError(time / count, 2 / bound)
    return _explicit(laplacian, values, time / count, count, held, progress)


def _implicit(
    laplacian: Laplacian,
    f: Floats,
    time: float,
    steps: int,
    held: Integers,
    progress: Progress | None,
) -> Floats:
    """Solve (B + δL) F' = B F on the free vertices; the held ones move to the right-hand side."""
    matrix = csr_array(laplacian.mass + (time / steps) * laplacian.stiffness)
    free = np.ones(laplacian.n, np.bool_)
    free[held] = False
    if not free.any():
        return f.copy()
    inner = matrix if free.all() else csr_array(matrix[free][:, free])
    outer = matrix[free][:, ~free] @ f[~free]
    factor = factorize(inner, _positions(laplacian, free))
    result = f.copy()
    for _ in stages(steps, progress):
        result[free] = factor.solve((laplacian.mass @ result)[free] - outer)
    return result


def _explicit(
    laplacian: Laplacian,
    f: Floats,
    delta: float,
    steps: int,
    held: Integers,
    progress: Progress | None,
) -> Floats:
    """Add -δ B⁻¹ L F on the free vertices, with the part of B that belongs to them."""
    free = np.ones(laplacian.n, np.bool_)
    free[held] = False
    if not free.any():
        return f.copy()
    result = f.copy()
    whole = laplacian.mass_kind == "consistent"
    inner = csr_array(laplacian.mass[free][:, free])
    mass = factorize(inner, _positions(laplacian, free)) if whole else None
    scale = (delta / laplacian.masses[free])[(...,) + (None,) * (f.ndim - 1)]
    for _ in stages(steps, progress):
        flow = (laplacian.stiffness @ result)[free]
        result[free] -= scale * flow if mass is None else delta * mass.solve(flow)
    return result


def _positions(laplacian: Laplacian, chosen: Booleans) -> Floats | None:
    """Return where the chosen vertices are, if the pair comes from a mesh."""
    domain = laplacian.domain
    return domain.vertices[chosen] if isinstance(domain, Mesh) else None
