"""Charts that tests of several rooms share: spheres in four ways, and others."""

import numpy as np

from beltrami.surfaces.domain import Disk, Rectangle
from beltrami.surfaces.surface import ParametricSurface

TURN = (0, 2 * np.pi)


def sphere():
    """u around, v from the north pole down: the normal ∂u x ∂v is inward."""
    return ParametricSurface(
        lambda u, v: (np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)),
        (TURN, (0, np.pi)),
        periodic=(True, False),
    )


def skewed_sphere():
    """The band of the sphere in oblique coordinates: g12 is not 0, and sqrt(g) not 1."""

    def phi(u, v):
        angle, height = u + 0.7 * v + 0.2 * u * v, 0.8 * np.sin(v + 0.3 * u)
        across = np.sqrt(1 - height**2)
        return across * np.cos(angle), across * np.sin(angle), height

    return ParametricSurface(phi, ((-0.6, 0.8), (-0.7, 0.5)))


def stereographic(side=1, radius=1.5):
    """The sphere without a pole, conformally on a disk; the two sides agree on the orientation."""

    def phi(u, v):
        s = 1 + u**2 + v**2
        return 2 * u / s, 2 * side * v / s, side * (2 / s - 1)

    return ParametricSurface(phi, Disk(radius))


def torus(major=2.0, minor=0.7):
    def phi(u, v):
        across = major + minor * np.cos(v)
        return across * np.cos(u), across * np.sin(u), minor * np.sin(v)

    return ParametricSurface(phi, (TURN, TURN), periodic=(True, True))


def cylinder(radius=2.0):
    return ParametricSurface(
        lambda u, v: (radius * np.cos(u), radius * np.sin(u), v),
        (TURN, (0, 3)),
        periodic=(True, False),
    )


def polar_plane():
    return ParametricSurface(
        lambda r, t: (r * np.cos(t), r * np.sin(t)),
        Rectangle((0, 3), TURN, periodic=(False, True)),
    )


def mobius():
    def phi(u, v):
        across = 1 + v * np.cos(u / 2)
        return across * np.cos(u), across * np.sin(u), v * np.sin(u / 2)

    return ParametricSurface(phi, (TURN, (-0.3, 0.3)), periodic=(True, False))


def klein():
    """Klein's bottle without self-intersection, in R⁴."""

    def phi(u, v):
        across = 3 + np.cos(v)
        return (
            across * np.cos(u),
            across * np.sin(u),
            np.sin(v) * np.cos(u / 2),
            np.sin(v) * np.sin(u / 2),
        )

    return ParametricSurface(phi, (TURN, (-np.pi, np.pi)), periodic=(True, True))


def inside(surface, n=40):
    """Parameters away from the sides and poles."""
    u, v = surface.domain.samples(n)
    if isinstance(surface.domain, Disk):
        return u, v
    low = np.array([surface.domain.u[0], surface.domain.v[0]])[:, None]
    uv = np.stack([u, v])
    middle = low + surface.domain.extent[:, None] / 2
    return tuple(middle + 0.9 * (uv - middle))
