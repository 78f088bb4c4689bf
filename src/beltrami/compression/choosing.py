"""Which way to write positions, and at which step: the fewest bytes that keep the bound.

Steps and modes are tried on a sample; then all vertices are written once.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._progress import Progress
from beltrami.compression.bounded import Bounded
from beltrami.compression.container import GRID, SPECTRUM, Section
from beltrami.compression.geometry import encode_freely, encode_positions
from beltrami.compression.grid import grid_for
from beltrami.compression.neighbourhood import Neighbourhood
from beltrami.compression.numbers import surroundings
from beltrami.compression.sampling import order_of_sample, part_of, sample_of
from beltrami.compression.spectral import encode_spectrum

MODES = ("auto", "grid", "smooth", "spectral")
LEAST = 2000  # vertices of a sample; of a mesh of twice as many all are tried
_SHARE = 20  # of larger ones: one vertex of so many is tried
_FINE = 1.5  # bytes for each vertex on the grid, above which other modes were never seen to win
_FACTORS = (1.3, 1.8, 2.5, 3.4, 4.6, 6.2)  # steps of coefficients to try, in bounds of the error
_START = 2  # the one to begin with
_FAR = 1e6  # times the size of the mesh: bounds beyond it say no more, and steps stay finite
_LARGER = 1.35  # times the step that suits the sample: what corrections cost it has yet to learn


@dataclass(frozen=True)
class Wish:
    """What the positions should become; the parameters of ``compress``."""

    max_error: float | None
    bits: int | None
    mode: str
    effort: str
    terms: int | None


def encode_wish(x: Floats, faces: Integers, wish: Wish, progress: Progress | None) -> Section:
    """Write positions (n, d) as it is wished for; with the mode "auto" in the shortest way.

    O(n), of which trying is about a twentieth of all modes together.
    """
    n, near = len(x), surroundings(faces, len(x))
    if wish.max_error is None:
        return _encode_bits(x, near, wish, progress)
    reach = _FAR * float(np.ptp(x, axis=0).max(initial=0.0)) if n else 0.0
    bound = min(wish.max_error, reach) if reach > 0 else wish.max_error
    whole = Bounded(x, near, bound, wish.effort, wish.terms)
    if wish.mode == "grid":
        return whole.on_grid(progress)
    if wish.mode == "smooth":
        return whole.smooth(progress)
    if n <= 2 * LEAST:
        return _shortest(whole, wish.mode, progress)
    return _likely_shortest(whole, faces, wish.mode, progress)


def _shortest(whole: Bounded, mode: str, progress: Progress | None) -> Section:
    """Write all of a small mesh in all modes, or in "spectral" alone; return the fewest bytes."""
    found = []
    if mode == "auto":
        found.append(whole.on_grid(progress))
        if _size(found[0]) > _FINE * len(whole.x):
            return found[0]
        found.append(whole.smooth(progress))
    found.append(whole.spectral(_FACTORS, _START, None, progress)[0])
    return min(found, key=_size)


def _likely_shortest(
    whole: Bounded, faces: Integers, mode: str, progress: Progress | None
) -> Section:
    """Write a large mesh in the way that takes the fewest bytes for a sample of its vertices."""
    n, least, wins = len(whole.x), float("inf"), "spectral"
    size = max(LEAST, n // _SHARE)
    if mode == "auto":
        order = order_of_sample(whole.near, size)
        least, wins = whole.size_on_grid(order) / len(order), "grid"
        if least > _FINE:
            return whole.on_grid(progress)
        smooth = whole.size_smooth(order) / len(order)
        least, wins = min((least, wins), (smooth, "smooth"))
    sample = sample_of(whole.near, size)
    around = surroundings(part_of(faces, n, sample), len(sample))
    part = replace(whole, x=whole.x[sample], near=around)
    written, factor, choice = part.spectral(_FACTORS, _START)
    if _size(written) / len(sample) < least:
        larger = (_LARGER * factor,) if factor > _FACTORS[0] else ()
        return whole.spectral((factor, *larger), 0, choice, progress)[0]
    return whole.on_grid(progress) if wins == "grid" else whole.smooth(progress)


def _size(section: Section) -> int:
    return len(section.payload)


def _encode_bits(x: Floats, near: Neighbourhood, wish: Wish, progress: Progress | None) -> Section:
    """Write positions with a grid of so many bits."""
    grid, effort = grid_for(x, None, wish.bits), wish.effort
    if wish.mode == "spectral":
        return Section(SPECTRUM, encode_spectrum(x, near, grid, effort, wish.terms, progress))
    if wish.mode == "smooth":
        return Section(GRID, encode_freely(x, near, grid, effort, progress=progress))
    return Section(GRID, encode_positions(x, near, grid, effort, progress))
