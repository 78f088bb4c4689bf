"""Colour maps, interpolated in a perceptual space: lightness tells the value also in grey."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_floats, as_function, read_only
from beltrami.display.srgb import from_oklab
from beltrami.errors import MeshError, check_name

SIZE = 512  # colours of a table; pixels interpolate between them
# Anchors: lightness, chroma, hue in degrees (OKLab in polar form), at equal steps of the value.
_ANCHORS = {
    # dark blue to warm yellow: the lightness grows by the same amount with each step
    "sequential": (
        (0.28, 0.115, 290.0),
        (0.41, 0.125, 265.0),
        (0.54, 0.110, 228.0),
        (0.67, 0.120, 168.0),
        (0.80, 0.155, 128.0),
        (0.93, 0.155, 102.0),
    ),
    # blue, white, red: both ends equally dark, so that neither sign looks larger
    "diverging": (
        (0.44, 0.150, 262.0),
        (0.70, 0.110, 252.0),
        (0.97, 0.000, 252.0),
        (0.97, 0.000, 35.0),
        (0.70, 0.125, 35.0),
        (0.44, 0.150, 25.0),
    ),
    "gray": ((0.25, 0.0, 0.0), (0.97, 0.0, 0.0)),
}
# Where the anchors lie in [0, 1]; the two whites of the diverging map share the middle.
_PLACES = {"diverging": (0.0, 0.25, 0.5, 0.5, 0.75, 1.0)}
COLORMAPS = tuple(_ANCHORS)


def color_table(colormap: str | ArrayLike) -> Floats:
    """(k, 3) sRGB colours of a map, from its lowest value to its highest.

    Parameters
    ----------
    colormap
        ``"sequential"``, ``"diverging"`` or ``"gray"``; or an own (k, 3) table in [0, 1], k >= 2.

    Raises
    ------
    UnknownNameError
        If there is no map of this name.
    MeshError
        If an own table is not one.

    Examples
    --------
    >>> color_table("diverging").shape
    (512, 3)
    >>> color_table([[0, 0, 0], [1, 1, 1]]).tolist()
    [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]
    """
    if isinstance(colormap, str):
        return _named_table(check_name("colormap", colormap, COLORMAPS))
    given = as_floats(colormap)
    table = as_function(given, len(given) if given.ndim else 0, "the colour table")
    if (
        table.ndim != 2
        or table.shape[1] != 3
        or len(table) < 2
        or table.min() < 0
        or table.max() > 1
    ):
        raise MeshError(
            f"the colour table has the shape {table.shape}, or values outside [0, 1]",
            remedy="Give (k, 3) colours in [0, 1], k >= 2, or a name.",
        )
    return table


@cache
def _named_table(name: str) -> Floats:
    """Interpolate the anchors linearly in OKLab, then bring each colour onto the screen."""
    lightness, chroma, hue = np.array(_ANCHORS[name]).T
    angle = np.radians(hue)
    lab = np.stack([lightness, chroma * np.cos(angle), chroma * np.sin(angle)], axis=1)
    places = np.array(_PLACES.get(name, np.linspace(0, 1, len(lab))))
    t = np.linspace(0, 1, SIZE)
    dense = np.stack([np.interp(t, places, column) for column in lab.T], axis=1)
    return read_only(_on_screen(dense))


def _on_screen(lab: Floats) -> Floats:
    """Lower the chroma, never the lightness, until a screen can show the colour."""
    low, high = np.zeros(len(lab)), np.ones(len(lab))
    for _ in range(30):
        middle = (low + high) / 2
        rgb = from_oklab(lab * np.stack([np.ones(len(lab)), middle, middle], axis=1))
        shown = ((rgb >= 0) & (rgb <= 1)).all(axis=1)
        low, high = np.where(shown, middle, low), np.where(shown, high, middle)
    return np.clip(from_oklab(lab * np.stack([np.ones(len(lab)), low, low], axis=1)), 0, 1)


def is_signed(f: Floats) -> bool:
    """Whether a function takes both signs.

    Examples
    --------
    >>> is_signed(np.array([-1.0, 2.0])), is_signed(np.array([0.0, 2.0]))
    (True, False)
    """
    return bool(f.size and f.min() < 0 < f.max())


def symmetric_limits(f: Floats) -> tuple[float, float]:
    """Limits -a, a with a = max |f|: the middle colour is the value zero.

    Chapter items: P52.

    Examples
    --------
    >>> symmetric_limits(np.array([-3.0, 1.0]))
    (-3.0, 3.0)
    """
    a = float(np.abs(f).max(initial=0.0))
    return -a, a
