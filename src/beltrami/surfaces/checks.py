"""What a parametric surface checks: parameters at the door, finite points, rank, derivatives."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Booleans, Floats, rectangular
from beltrami.errors import (
    DimensionError,
    NotDifferentiableError,
    RankLossError,
    SurfaceError,
    shown,
)
from beltrami.surfaces.domain import ParameterDomain
from beltrami.surfaces.immersion import Immersion

RANK_TOLERANCE = 1e-7  # closer to a pole than that, the divisions by g would leave few digits
_STEP, _AGREE = 1e-5, 1e-4
_SMALLEST = 1e-60


def broadcast(u: ArrayLike, v: ArrayLike) -> tuple[Floats, Floats, tuple[int, ...]]:
    """Return u and v as flat float arrays, and the shape that they have together."""
    a, b = rectangular(u).astype(np.float64), rectangular(v).astype(np.float64)
    try:
        a, b = np.broadcast_arrays(a, b)
    except ValueError:
        raise DimensionError(f"u of the shape {a.shape} does not go with v of {b.shape}") from None
    return a.ravel(), b.ravel(), a.shape


def require_surface(surface: object) -> None:
    """Raise SurfaceError if it has no immersion, as a ParametricSurface has."""
    if not hasattr(surface, "immersion"):
        raise SurfaceError(
            f"a ParametricSurface is needed, not an object of type {type(surface).__name__}"
        )


def require_callable(f: object, what: str) -> None:
    """Raise SurfaceError if it cannot be called."""
    if not callable(f):
        raise SurfaceError(f"{what} is {shown(f)} where a function is needed")


def require_inside(domain: ParameterDomain, u: Floats, v: Floats) -> None:
    """Raise SurfaceError, with the parameters, if some are not in the domain (or NaN)."""
    outside = ~domain.contains(u, v) | ~np.isfinite(u) | ~np.isfinite(v)
    if outside.any():
        raise SurfaceError(
            f"parameters outside {domain}",
            parameters=_pairs(u, v, outside),
            remedy="Stay inside, or make a surface on a larger domain.",
        )


def require_finite(values: Floats, u: Floats, v: Floats, what: str = "φ") -> None:
    """Raise SurfaceError, with the parameters, where a value is NaN or infinite."""
    bad: Booleans = ~_finite_rows(values)
    if bad.any():
        raise SurfaceError(
            f"{what} is NaN or infinite",
            parameters=_pairs(u, v, bad),
            remedy="Take a domain without these parameters.",
        )


def require_derivatives(values: Floats, u: Floats, v: Floats, what: str = "φ") -> None:
    """Raise NotDifferentiableError, with the parameters, where a derivative is not finite."""
    bad: Booleans = ~_finite_rows(values)
    if bad.any():
        raise NotDifferentiableError(
            f"{what} has no finite derivative",
            parameters=_pairs(u, v, bad),
            remedy="Stay away from its edges and poles, or write it smoothly.",
        )


def require_rank(
    jacobian: Floats, domain: ParameterDomain, size: float, u: Floats, v: Floats
) -> None:
    """Raise RankLossError, with the parameters, where the columns do not span a plane (E2).

    Where the smaller singular value of the Jacobian, times the extent of the domain, is below
    1e-7 of the size of the surface. No unit of u, v or length matters.
    """
    singular = np.linalg.svd(jacobian * domain.extent, compute_uv=False)
    lost: Booleans = singular[:, 1] <= RANK_TOLERANCE * size
    if lost.any():
        raise RankLossError(
            "φ is no immersion: its Jacobian has not rank 2, and sqrt(det I) vanishes",
            parameters=_pairs(u, v, lost),
            remedy="Take parameters away from poles and folds, or another chart there.",
        )


def require_range(size: float, domain: ParameterDomain) -> None:
    """Raise SurfaceError if fourth powers of derivatives, as in det I, would leave the floats."""
    with np.errstate(all="ignore"):
        lengths = np.array([size, *(size / domain.extent)])
    if size and not ((lengths > _SMALLEST) & (lengths < 1 / _SMALLEST)).all():
        raise SurfaceError(
            f"a surface of the size {size:.3g} over {domain} is out of the range of floats",
            remedy="Take another unit of length, or of the parameters.",
        )


def require_true_derivatives(immersion: Immersion, domain: ParameterDomain) -> None:
    """Raise SurfaceError if a given Jacobian or Hessian is not that of φ, by central differences.

    The differences are good to about 1e-9; what is off by more than 1e-4 of the largest entry is
    taken for a slip.
    """
    if immersion.jacobian is None:
        if immersion.hessian is not None:
            raise SurfaceError("a Hessian without a Jacobian", remedy="Give both, or neither.")
        return
    u, v = domain.samples(16)
    du, dv = 0.5 * _STEP * domain.extent  # the samples are farther from the sides than this
    tangents = immersion.tangents(u, v)
    by_u = immersion.points(u + du, v) - immersion.points(u - du, v)
    by_v = immersion.points(u, v + dv) - immersion.points(u, v - dv)
    _compare("Jacobian", tangents, np.stack([by_u / (2 * du), by_v / (2 * dv)], -1), u, v)
    if immersion.hessian is not None:
        by_u = immersion.tangents(u + du, v) - immersion.tangents(u - du, v)
        by_v = immersion.tangents(u, v + dv) - immersion.tangents(u, v - dv)
        given = immersion.derivatives(u, v).hessian
        _compare("Hessian", given, np.stack([by_u / (2 * du), by_v / (2 * dv)], -1), u, v)


def _compare(what: str, given: Floats, measured: Floats, u: Floats, v: Floats) -> None:
    if given.shape != measured.shape:
        raise DimensionError(f"the {what} is {given.shape[1:]} where {measured.shape[1:]} is due")
    scale = np.abs(measured).max(axis=tuple(range(measured.ndim - 1)))  # of each parameter
    wrong: Booleans = ~(np.abs(given - measured) <= _AGREE * scale).reshape(len(u), -1).all(axis=1)
    if wrong.any():
        raise SurfaceError(
            f"the given {what} is not that of φ",
            parameters=_pairs(u, v, wrong),
            remedy="Mend it, or leave it out: φ written with numpy is differentiated exactly.",
        )


def _finite_rows(rows: Floats) -> Booleans:
    return np.asarray(np.isfinite(rows).all(axis=tuple(range(1, rows.ndim))))


def _pairs(u: Floats, v: Floats, which: Booleans) -> Floats:
    return np.stack([u[which], v[which]], axis=1)
