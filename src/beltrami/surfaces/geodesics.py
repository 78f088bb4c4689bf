"""Geodesics of a chart: u'' = -Γ(u', u'), and how wide a fan of them spreads."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, rectangular, require_finite
from beltrami.errors import DimensionError
from beltrami.mesh.shapes.parameters import whole
from beltrami.surfaces import checks, forms
from beltrami.surfaces.immersion import Derivatives

if TYPE_CHECKING:
    from beltrami.surfaces.surface import ParametricSurface


def exponential_map(
    surface: ParametricSurface,
    u: ArrayLike,
    v: ArrayLike,
    du: ArrayLike,
    dv: ArrayLike,
    steps: int = 128,
) -> Floats:
    """Follow the geodesic that starts at (u, v) with the velocity (du, dv) for a unit of time.

    Its length is sqrt(wᵀ I w), w = (du, dv). By Runge and Kutta's method of order 4.

    Returns
    -------
    (..., 2)
        The parameters of the ends.

    Raises
    ------
    SurfaceError
        If a geodesic leaves the domain; start farther inside, or take another chart.
    RankLossError
        If one meets a pole of the chart.
    DimensionError, NonFiniteError
        If the four arrays do not go together, or a velocity is NaN or infinite.

    Examples
    --------
    >>> from beltrami.surfaces.surface import ParametricSurface
    >>> plane = ParametricSurface(lambda r, t: (r * np.cos(t), r * np.sin(t)),
    ...                           ((0, 9), (0, 2 * np.pi)), periodic=(False, True))
    >>> plane(*exponential_map(plane, 1, 0, 0, 1)).round(6).tolist()  # straight up from (1, 0)
    [1.0, 1.0]
    """
    checks.require_surface(surface)
    rows = [rectangular(x).astype(np.float64) for x in (u, v, du, dv)]
    try:
        state = np.stack(np.broadcast_arrays(*rows))
    except ValueError:
        shapes = ", ".join(str(row.shape) for row in rows)
        raise DimensionError(f"u, v, du and dv have the shapes {shapes}") from None
    require_finite(state[2:].reshape(2, -1).T, "the velocity")
    flat = state.reshape(4, -1)

    def follow(at: Derivatives, now: Floats) -> Floats:
        return np.concatenate([now[2:], acceleration(at.jacobian, at.hessian, now[2:])])

    checks.require_inside(surface.domain, flat[0], flat[1])
    end = integrate(surface, follow, flat, 1.0, steps)
    return np.moveaxis(end[:2].reshape(2, *state.shape[1:]), 0, -1)


def acceleration(jacobian: Floats, hessian: Floats, velocity: Floats) -> Floats:
    """(2, n) second derivatives -Γ^m_ij u'_i u'_j of the parameters along a geodesic."""
    symbols = forms.christoffel(jacobian, hessian)
    return -np.einsum("nmij,in,jn->mn", symbols, velocity, velocity)


def orthonormal_frame(surface: ParametricSurface, u: Floats, v: Floats) -> Floats:
    """(n, 2, 2) velocities in (u, v), as columns, that are orthonormal on the surface."""
    lower = np.linalg.cholesky(surface.first_fundamental_form(u, v))
    return np.linalg.inv(np.swapaxes(lower, -1, -2))


def integrate(
    surface: ParametricSurface,
    slope: Callable[[Derivatives, Floats], Floats],
    state: Floats,
    end: float,
    steps: int,
) -> Floats:
    """Integrate states (c, n), whose first two rows are parameters, from 0 to ``end``.

    ``slope`` is called with the derivatives of φ there and with the state.
    """
    h = end / whole("steps", steps, least=1)

    def at(now: Floats) -> Floats:
        u, v = now[0], now[1]
        here = surface.immersion.derivatives(u, v)
        checks.require_derivatives(here.jacobian, u, v)
        checks.require_derivatives(here.hessian, u, v)
        checks.require_rank(here.jacobian, surface.domain, surface.size, u, v)
        return slope(here, now)

    for _ in range(steps):
        k1 = at(state)
        k2 = at(state + h / 2 * k1)
        k3 = at(state + h / 2 * k2)
        k4 = at(state + h * k3)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        checks.require_inside(surface.domain, state[0], state[1])
    return state
