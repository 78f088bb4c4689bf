"""Which way to write positions, and on which grid: the fewest bytes that keep the bound."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._progress import Progress
from beltrami.compression.container import GRID, SPECTRUM, Section
from beltrami.compression.geometry import encode_positions
from beltrami.compression.grid import PositionGrid, grid_for
from beltrami.compression.smooth_grid import smooth_grid
from beltrami.compression.spectral import encode_spectrum

MODES = ("auto", "grid", "smooth", "spectral")
_COARSE = 1  # bytes for each vertex on the grid: with more the other modes do not win
_FACTORS = (0.6, 0.9, 1.3, 1.9)  # steps of coefficients to try, in bounds of the error


@dataclass(frozen=True)
class Wish:
    """What the positions should become; the parameters of ``compress``."""

    max_error: float | None
    bits: int | None
    mode: str
    effort: str
    terms: int | None


def encode_wish(x: Floats, faces: Integers, wish: Wish, progress: Progress | None) -> Section:
    """Write positions (n, d) as it is wished for; with the mode "auto" in the shortest way."""
    if wish.mode != "auto":
        return _encode(x, faces, wish, wish.mode, progress)
    found = [_encode(x, faces, wish, "grid", progress)]
    if wish.max_error is not None and len(found[0].payload) < _COARSE * len(x):
        found += [_encode(x, faces, wish, mode, progress) for mode in ("smooth", "spectral")]
    return min(found, key=lambda section: len(section.payload))


def _encode(
    x: Floats, faces: Integers, wish: Wish, mode: str, progress: Progress | None
) -> Section:
    """Write positions in one way."""
    error, bits, effort = wish.max_error, wish.bits, wish.effort
    if mode == "spectral":
        payload = encode_spectrum(
            x, faces, _steps(x, error, bits), effort, wish.terms, error, progress
        )
        return Section(SPECTRUM, payload)
    grid, choice = grid_for(x, error, bits), 0
    if mode == "smooth":
        grid, choice = smooth_grid(x, faces, error, bits)
    return Section(GRID, encode_positions(x, faces, grid, effort, choice, progress))


def _steps(x: Floats, max_error: float | None, bits: int | None) -> list[PositionGrid]:
    """Return the steps of coefficients to try, from one origin."""
    grid = grid_for(x, max_error, bits)
    if max_error is None:
        return [grid]
    steps = np.array([max_error * factor for factor in _FACTORS])
    if grid.is_short:
        steps = steps.astype(np.float32).astype(np.float64)
    return [PositionGrid(grid.origin, float(step)) for step in steps]
