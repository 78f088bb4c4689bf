"""Functions on a surface: of points in space, or of the parameters (l. 642, E83)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from beltrami._arrays import Floats
from beltrami.errors import check_name
from beltrami.surfaces.checks import require_callable, require_finite, require_surface
from beltrami.surfaces.immersion import Map, call, column

if TYPE_CHECKING:
    from beltrami.surfaces.chart import Chart

KINDS = ("space", "parameters")


def in_parameters(chart: Chart, f: Map, of: str) -> Map:
    """Return f as a function of (u, v).

    Raises
    ------
    UnknownNameError
        If it is neither of ``"space"`` nor of ``"parameters"``.
    """
    check_name("kind of function", of, KINDS)
    require_surface(chart)
    require_callable(f, "f")
    return chart.pullback(f) if of == "space" else f


def values_of(f: Map, u: Floats, v: Floats) -> Floats:
    """(n,) values f(u, v), whatever f does with constants; SurfaceError if not finite."""
    values = np.asarray(call(f, "f", 0, column(u), column(v))[:, 0])
    require_finite(values, u, v, "f")
    return values
