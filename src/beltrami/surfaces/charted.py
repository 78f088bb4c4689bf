"""Charted: what curves and meshes ask of a chart."""

from __future__ import annotations

from typing import Protocol

from numpy.typing import ArrayLike

from beltrami._arrays import Floats
from beltrami.surfaces.domain import Disk, Rectangle


class Charted(Protocol):
    """Points φ(u, v) over a domain, and lengths there; ``Chart`` is one."""

    domain: Rectangle | Disk

    @property
    def dimension(self) -> int:
        """Number k of coordinates of a point."""
        ...

    @property
    def size(self) -> float:
        """Extent of the surface."""
        ...

    def __call__(self, u: ArrayLike, v: ArrayLike) -> Floats:
        """(..., k) points φ(u, v)."""
        ...

    def first_fundamental_form(self, u: ArrayLike, v: ArrayLike) -> Floats:
        """(..., 2, 2) the metric I."""
        ...
