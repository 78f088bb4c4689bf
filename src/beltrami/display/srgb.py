"""Colours: sRGB values, linear light, and the perceptual space OKLab."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from PIL import ImageColor

from beltrami._arrays import Floats
from beltrami.errors import MeshError, shown

Color: TypeAlias = str | tuple[float, float, float]
Image: TypeAlias = NDArray[np.uint8]

# OKLab (B. Ottosson, 2020): linear sRGB -> cone responses -> cube root -> lightness and two axes.
_CONES = np.array(
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
_AXES = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)


def to_linear(encoded: Floats) -> Floats:
    """Light of an sRGB value in [0, 1] (IEC 61966-2-1)."""
    bright = ((np.maximum(encoded, 0.0) + 0.055) / 1.055) ** 2.4
    return np.where(encoded <= 0.04045, encoded / 12.92, bright)


def from_linear(light: Floats) -> Floats:
    """Return the sRGB value of an amount of light in [0, 1]; the inverse of ``to_linear``.

    Examples
    --------
    >>> float(from_linear(to_linear(np.array(0.5))).round(12))
    0.5
    """
    bright = 1.055 * np.maximum(light, 0.0) ** (1 / 2.4) - 0.055
    return np.where(light <= 0.0031308, 12.92 * light, bright)


def to_oklab(rgb: Floats) -> Floats:
    """Lightness and the two colour axes (..., 3) of sRGB colours (..., 3)."""
    return np.asarray(np.cbrt(to_linear(rgb) @ _CONES.T) @ _AXES.T)


def from_oklab(lab: Floats) -> Floats:
    """Return the sRGB colours of OKLab ones; outside [0, 1] where a screen cannot show them."""
    return from_linear((lab @ np.linalg.inv(_AXES).T) ** 3 @ np.linalg.inv(_CONES).T)


def as_color(color: Color, what: str = "the colour") -> Floats:
    """Read a colour: a name or ``"#rrggbb"``, or three numbers in [0, 1].

    Raises
    ------
    MeshError
        If it is neither.

    Examples
    --------
    >>> as_color("white").tolist(), as_color((0.5, 0.5, 1)).tolist()
    ([1.0, 1.0, 1.0], [0.5, 0.5, 1.0])
    """
    remedy = 'Give a name such as "white", "#rrggbb", or three numbers in [0, 1].'
    if isinstance(color, str):
        try:
            return np.array(ImageColor.getrgb(color)[:3]) / 255.0
        except ValueError as cause:
            raise MeshError(f"{what} {shown(color)} is not a colour", remedy=remedy) from cause
    try:
        values = np.array(color, dtype=np.float64)
    except (TypeError, ValueError) as cause:
        raise MeshError(f"{what} {shown(color)} is not a colour", remedy=remedy) from cause
    if values.shape != (3,) or not ((values >= 0) & (values <= 1)).all():
        raise MeshError(f"{what} {shown(color)} is not a colour", remedy=remedy)
    return values
