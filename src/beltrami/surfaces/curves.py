"""Curves in the domain, traced over the surface, and their lengths by both routes (3.1.1)."""

from __future__ import annotations

from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, rectangular
from beltrami.errors import DimensionError, NotDifferentiableError, check_name, shown
from beltrami.mesh.shapes.parameters import whole
from beltrami.surfaces.charted import Charted
from beltrami.surfaces.checks import require_callable
from beltrami.surfaces.immersion import Derivatives, Map, call, derivatives_of, tabulate

ROUTES = ("intrinsic", "extrinsic")
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


def trace(chart: Charted, curve: Map, t: ArrayLike) -> Floats:
    """(..., k) points φ(γ(t)) of the curve γ: t -> (u, v)."""
    require_callable(curve, "the curve")
    times = rectangular(t).astype(np.float64)
    uv = tabulate(call(curve, "the curve", 1, times.reshape(-1, 1)))
    _require_pairs(uv)
    return chart(*uv.T).reshape(*times.shape, chart.dimension)


def intrinsic_length(chart: Charted, curve: Map, start: float, end: float, pieces: int) -> float:
    """∫ sqrt(γ'ᵀ I γ') dt, from I alone: Gauss's rule of 8 nodes on each piece."""
    ends = np.linspace(start, end, pieces + 1)
    half = np.diff(ends)[:, None] / 2  # negative if the curve is run through backwards
    t = (ends[:-1, None] + half * (1 + _NODES)).ravel()
    at = _along(curve, t)
    _require_pairs(at.points)
    velocity = at.jacobian[:, :, 0]
    if not np.isfinite(velocity).all():
        lost = t[~np.isfinite(velocity).all(axis=1)]
        raise NotDifferentiableError(
            f"the curve has no finite derivative, first at t = {lost[0]:g}",
            remedy='Split it there, or take route="extrinsic".',
        )
    g = chart.first_fundamental_form(*at.points.T)
    speed = np.sqrt(np.einsum("ni,nij,nj->n", velocity, g, velocity))
    return float(speed @ (np.abs(half) * _WEIGHTS).ravel())


def extrinsic_length(chart: Charted, curve: Map, start: float, end: float, pieces: int) -> float:
    """Length in Rᵏ of the polyline through pieces + 1 points of the traced curve."""
    points = trace(chart, curve, np.linspace(start, end, pieces + 1))
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def length(chart: Charted, curve: Map, start: float, end: float, route: str, pieces: int) -> float:
    """Return the length of a curve by a route of ``ROUTES``; see ``Chart.curve_length``."""
    check_name("route", route, ROUTES)
    require_callable(curve, "the curve")
    if not all(isinstance(t, Real) and np.isfinite(float(t)) for t in (start, end)):
        raise DimensionError(
            f"a curve runs from {shown(start)} to {shown(end)}, and needs two finite numbers"
        )
    measure = intrinsic_length if route == "intrinsic" else extrinsic_length
    return measure(chart, curve, start, end, whole("pieces", pieces, least=1))


def _along(curve: Map, t: Floats) -> Derivatives:
    """Differentiate γ in t, as a map of (t, nothing)."""

    def of_two(t: Any, _: Any) -> Any:
        return curve(t)

    return derivatives_of(of_two, "the curve", 1, t, np.zeros_like(t))


def _require_pairs(uv: Floats) -> None:
    if uv.shape[1] != 2:
        raise DimensionError(
            f"the curve has {uv.shape[1]} coordinates where the two parameters (u, v) are needed"
        )
