"""The anatomy of the blob: a swimming creature, as balls strung on curved spines, and its pose."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, read_only
from beltrami.mesh.shapes.implicit import COLUMNS, Skin

SHARPNESS = 24.0  # at rest: fillets of about 0.04
SPACING = 1.7  # of the balls along a spine, in units of sqrt(size / sharpness): no bumps
LOWER = (-3.3, 0.0, -1.1)  # a box around the creature at rest, with room to fatten it
UPPER = (2.8, 2.2, 2.0)
SIZE = 0.4  # of the posed creature: some two units long

# Spines at rest, x to the head, z up, y >= 0 only (the other half is the mirror image): knots
# (x, y, z, radius), and for blades, which lie in the plane y = 0, (x, z, half height, half width).
TRUNK = ((-0.95, 0, 0.07, 0.18), (-0.5, 0, 0.03, 0.33), (0.05, 0, 0.0, 0.40),
         (0.5, 0, 0.05, 0.33), (0.85, 0, 0.20, 0.20))  # fmt: skip
NECK = ((0.8, 0, 0.16, 0.21), (1.13, 0, 0.42, 0.125), (1.34, 0, 0.84, 0.088),
        (1.50, 0, 1.28, 0.08), (1.80, 0, 1.52, 0.095))  # fmt: skip
HEAD = ((1.84, 0, 1.52, 0.115), (2.0, 0, 1.48, 0.13), (2.2, 0, 1.37, 0.095),
        (2.40, 0, 1.28, 0.065))  # fmt: skip
EYE = ((2.03, 0.118, 1.555, 0.055), (2.055, 0.118, 1.548, 0.055))
TAIL = ((-0.9, 0, 0.07, 0.19), (-1.3, 0, 0.09, 0.12), (-1.75, 0, 0.18, 0.08),
        (-2.2, 0, 0.42, 0.055), (-2.5, 0, 0.72, 0.035))  # fmt: skip
FORE_LIMB = ((0.52, 0.20, -0.06, 0.16), (0.60, 0.55, -0.20, 0.17), (0.52, 0.95, -0.38, 0.215),
             (0.22, 1.38, -0.50, 0.185), (-0.25, 1.74, -0.50, 0.085))  # fmt: skip
HIND_LIMB = ((-0.62, 0.18, -0.05, 0.13), (-0.74, 0.46, -0.17, 0.135), (-1.00, 0.78, -0.29, 0.165),
             (-1.48, 1.08, -0.33, 0.08))  # fmt: skip
CREST = ((1.0, 0.40, 0.08, 0.05), (0.62, 0.44, 0.20, 0.075), (0.1, 0.50, 0.29, 0.09),
         (-0.4, 0.38, 0.24, 0.08), (-0.9, 0.22, 0.16, 0.065), (-1.5, 0.17, 0.12, 0.05),
         (-1.95, 0.30, 0.15, 0.05), (-2.32, 0.55, 0.27, 0.055), (-2.62, 0.92, 0.20, 0.045),
         (-2.80, 1.22, 0.08, 0.035))  # fmt: skip


@cache
def skin() -> Skin:
    """Return the implicit surface of the creature at rest."""
    paddle = (0.1, 0.35, 0.93)  # the direction in which the limbs are flat
    balls = [
        _limb(TRUNK, flatness=1.15),
        _limb(NECK),
        _limb(HEAD),
        _limb(EYE),
        _limb(TAIL),
        _limb(FORE_LIMB, paddle, 2.2),
        _limb(HIND_LIMB, paddle, 2.0),
        _blade(CREST),
    ]
    return Skin(read_only(np.concatenate(balls)), SHARPNESS)


def _limb(
    spine: ArrayLike, flat: tuple[float, float, float] = (0, 0, 1), flatness: float = 1.0
) -> Floats:
    """Put balls on a spine; flat and flatness as in ``Skin``."""
    knots = np.asarray(spine, dtype=np.float64)
    centres, radii = _string(knots[:, :3], knots[:, 3:], knots[:, 3])
    balls = np.zeros((len(centres), COLUMNS))
    balls[:, :3], balls[:, 3] = centres, radii[:, 0]
    balls[:, 4:7] = np.asarray(flat) / np.linalg.norm(flat)
    balls[:, 7] = flatness
    return balls


def _blade(spine: ArrayLike) -> Floats:
    """Put lenses with a sharp rim on a curve in the plane y = 0.

    A lens of half height H and half width W lies between two spheres of the radius
    (H^2 + W^2) / (2 W), whose centres are that radius less W beyond the plane.
    """
    knots = np.asarray(spine, dtype=np.float64)
    height, width = knots[:, 2], knots[:, 3]
    radius = (height**2 + width**2) / (2 * width)
    profile = np.stack([radius, radius - width], axis=1)
    centres, profile = _string(np.insert(knots[:, :2], 1, 0.0, axis=1), profile, height)
    balls = np.zeros((len(centres), COLUMNS))
    balls[:, :3], balls[:, 3], balls[:, 8] = centres, profile[:, 0], profile[:, 1]
    balls[:, 6:8] = 1.0
    return balls


def _string(centres: Floats, profile: Floats, size: Floats) -> tuple[Floats, Floats]:
    """Sample the smooth curve through the knots, densely where the size is small."""
    from scipy.interpolate import PchipInterpolator, make_interp_spline  # slow to load

    steps = np.linalg.norm(np.diff(centres, axis=0), axis=1)
    at = np.concatenate([[0.0], np.cumsum(steps)])
    fine = np.linspace(0.0, at[-1], 1001)
    density = np.sqrt(SHARPNESS / PchipInterpolator(at, size)(fine)) / SPACING
    number = np.concatenate([[0.0], np.cumsum((density[1:] + density[:-1]) / 2 * np.diff(fine))])
    t = np.interp(np.linspace(0.0, number[-1], int(np.ceil(number[-1])) + 1), number, fine)
    curve = make_interp_spline(at, centres, k=min(3, len(at) - 1))
    return curve(t), PchipInterpolator(at, profile)(t)


def pose(points: Floats) -> Floats:
    """Bend the creature from rest: the neck to its left, the tail to its right, a little twist.

    The curve (x, g(x)) replaces the x axis and sections stay perpendicular to it. g has two
    continuous derivatives, so that a smooth surface stays smooth.
    """
    x, y, z = points.T
    twist = 0.10 * x
    y, z = np.cos(twist) * y - np.sin(twist) * z, np.sin(twist) * y + np.cos(twist) * z
    ahead, behind = np.maximum(x - 0.5, 0.0), np.maximum(-0.6 - x, 0.0)
    g = 0.16 * ahead**3 - 0.11 * behind**3
    slope = 0.48 * ahead**2 + 0.33 * behind**2
    unit = np.sqrt(1 + slope * slope)
    return SIZE * np.stack([x - y * slope / unit, g + y / unit, z], axis=1)
