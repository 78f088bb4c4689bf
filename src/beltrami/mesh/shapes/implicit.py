"""An implicit surface: balls melted together, symmetric about the plane y = 0."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from beltrami._arrays import Floats
from beltrami._jit import kernel

COLUMNS = 9  # centre (3), radius, flat direction (3), flatness, keel
NEGLIGIBLE = 30.0  # exp(-30) = 1e-13 changes nothing that can be seen


class Skin(NamedTuple):
    """The zero set of f(p) = -(1/s) log sum_i exp(-s d_i(x, |y|, z)).

    Attributes
    ----------
    balls : (c, 9) float
        One row for each ball: its centre; its radius; a unit direction along which space is
        stretched first, and by how much (the ball becomes flatter by that factor); the keel k:
        |y| + k replaces |y|, so that the ball becomes a lens, two caps that meet at a sharp
        edge on the plane of symmetry.
    sharpness : float
        s: the larger, the narrower the fillets, which are about 1/s wide. Balls of radius r melt
        to a tube without bumps where they are closer than about 1.7 sqrt(r / s).
    """

    balls: Floats
    sharpness: float


def field(points: Floats, skin: Skin) -> tuple[Floats, Floats]:
    """Return f (n,) and its gradient (n, 3); on the plane y = 0 the gradient within the plane.

    Examples
    --------
    >>> import numpy as np
    >>> ball = np.array([[0, 0, 0, 0.5, 0, 0, 1, 1, 0]], dtype=float)
    >>> f, gradient = field(np.array([[0.0, 2.0, 0.0]]), Skin(ball, 20.0))
    >>> f.tolist(), gradient.tolist()
    ([1.5], [[0.0, 1.0, 0.0]])
    """
    points = np.ascontiguousarray(points)
    values = np.empty(len(points))
    gradients = np.empty_like(points)
    _field(points, skin.balls, skin.sharpness, values, gradients)
    return values, gradients


def project(points: Floats, skin: Skin, steps: int, level: float = 0.0) -> Floats:
    """Move points to {f = level} by Newton steps p - (f - level) g / |g|^2.

    Points on the plane y = 0 stay on it, and the mirror images of points stay mirror images.
    """
    moved = np.ascontiguousarray(points).copy()
    _project(moved, skin.balls, skin.sharpness, steps, level)
    return moved


@kernel
def _project(points: Any, balls: Any, sharpness: float, steps: int, level: float) -> None:
    value = np.empty(1)
    gradient = np.empty((1, 3))
    for i in range(points.shape[0]):
        for _ in range(steps):
            _field(points[i : i + 1], balls, sharpness, value, gradient)
            g = gradient[0]
            step = (value[0] - level) / (g[0] * g[0] + g[1] * g[1] + g[2] * g[2] + 1e-12)
            points[i, 0] -= step * g[0]
            points[i, 1] -= step * g[1]
            points[i, 2] -= step * g[2]


@kernel
def _field(points: Any, balls: Any, sharpness: float, values: Any, gradients: Any) -> None:
    """Sum the exponentials relative to the least distance so far, so that nothing overflows."""
    for i in range(points.shape[0]):
        total, gx, gy, gz = 0.0, 0.0, 0.0, 0.0
        least = np.inf
        for b in range(balls.shape[0]):
            nx, ny, nz, stretch = balls[b, 4], balls[b, 5], balls[b, 6], balls[b, 7] - 1.0
            x = points[i, 0] - balls[b, 0]
            y = abs(points[i, 1]) + balls[b, 8] - balls[b, 1]
            z = points[i, 2] - balls[b, 2]
            along = stretch * (x * nx + y * ny + z * nz)
            x, y, z = x + along * nx, y + along * ny, z + along * nz
            distance = math.sqrt(x * x + y * y + z * z)
            d = distance - balls[b, 3]
            excess = sharpness * (d - least)
            if excess > NEGLIGIBLE:
                continue
            if excess < 0.0:
                shrink = math.exp(excess)
                total, gx, gy, gz = total * shrink, gx * shrink, gy * shrink, gz * shrink
                least = d
                excess = 0.0
            w = math.exp(-excess)
            along = stretch * (x * nx + y * ny + z * nz)
            unit = w / max(distance, 1e-12)
            total += w
            gx += unit * (x + along * nx)
            gy += unit * (y + along * ny)
            gz += unit * (z + along * nz)
        values[i] = least - math.log(total) / sharpness
        side = 1.0 if points[i, 1] > 0.0 else (-1.0 if points[i, 1] < 0.0 else 0.0)
        gradients[i, 0] = gx / total
        gradients[i, 1] = side * gy / total
        gradients[i, 2] = gz / total
