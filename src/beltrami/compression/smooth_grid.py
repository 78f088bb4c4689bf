"""The grid and the smoothing for the mode "smooth"."""

from __future__ import annotations

from beltrami._arrays import Floats, Integers
from beltrami.compression.geometry import largest_error
from beltrami.compression.grid import PositionGrid, grid_for
from beltrami.compression.numbers import surroundings
from beltrami.compression.smoothing import best_choice

_TRIES = (1.0, 0.9, 0.8, 0.7, 0.6)  # of the coarsest grid that the bound could allow


def smooth_grid(
    x: Floats, faces: Integers, max_error: float | None, bits: int | None
) -> tuple[PositionGrid, int]:
    """Return the grid, and the choice of smoothing with the least mean square error.

    For a bound the grid is refined until the smoothed positions keep it; at half the step of the
    plain grid every smoothing does.
    """
    near = surroundings(faces, len(x))
    if max_error is None:
        grid = grid_for(x, None, bits)
        return grid, best_choice((x - grid.origin) / grid.step, grid.round(x), near)
    for factor in _TRIES:
        grid = grid_for(x, max_error * factor, None)
        choice = best_choice((x - grid.origin) / grid.step, grid.round(x), near)
        if largest_error(x, grid, near, choice) <= max_error:
            return grid, choice
    grid = grid_for(x, max_error / 2, None)
    return grid, best_choice((x - grid.origin) / grid.step, grid.round(x), near)
