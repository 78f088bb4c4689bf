"""The Laplacian as a mean over geodesic disks or circles: remark 2, with its factor (E49)."""

from __future__ import annotations

from collections.abc import Callable
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats
from beltrami.errors import SurfaceError, check_name, shown
from beltrami.mesh.shapes.parameters import whole
from beltrami.surfaces import checks, forms
from beltrami.surfaces.functions import in_parameters, values_of
from beltrami.surfaces.geodesics import acceleration, integrate, orthonormal_frame
from beltrami.surfaces.immersion import Derivatives

if TYPE_CHECKING:
    from beltrami.surfaces.surface import ParametricSurface

MEANS = ("disk", "circle")
_LONGEST = 1e3  # geodesics, in lengths of the surface


def ball_average_laplacian(
    surface: ParametricSurface,
    f: Callable[..., Any],
    u: ArrayLike,
    v: ArrayLike,
    radius: float,
    *,
    over: str = "disk",
    of: str = "space",
    directions: int = 32,
    steps: int = 32,
) -> Floats:
    r"""Compare f with its mean over :math:`B_h`: :math:`\frac{8}{h^2}(\bar f - f) \to \Delta f`.

    Remark 2 (l. 385) prints the mean alone, whose limit is f; the factor is 2 (d + 2) / h² with
    d = 2 for geodesic disks, and 4 / h² for geodesic circles (E49). The error is O(h²).

    Geodesics leave (u, v) in all directions; along each, Jacobi's equation J'' = -K J gives the
    width J of the fan, so that dA = J ds dθ. No other use is made of the embedding.

    Chapter items: R2.

    Parameters
    ----------
    f
        f(x_1, ..., x_k), or f(u, v) with ``of="parameters"``. Any code: it is not differentiated.
    u, v
        The centres, of any shape.
    radius
        h > 0, a length: below the distance to the edge of the chart and where geodesics cross.
    over
        ``"disk"`` for the mean over all points within h, ``"circle"`` for those at h.
    of
        Whether f is a function of points in ``"space"`` or of ``"parameters"``.
    directions, steps
        How many geodesics, and steps of Runge and Kutta's method on each.

    Returns
    -------
    (...,) values, in units of f per length².

    Raises
    ------
    SurfaceError
        If the radius is not positive, a geodesic leaves the domain, or f is not finite.
    RankLossError
        If one meets a pole of the chart.
    UnknownNameError
        If ``over`` or ``of`` does not exist.

    Notes
    -----
    Cost: 4 · steps · directions evaluations of φ with its derivatives at each centre.

    Examples
    --------
    >>> from beltrami.surfaces.surface import ParametricSurface
    >>> plane = ParametricSurface(lambda u, v: (u, v), ((-1, 1), (-1, 1)))
    >>> float(ball_average_laplacian(plane, lambda x, y: x**2 + 3 * y, 0, 0, 0.5).round(9))
    2.0
    """
    checks.require_surface(surface)
    check_name("mean", over, MEANS)
    if not isinstance(radius, Real) or not 0 < radius < np.inf:
        raise SurfaceError(f"the radius is {shown(radius)} where a positive number is needed")
    if radius > _LONGEST * surface.size:
        raise SurfaceError(f"a radius of {radius:g} is much longer than the surface")
    directions = whole("directions", directions, least=3)
    fbar = in_parameters(surface, f, of)
    a, b, shape = checks.broadcast(u, v)
    start = np.repeat(values_of(fbar, a, b), directions)

    def follow(at: Derivatives, now: Floats) -> Floats:
        curvature = forms.gaussian_curvature(at.jacobian, at.hessian)
        width, spread = now[4:6]
        difference = (values_of(fbar, *surface.domain.nearest(now[0], now[1])) - start) * width
        turn = acceleration(at.jacobian, at.hessian, now[2:4])
        return np.stack([*now[2:4], *turn, spread, -curvature * width, width, difference])

    fan = _fan(surface, a, b, directions)
    end = integrate(surface, follow, fan, float(radius), steps)
    width, area, excess = (end[row].reshape(-1, directions).sum(axis=1) for row in (4, 6, 7))
    if over == "disk":
        return (8 / radius**2 * excess / area).reshape(shape)
    rim = (values_of(fbar, *end[:2]) - start) * end[4]
    return (4 / radius**2 * rim.reshape(-1, directions).sum(axis=1) / width).reshape(shape)


def _fan(surface: ParametricSurface, u: Floats, v: Floats, directions: int) -> Floats:
    """(8, n * directions) u, v, u', v', J = 0, J' = 1, ∫J = 0, ∫(f - f(x))J = 0 at the centres."""
    checks.require_inside(surface.domain, u, v)
    tangents = surface.immersion.tangents(u, v)
    checks.require_derivatives(tangents, u, v)
    checks.require_rank(tangents, surface.domain, surface.size, u, v)
    angle = 2 * np.pi * np.arange(directions) / directions
    around = np.stack([np.cos(angle), np.sin(angle)])
    velocity = np.einsum("nij,jd->ind", orthonormal_frame(surface, u, v), around).reshape(2, -1)
    state = np.zeros((8, velocity.shape[1]))
    state[0], state[1] = np.repeat(u, directions), np.repeat(v, directions)
    state[2:4], state[5] = velocity, 1.0
    return state
