"""Positions within a bound of the error, in each mode, at a step that is told in bounds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._progress import Progress
from beltrami.compression.container import GRID, SPECTRUM, Section
from beltrami.compression.descent import downhill
from beltrami.compression.geometry import encode_freely, encode_positions
from beltrami.compression.grid import PositionGrid, grid_for
from beltrami.compression.neighbourhood import Neighbourhood
from beltrami.compression.numbers import encode_numbers, encode_offsets
from beltrami.compression.spectral import analyse_all


@dataclass(frozen=True, eq=False)
class Bounded:
    """Positions that are to be written within a bound.

    Parameters
    ----------
    x
        (n, d) the positions.
    near
        What is around each vertex.
    max_error
        The bound.
    effort, terms
        Those of ``compress``.
    """

    x: Floats
    near: Neighbourhood
    max_error: float
    effort: str
    terms: int | None

    def on_grid(self, progress: Progress | None = None) -> Section:
        """Write the nearest points of a grid: half the diagonal of a cell is the bound."""
        grid = grid_for(self.x, self.max_error, None)
        return Section(GRID, encode_positions(self.x, self.near, grid, self.effort, progress))

    def smooth(self, progress: Progress | None = None) -> Section:
        """Write what is left of predictions, on the same grid.

        Of the smoothings, which all take the same bytes, one is taken that keeps the bound.
        """
        grid = grid_for(self.x, self.max_error, None)
        payload = encode_freely(self.x, self.near, grid, self.effort, True, progress)
        return Section(GRID, payload)

    def size_on_grid(self, order: Integers) -> int:
        """Return the bytes of these vertices on the grid, coded in this order."""
        numbers = grid_for(self.x, self.max_error, None).round(self.x)
        return len(encode_numbers(numbers, self.near, self.effort, order=order))

    def size_smooth(self, order: Integers) -> int:
        """Return the bytes of what is left of predictions of these vertices."""
        grid = grid_for(self.x, self.max_error, None)
        exact = (self.x - grid.origin) / grid.step
        return len(encode_offsets(exact, self.near, self.effort, True, order=order)[0])

    def spectral(
        self,
        factors: Sequence[float],
        start: int = 0,
        choice: int | None = None,
        progress: Progress | None = None,
    ) -> tuple[Section, float, int]:
        """Write coefficients, and correct what is too far: (section, factor, smoothing).

        At the step, in bounds of the error, that takes the fewest bytes of ``factors`` as far as
        one comes from the one at ``start`` downhill; all of them take one basis. Without a
        ``choice`` of smoothing the best one is looked for.
        """
        grids = [self._stepping(factor) for factor in factors]
        found = analyse_all(
            self.x, self.near, grids, self.effort, self.terms, self.max_error, progress
        )
        written: list[tuple[int, bytes, int]] = []

        def size(i: int) -> int:
            last = written[-1][2] if written else None
            smoothing = found.best_choice(i, last) if choice is None else choice
            written.append((i, found.written(i, smoothing), smoothing))
            return len(written[-1][1])

        best = downhill(size, len(factors), start)
        payload, smoothing = next(one[1:] for one in written if one[0] == best)
        return Section(SPECTRUM, payload), factors[best], smoothing

    def _stepping(self, factor: float) -> PositionGrid:
        """Return a grid with the step ``factor`` times the bound, or hardly below."""
        grid = grid_for(self.x, self.max_error, None)
        step = min(self.max_error * factor, float(np.finfo(np.float64).max))
        if not grid.is_short:
            return PositionGrid(grid.origin, step)
        short = np.float32(min(step, float(np.finfo(np.float32).max)))
        if short > step:
            short = np.nextafter(short, np.float32(0))
        return PositionGrid(grid.origin, float(short))
