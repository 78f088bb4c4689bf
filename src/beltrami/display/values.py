"""Functions to be drawn: checked, with the ends and the colours of their map."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import GIVE, Floats, as_function, rectangular
from beltrami.display.colormaps import color_table, is_signed, symmetric_limits
from beltrami.display.framing import named_vertices
from beltrami.errors import DimensionError, MeshError, NonFiniteError, shown
from beltrami.mesh.mesh import Mesh


def as_values(mesh: Mesh, f: ArrayLike, missing: bool = False) -> Floats:
    """(n, 1) numbers or (n, 3) colours: a function on the vertices, checked.

    Colours are sRGB, in [0, 1], or integers of 0 to 255 of the type uint8. Numbers, but not all
    of those that are seen, may be NaN where values may be ``missing``.

    Raises
    ------
    DimensionError
        If there is not one row for each vertex, with one or three columns.
    NonFiniteError
        If a value is NaN or infinite.
    MeshError
        If a colour is outside [0, 1].
    """
    given = rectangular(f)
    holes = missing and given.dtype.kind == "f" and given.shape[1:] in ((), (1,))
    absent = np.isnan(given) if holes else np.zeros(given.shape, np.bool_)
    values = as_function(np.where(absent, 0, given), mesh.n_vertices).reshape(mesh.n_vertices, -1)
    if absent.any():
        values[absent] = np.nan
        if np.isnan(seen_values(mesh, values)).all():
            raise NonFiniteError("the function has no value that is seen", remedy=GIVE)
    if values.shape[1] not in (1, 3):
        raise DimensionError(
            f"a function with {values.shape[1]} columns cannot be drawn",
            remedy="Give one number for each vertex, or three for a colour.",
        )
    if values.shape[1] == 3:
        values = values / 255.0 if given.dtype == np.uint8 else values
        bad = ((values < 0) | (values > 1)).any(axis=1)
        if bad.any():
            raise MeshError(
                "colours outside [0, 1]",
                vertices=np.flatnonzero(bad),
                remedy="Give sRGB colours in [0, 1], or as uint8.",
            )
    return values


def seen_values(mesh: Mesh, values: Floats) -> Floats:
    """Values at the vertices that faces name: those that can be seen."""
    return np.asarray(values[named_vertices(mesh.faces, mesh.n_vertices)])


def choose_limits(
    f: Floats, limits: tuple[float, float] | None, colormap: str | ArrayLike | None
) -> tuple[tuple[float, float], Floats]:
    """Limits and colour table: diverging and symmetric around 0 if f takes both signs.

    Examples
    --------
    >>> choose_limits(np.array([-1.0, 3.0]), None, None)[0]
    (-3.0, 3.0)
    >>> choose_limits(np.array([1.0, 3.0]), None, None)[0]
    (1.0, 3.0)
    """
    signed = is_signed(f)
    if colormap is None:
        colormap = "diverging" if signed else "sequential"
    if limits is None:
        symmetric = isinstance(colormap, str) and colormap == "diverging"
        limits = symmetric_limits(f) if symmetric else (float(f.min()), float(f.max()))
    low, high = (float(limit) for limit in limits)
    if not (np.isfinite([low, high]).all() and low <= high):
        raise MeshError(f"the limits {shown(limits)} are not two numbers in ascending order")
    return (low, high), color_table(colormap)
