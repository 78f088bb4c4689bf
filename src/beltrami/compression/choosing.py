"""Which way to write positions, and on which grid: the fewest bytes that keep the bound."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._progress import Progress
from beltrami.compression.container import GRID, SPECTRUM, Section
from beltrami.compression.geometry import encode_freely, encode_positions
from beltrami.compression.grid import PositionGrid, grid_for
from beltrami.compression.numbers import surroundings
from beltrami.compression.spectral import encode_spectrum

MODES = ("auto", "grid", "smooth", "spectral")
# Bytes for each vertex in the modes before, above which the others were never seen to win.
_OTHERS = (("smooth", 1.0), ("spectral", 0.6))
_TRIES = 2  # of steps, until the error is near the bound
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
    best = _encode(x, faces, wish, "grid", progress)
    for mode, coarse in _OTHERS if wish.max_error is not None else ():
        if len(best.payload) < coarse * len(x):
            other = _encode(x, faces, wish, mode, progress)
            best = min(best, other, key=lambda section: len(section.payload))
    return best


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
    if mode == "smooth":
        return Section(GRID, _encode_smooth(x, faces, wish, progress))
    return Section(GRID, encode_positions(x, faces, grid_for(x, error, bits), effort, progress))


def _encode_smooth(x: Floats, faces: Integers, wish: Wish, progress: Progress | None) -> bytes:
    """Write positions freely, at a step for which the error is near the bound and below it."""
    near, error = surroundings(faces, len(x)), wish.max_error
    if error is None:
        return encode_freely(x, near, grid_for(x, None, wish.bits), wish.effort, progress)[0]
    found: list[bytes] = []
    factor = 0.95
    for _ in range(_TRIES):
        grid = _stepping(x, error, factor)
        data, worst = encode_freely(x, near, grid, wish.effort, progress)
        if worst <= error:
            found.append(data)
        if 0.9 * error <= worst <= error or worst == 0:
            break
        factor *= 0.97 * error / worst
    if not found:
        grid = _stepping(x, error, 0.9 / (1.1 * float(np.sqrt(x.shape[1]))))
        found.append(encode_freely(x, near, grid, wish.effort, progress)[0])
    return min(found, key=len)


def _stepping(x: Floats, max_error: float, factor: float) -> PositionGrid:
    """Return a grid with the step ``factor`` times the bound."""
    grid = grid_for(x, max_error, None)
    step = max_error * min(factor, 4.0)
    if grid.is_short:  # its numbers are float32, which ends at 3e38
        step = float(np.float32(min(step, float(np.finfo(np.float32).max))))
    return PositionGrid(grid.origin, step)


def _steps(x: Floats, max_error: float | None, bits: int | None) -> list[PositionGrid]:
    """Return the steps of coefficients to try, from one origin."""
    if max_error is None:
        return [grid_for(x, None, bits)]
    return [_stepping(x, max_error, factor) for factor in _FACTORS]
