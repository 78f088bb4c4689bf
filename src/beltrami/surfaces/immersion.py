"""The map φ and its derivatives: through jets, or as the user gives them (definition 1)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from beltrami._arrays import Floats
from beltrami.errors import BeltramiError, SurfaceError
from beltrami.surfaces.jets import Jet, compose, parts, plain, variables
from beltrami.surfaces.outputs import entries

Map: TypeAlias = Callable[..., Any]


class Derivatives(NamedTuple):
    """A map at n parameters: (n, k) points, (n, k, 2) Jacobian, (n, k, 2, 2) Hessian."""

    points: Floats
    jacobian: Floats
    hessian: Floats


@dataclass(frozen=True)
class Immersion:
    """A map φ: R² -> Rᵏ with its first and second derivatives, at n parameters at a time.

    Without ``jacobian``, φ is differentiated by jets. With it φ may be any code, and the Jacobian
    is differentiated by jets, or not at all if there is a ``hessian`` too.
    """

    phi: Map
    jacobian: Map | None = None
    hessian: Map | None = None

    def points(self, u: Floats, v: Floats) -> Floats:
        """(n, k) points φ(u, v)."""
        return tabulate(call(self.phi, "φ", 1, column(u), column(v)))

    def tangents(self, u: Floats, v: Floats) -> Floats:
        """(n, k, 2) Jacobian: its columns are ∂φ/∂u and ∂φ/∂v."""
        if self.jacobian is None:
            return derivatives_of(self.phi, "φ", 1, u, v).jacobian
        return tabulate(call(self.jacobian, "the Jacobian", 2, column(u), column(v)))

    def derivatives(self, u: Floats, v: Floats) -> Derivatives:
        """Return the points, the Jacobian and the Hessian."""
        if self.jacobian is None:
            return derivatives_of(self.phi, "φ", 1, u, v)
        if self.hessian is None:
            _, bends, _ = derivatives_of(self.jacobian, "the Jacobian", 2, u, v)
        else:
            bends = tabulate(call(self.hessian, "the Hessian", 3, column(u), column(v)))
        return Derivatives(self.points(u, v), self.tangents(u, v), bends)

    def coordinates(self, u: Any, v: Any) -> list[Any]:
        """Return the k coordinates at (n, 1) arrays or jets, in kind."""
        if self.jacobian is None or not (isinstance(u, Jet) or isinstance(v, Jet)):
            return call(self.phi, "φ", 1, u, v)
        at = self.derivatives(plain(u)[:, 0], plain(v)[:, 0])
        return [
            compose((x[:, None], _columns(slope), [_columns(row) for row in bend]), (u, v))
            for x, slope, bend in zip(
                at.points.T,
                np.moveaxis(at.jacobian, 0, -1),
                np.moveaxis(at.hessian, 0, -1),
                strict=True,
            )
        ]


def call(function: Map, what: str, depth: int, *at: Any) -> Any:
    """Call a user's map at (n, 1) arrays or jets; return its functions in lists ``depth`` deep."""
    try:
        with np.errstate(all="ignore"):  # what is not finite is told by who asked
            result = function(*at)
    except BeltramiError:
        raise
    except (TypeError, ValueError) as cause:  # ValueError: an array as a condition
        raise SurfaceError(
            f"{what} cannot be called with {len(at)} arrays: {cause}",
            remedy="Write it with numpy's functions, of as many parameters.",
        ) from cause
    return entries(result, depth, np.shape(plain(at[0])), what)


def call_at_points(f: Map, points: Any) -> Any:
    """Call a user's function of space at its k coordinates."""
    try:
        return f(*points)
    except BeltramiError:
        raise
    except (TypeError, ValueError) as cause:
        raise SurfaceError(
            f"f cannot be called with the {len(points)} coordinates of points: {cause}",
            remedy='Write it with numpy\'s functions; if it is one of (u, v), say of="parameters".',
        ) from cause


def derivatives_of(function: Map, what: str, depth: int, u: Floats, v: Floats) -> Derivatives:
    """Differentiate a map of (u, v) by jets: values and, as last axes, first and second."""
    functions = call(function, what, depth, *variables(column(u), column(v)))
    f, f_u, f_v, f_uu, f_uv, f_vv = (tabulate(functions, part) for part in range(6))
    second = np.stack([np.stack([f_uu, f_uv], -1), np.stack([f_uv, f_vv], -1)], -2)
    return Derivatives(f, np.stack([f_u, f_v], -1), second)


def tabulate(functions: Any, part: int = 0) -> Floats:
    """Write nested lists of functions, or one of their derivatives, as one array (n, ...)."""
    if isinstance(functions, list):
        return np.stack([tabulate(function, part) for function in functions], axis=1)
    return parts(functions)[part][:, 0]


def column(x: Floats) -> Floats:
    """Write n parameters as (n, 1): what every map is called with, and may write into."""
    return np.array(x).reshape(-1, 1)


def _columns(rows: Floats) -> list[Floats]:
    return [column(row) for row in rows]
