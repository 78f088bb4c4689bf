"""Atlas: several charts of one surface, and how their parameters change (section 3.1.1)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Booleans, Floats, Integers, rectangular, require_finite
from beltrami._frozen import Frozen
from beltrami.errors import DimensionError, SurfaceError, shown
from beltrami.surfaces.inversion import invert
from beltrami.surfaces.jets import Jet, plain
from beltrami.surfaces.surface import ParametricSurface


class Atlas(Frozen):
    """Charts that together cover one surface and overlap in a smooth manner (l. 23).

    Chapter items: P1.

    Parameters
    ----------
    charts
        Parametric surfaces in the same Rᵏ, at least one.

    Raises
    ------
    SurfaceError
        If there is no chart, or something else than charts.
    DimensionError
        If the charts lie in different spaces.

    Examples
    --------
    The sphere on two disks, by stereographic projection from either pole:

    >>> from beltrami.surfaces.domain import Disk
    >>> def stereographic(side):
    ...     def phi(u, v):
    ...         s = 1 + u**2 + v**2
    ...         return 2 * u / s, side * 2 * v / s, side * (2 / s - 1)
    ...     return ParametricSurface(phi, Disk(1.5))
    >>> sphere = Atlas([stereographic(1), stereographic(-1)])
    >>> change = sphere.transition(0, 1)  # u / |u|², mirrored
    >>> [float(x) for x in np.round(change(0.8, 0.4), 12)]
    [1.0, -0.5]
    >>> sphere.locate([[0, 0, 1.0], [0, 0, -1.0]])[0].tolist()
    [0, 1]
    """

    charts: tuple[ParametricSurface, ...]

    def __init__(self, charts: Sequence[ParametricSurface]) -> None:
        given: Any = charts
        several = tuple(given) if isinstance(given, Iterable) else (given,)
        if not several:
            raise SurfaceError("an atlas without charts")
        if not all(isinstance(chart, ParametricSurface) for chart in several):
            raise SurfaceError("an atlas is made of a list of parametric surfaces")
        if len({chart.dimension for chart in several}) > 1:
            spaces = ", ".join(f"R^{chart.dimension}" for chart in several)
            raise DimensionError(f"charts in different spaces: {spaces}")
        self.__dict__.update(charts=several)

    def __repr__(self) -> str:
        return f"<Atlas of {len(self.charts)} charts in R^{self.charts[0].dimension}>"

    def covers(self, chart: int, points: ArrayLike) -> Booleans:
        """(n,) whether each point (n, k) is on this chart, within 1e-8 of its size."""
        return invert(self._chart(chart), self._points(points))[1]

    def locate(self, points: ArrayLike) -> tuple[Integers, Floats]:
        """Return the first chart on which each point (n, k) is, (n,), and its parameters, (n, 2).

        Raises
        ------
        SurfaceError
            If a point is on no chart.
        """
        x = self._points(points)
        found = np.full(len(x), -1)
        uv = np.zeros((len(x), 2))
        for number, chart in enumerate(self.charts):
            open_ = np.flatnonzero(found < 0)
            parameters, on = invert(chart, x[open_])
            found[open_[on]], uv[open_[on]] = number, parameters[on]
        if (found < 0).any():
            raise SurfaceError(f"points on no chart: rows {np.flatnonzero(found < 0)[:5].tolist()}")
        return found, uv

    def laplace_beltrami(self, f: Callable[..., Any]) -> Callable[[ArrayLike], Floats]:
        """Return Δf as a function of points (n, k) of the surface, each in its first chart.

        f is a function f(x_1, ..., x_k) written with numpy. The chart does not matter (P39).
        """

        def at(points: ArrayLike) -> Floats:
            which, uv = self.locate(points)
            values = np.empty(len(which))
            for number in np.unique(which):
                here = which == number
                values[here] = self.charts[number].laplace_beltrami(f)(*uv[here].T)
            return values

        return at

    def transition(self, source: int, target: int) -> Callable[[Any, Any], tuple[Any, Any]]:
        """Return the change of parameters ψ = φ_target⁻¹ ∘ φ_source on the overlap.

        ψ(u, v) gives the two new parameters. It can itself be differentiated: a curve or a
        function written with it works wherever one written with numpy does.

        Raises
        ------
        SurfaceError
            When ψ is called with parameters whose points are not on the target.
        """
        old, new = self._chart(source), self._chart(target)

        def change(u: Any, v: Any) -> tuple[Any, Any]:
            points = old(plain(u), plain(v))
            flat = points.reshape(-1, points.shape[-1])
            uv, on = invert(new, flat)
            if not on.all():
                at = np.stack(np.broadcast_arrays(plain(u), plain(v)), -1).reshape(-1, 2)
                raise SurfaceError(
                    f"parameters of chart {source} whose points are not on chart {target}",
                    parameters=at[~on],
                    remedy="Stay on the overlap; covers() tells where it is.",
                )
            if isinstance(u, Jet) or isinstance(v, Jet):
                return _with_derivatives(old, new, u, v, uv)
            return uv[:, 0].reshape(points.shape[:-1]), uv[:, 1].reshape(points.shape[:-1])

        return change

    def _points(self, points: ArrayLike) -> Floats:
        x = rectangular(points).astype(np.float64)
        k = self.charts[0].dimension
        if x.ndim != 2 or x.shape[1] != k:
            raise DimensionError(f"points have the shape {x.shape} where (n, {k}) is needed")
        require_finite(x, "the array of points")
        return x

    def _chart(self, number: int) -> ParametricSurface:
        if type(number) is bool or not isinstance(number, int | np.integer):
            raise SurfaceError(f"a chart is named by its number, not by {shown(number)}")
        if not 0 <= number < len(self.charts):
            raise SurfaceError(f"chart {number} of an atlas of {len(self.charts)}, counted from 0")
        return self.charts[number]


def _with_derivatives(
    old: ParametricSurface, new: ParametricSurface, u: Any, v: Any, uv: Floats
) -> tuple[Any, Any]:
    """Solve φ_new(w) = φ_old(u, v) in jets from the values of w.

    Each chord step w - J⁺ (φ_new(w) - φ_old(u, v)), J at the values, makes one more order of
    derivatives right; two steps make both.
    """
    wanted = old.immersion.coordinates(u, v)
    inverse = np.linalg.pinv(new.immersion.tangents(*uv.T))
    w = [uv[:, :1], uv[:, 1:]]
    for _ in range(2):
        missing = [x - y for x, y in zip(wanted, new.immersion.coordinates(*w), strict=True)]
        w = [w[i] + sum(inverse[:, i, c, None] * x for c, x in enumerate(missing)) for i in (0, 1)]
    return w[0], w[1]
