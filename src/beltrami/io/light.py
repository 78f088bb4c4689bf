"""Colours as glTF has them: linear light, where all else has sRGB values."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats


def light_of(colours: Floats) -> Floats:
    """Return the light of sRGB values in [0, 1] (IEC 61966-2-1); a fourth column, opacity, stays.

    Examples
    --------
    >>> light_of(np.array([[0.0, 0.5, 1.0, 0.5]])).round(4).tolist()
    [[0.0, 0.214, 1.0, 0.5]]
    """
    known = np.clip(colours, 0.0, 1.0)
    bright = ((known + 0.055) / 1.055) ** 2.4
    light = np.where(known <= 0.04045, known / 12.92, bright)
    return np.hstack([light[:, :3], known[:, 3:]])


def colours_of(light: Floats) -> Floats:
    """Return the sRGB values of light in [0, 1], cut to that: the inverse of ``light_of``.

    Examples
    --------
    >>> colours_of(light_of(np.array([[0.02, 0.5, 1.0]]))).round(12).tolist()
    [[0.02, 0.5, 1.0]]
    """
    known = np.clip(light, 0.0, 1.0)
    bright = 1.055 * known ** (1 / 2.4) - 0.055
    colours = np.where(known <= 0.04045 / 12.92, 12.92 * known, bright)
    return np.hstack([colours[:, :3], known[:, 3:]])
