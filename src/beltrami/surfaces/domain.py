"""Domains of parameters: rectangles, whose sides may be one seam, and disks."""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Real
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Booleans, Floats, as_floats
from beltrami._kinds import checked
from beltrami.errors import SurfaceError, shown

_TRUTH = (bool, np.bool_)
_SLACK = 1e-9  # of the extent: parameters that rounding has put outside are inside


class ParameterDomain(Protocol):
    """What a surface asks of the set D of its parameters (definition 1)."""

    @property
    def extent(self) -> Floats:
        """(2,) lengths of D along u and v."""
        ...

    def contains(self, u: Floats, v: Floats) -> Booleans:
        """Whether each (u, v) is in D."""
        ...

    def nearest(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Return parameters in D: of periodic ones the same point, of others the nearest."""
        ...

    def samples(self, n: int) -> tuple[Floats, Floats]:
        """Return n parameters spread evenly inside D, none of them special."""
        ...


@dataclass(frozen=True)
class Rectangle:
    """The rectangle of u0 <= u <= u1 and v0 <= v <= v1.

    Parameters
    ----------
    u, v
        The pairs (u0, u1) and (v0, v1), ascending.
    periodic
        Whether u, and whether v, goes around: any value is then allowed, and the two sides are
        one seam, where a mesh is closed.

    Raises
    ------
    SurfaceError
        If an interval is empty or not finite, or ``periodic`` not two truth values.

    Examples
    --------
    >>> Rectangle((0, 1), (0, 2), periodic=(True, False)).contains(np.array([7.0, 0]),
    ...                                                            np.array([1.0, 3]))
    array([ True, False])
    """

    u: tuple[float, float]
    v: tuple[float, float]
    periodic: tuple[bool, bool] = (False, False)

    def __str__(self) -> str:
        ends = [")" if around else "]" for around in self.periodic]
        (u0, u1), (v0, v1) = self.u, self.v
        return f"[{u0:g}, {u1:g}{ends[0]} x [{v0:g}, {v1:g}{ends[1]}"

    def __post_init__(self) -> None:
        for name, ends in (("u", self.u), ("v", self.v)):
            low, high = _two_numbers(ends, f"the interval of {name}")
            if not (math.isfinite(low) and math.isfinite(high) and low < high):
                raise SurfaceError(
                    f"the interval of {name} is ({low:g}, {high:g}) where two ascending finite "
                    "numbers are needed"
                )
        flags: Any = self.periodic
        if np.ndim(flags) != 1 or [type(flag) in _TRUTH for flag in flags] != [True, True]:
            raise SurfaceError(f"periodic is two truth values, and not {shown(flags)}")

    @property
    def extent(self) -> Floats:
        """(2,) lengths of the sides."""
        return np.array([self.u[1] - self.u[0], self.v[1] - self.v[0]], dtype=np.float64)

    def contains(self, u: Floats, v: Floats) -> Booleans:
        """Whether each (u, v) is in the rectangle; any value of a periodic parameter is."""
        u, v = _parameters(u, v)
        inside = np.ones(np.broadcast_shapes(u.shape, v.shape), dtype=bool)
        for x, (low, high), around in zip((u, v), (self.u, self.v), self.periodic, strict=True):
            slack = _SLACK * (high - low)
            inside &= around | ((x >= low - slack) & (x <= high + slack))
        return inside

    def nearest(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Bring periodic parameters into [u0, u1) and [v0, v1), others to the nearest inside."""
        u, v = _parameters(u, v)
        found = [
            low + np.mod(x - low, high - low) if around else np.clip(x, low, high)
            for x, (low, high), around in zip((u, v), (self.u, self.v), self.periodic, strict=True)
        ]
        return found[0], found[1]

    @checked
    def samples(self, n: int) -> tuple[Floats, Floats]:
        """Return n parameters spread evenly inside, none of them special."""
        a, b = _spread(n)
        return self.u[0] + a * self.extent[0], self.v[0] + b * self.extent[1]


@dataclass(frozen=True)
class Disk:
    """The disk of the (u, v) at most ``radius`` from ``center``: the D_i of section 3.1.1.

    Raises
    ------
    SurfaceError
        If the radius is not positive and finite, or the center not two finite numbers.

    Examples
    --------
    >>> Disk(2.0).contains(np.array([0.0, 2]), np.array([1.0, 1]))
    array([ True, False])
    """

    radius: float = 1.0
    center: tuple[float, float] = (0.0, 0.0)

    def __str__(self) -> str:
        at = (
            ""
            if tuple(self.center) == (0, 0)
            else f" around ({self.center[0]:g}, {self.center[1]:g})"
        )
        return f"the disk of radius {self.radius:g}{at}"

    def __post_init__(self) -> None:
        center = _two_numbers(self.center, "the center")
        if not (isinstance(self.radius, Real) and 0 < self.radius < math.inf):
            raise SurfaceError(
                f"the radius is {shown(self.radius)} where a positive number is needed"
            )
        if not all(map(math.isfinite, center)):
            raise SurfaceError(
                f"the center is {shown(self.center)} where finite numbers are needed"
            )

    @property
    def extent(self) -> Floats:
        """(2,) the diameter, twice."""
        return np.full(2, 2.0 * self.radius)

    def contains(self, u: Floats, v: Floats) -> Booleans:
        """Whether each (u, v) is in the disk."""
        u, v = _parameters(u, v)
        from_center = np.hypot(u - self.center[0], v - self.center[1])
        return np.asarray(from_center <= self.radius * (1 + _SLACK))

    def nearest(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Bring parameters outside to the circle, along its radius."""
        u, v = _parameters(u, v)
        x, y = u - self.center[0], v - self.center[1]
        shrink = self.radius / np.maximum(np.hypot(x, y), self.radius)
        return self.center[0] + shrink * x, self.center[1] + shrink * y

    @checked
    def samples(self, n: int) -> tuple[Floats, Floats]:
        """Return n parameters spread evenly inside, none of them special."""
        a, b = _spread(n)
        r = self.radius * np.sqrt(a)
        return (
            self.center[0] + r * np.cos(2 * np.pi * b),
            self.center[1] + r * np.sin(2 * np.pi * b),
        )


def _parameters(u: ArrayLike, v: ArrayLike) -> tuple[Floats, Floats]:
    """Return two arrays of numbers, whose shapes go together."""
    first, second = as_floats(u), as_floats(v)
    try:
        np.broadcast_shapes(first.shape, second.shape)
    except ValueError as cause:
        raise SurfaceError(f"parameters of the shapes {first.shape} and {second.shape}") from cause
    return first, second


def as_domain(domain: Any, periodic: tuple[bool, bool]) -> Rectangle | Disk:
    """Return a Rectangle of ((u0, u1), (v0, v1)), and a Rectangle or a Disk as it is.

    Raises
    ------
    SurfaceError
        If it is something else, or ``periodic`` is asked of what is not a pair of intervals.
    """
    if isinstance(domain, (Rectangle, Disk)):
        if np.any(periodic):
            raise SurfaceError(
                "periodic is for a domain given as two intervals",
                remedy="Give Rectangle(u, v, periodic=...); in a disk nothing is periodic.",
            )
        return domain
    try:
        (u0, u1), (v0, v1) = domain
        intervals = (float(u0), float(u1)), (float(v0), float(v1))
    except (TypeError, ValueError, OverflowError):
        raise SurfaceError(
            f"the domain is {shown(domain)} with periodic={shown(periodic)}",
            remedy="Give ((u0, u1), (v0, v1)) and two truth values, or a Disk.",
        ) from None
    return Rectangle(*intervals, periodic=periodic)


def _two_numbers(pair: Any, what: str) -> tuple[float, float]:
    try:
        first, second = pair
        if isinstance(first, Real) and isinstance(second, Real):
            return float(first), float(second)
    except (TypeError, ValueError, OverflowError):
        pass
    raise SurfaceError(f"{what} is {shown(pair)} where two numbers are needed")


def _spread(n: int) -> tuple[Floats, Floats]:
    """Return n points of the unit square, evenly spread (the plastic-number sequence)."""
    k = np.arange(1, n + 1)
    plastic = 1.324717957244746
    return np.mod(0.5 + k / plastic, 1), np.mod(0.5 + k / plastic**2, 1)
