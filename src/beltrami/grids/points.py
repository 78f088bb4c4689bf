"""Points: where the points of a grid are, and which axes are circles (section 3.2.4)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from math import prod

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, read_only
from beltrami._frozen import Frozen
from beltrami.grids.axis import Axes, make_axes
from beltrami.grids.limit import bipartite


class Points(Frozen):
    """What a ``Grid`` is, without what it makes; see there."""

    _axes: Axes

    def __init__(
        self,
        shape: int | Sequence[int],
        periodic: bool | Sequence[bool] = True,
        spacing: ArrayLike | None = None,
    ) -> None:
        self.__dict__["_axes"] = make_axes(shape, periodic, spacing)

    def __repr__(self) -> str:
        sizes = " x ".join(str(p) for p in self.shape)
        steps = " x ".join(f"{h:g}" for h in self.spacing)
        names = {True: "periodic", False: "with ends"}
        flags = {names[flag]: None for flag in self.periodic}
        how = next(iter(flags)) if len(flags) == 1 else " x ".join(names[f] for f in self.periodic)
        return f"<{type(self).__name__}: {sizes} points, {how}, spacing {steps}>"

    @property
    def shape(self) -> tuple[int, ...]:
        """Points along each axis, p₁ to p_d."""
        return tuple(axis.size for axis in self._axes)

    @property
    def periodic(self) -> tuple[bool, ...]:
        """Whether each axis is a circle."""
        return tuple(axis.periodic for axis in self._axes)

    @property
    def spacing(self) -> tuple[float, ...]:
        """Step h of each axis."""
        return tuple(axis.spacing for axis in self._axes)

    @property
    def dimension(self) -> int:
        """Number of axes d."""
        return len(self._axes)

    @property
    def n_vertices(self) -> int:
        """Number of points n."""
        return prod(self.shape)

    @cached_property
    def coordinates(self) -> Floats:
        """(n, d) positions of the points, the last axis fastest (E31).

        Chapter items: P24.
        """
        ticks = np.meshgrid(*(axis.coordinates for axis in self._axes), indexing="ij")
        return read_only(np.stack([x.ravel() for x in ticks], axis=1))

    @property
    def is_bipartite(self) -> bool:
        """Whether neighbours can be told apart by two colours: no circle has an odd number (E37).

        Chapter items: T5.
        """
        return bipartite(self._axes)
