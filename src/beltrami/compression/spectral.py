"""Positions as coefficients of a basis that both sides make of the faces (section 3.3.6)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._progress import Progress
from beltrami.compression.block_basis import BlockBasis
from beltrami.compression.blocks import Blocks, cut_into_blocks
from beltrami.compression.coefficients import code_coefficients, new_memory
from beltrami.compression.corrections import corrections_for, encode_corrections
from beltrami.compression.grid import PositionGrid
from beltrami.compression.neighbourhood import Neighbourhood
from beltrami.compression.range_coder import POSITION, finished, new_encoder
from beltrami.compression.smoothing import best_choice, choice_near, smoothed
from beltrami.compression.spectral_head import MOST_IN_A_BLOCK, SpectralHead
from beltrami.compression.transform import DEAD_ZONE, add_up, analyse, length_of, rounded
from beltrami.compression.varint import to_varints

_MORE = 32  # eigenvectors that are made of a block beyond those that are expected


@dataclass
class Rounding:
    """Coefficients rounded to one step, and what they add up to.

    Parameters
    ----------
    grid
        Of the step; its origin is taken away first.
    numbers
        (n, d), block after block.
    x
        (n, d) the positions that they add up to, in steps from the origin.
    basis
        Knows the hash of the vectors that were needed.
    """

    grid: PositionGrid
    numbers: Integers
    x: Floats
    basis: BlockBasis


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Positions as coefficients, rounded to each of several steps.

    Parameters
    ----------
    x, near, effort, max_error
        Those of ``analyse_all``.
    blocks
        Of vertices.
    roundings
        One for each step.
    """

    x: Floats
    near: Neighbourhood
    effort: str
    max_error: float | None
    blocks: Blocks
    roundings: list[Rounding]

    def best_choice(self, i: int, start: int | None = None) -> int:
        """Return the smoothing that suits step i best; from ``start`` downhill, or of all."""
        one = self.roundings[i]
        exact = (self.x - one.grid.origin) / one.grid.step
        if start is None:
            return best_choice(exact, one.x, self.near)
        return choice_near(exact, one.x, self.near, start)

    def written(self, i: int, choice: int) -> bytes:
        """Write what is rounded to step i, smoothed, and corrected where that is needed.

        Chapter items: P60, P66, P67, P68.
        """
        return _written(self, self.roundings[i], choice)


def analyse_all(
    x: Floats,
    near: Neighbourhood,
    grids: Sequence[PositionGrid],
    effort: str,
    terms: int | None = None,
    max_error: float | None = None,
    progress: Progress | None = None,
) -> Spectrum:
    """Find the coefficients of positions (n, d), and round them to each step, of one origin.

    With ``max_error`` vertices that are farther off will be corrected, and high frequencies are
    left out where those before them are small.
    """
    blocks = cut_into_blocks(near, len(x), MOST_IN_A_BLOCK[effort])
    most = MOST_IN_A_BLOCK[effort] if terms is None else terms
    frugal = max_error is not None
    roundings = _roundings(x, grids, blocks, near, most, frugal, progress)
    return Spectrum(x, near, effort, max_error, blocks, roundings)


def encode_spectrum(
    x: Floats,
    near: Neighbourhood,
    grid: PositionGrid,
    effort: str,
    terms: int | None = None,
    progress: Progress | None = None,
) -> bytes:
    """Write positions (n, d).

    Chapter items: P60, P66, P67, P68.
    """
    found = analyse_all(x, near, [grid], effort, terms, None, progress)
    return found.written(0, found.best_choice(0))


def _roundings(
    x: Floats,
    grids: Sequence[PositionGrid],
    blocks: Blocks,
    near: Neighbourhood,
    most: int,
    frugal: bool,
    progress: Progress | None,
) -> list[Rounding]:
    """Round the coefficients to each step, and add them up; each basis is made once."""
    n, d = x.shape
    found = [
        Rounding(grid, np.zeros((n, d), np.int64), np.zeros((n, d)), BlockBasis(near))
        for grid in grids
    ]
    least = DEAD_ZONE * min(grid.step for grid in grids)
    local = x - grids[0].origin
    basis, enough = BlockBasis(near), _MORE if frugal else most
    for first, last in blocks.each(progress):
        vertices = blocks.vertices[first:last]
        U, c = analyse(local, vertices, basis, least, most, enough)
        enough = len(c) * 4 // 3 + _MORE if frugal else most
        for one in found:
            numbers = rounded(c / one.grid.step)
            one.numbers[first : first + len(c)] = numbers
            sum_up(U[:, : length_of(numbers)], numbers, vertices, one.x, one.basis)
    return found


def sum_up(U: Floats, numbers: Integers, vertices: Integers, x: Floats, basis: BlockBasis) -> None:
    """Write what the coefficients add up to, and let the hash depend on the vectors."""
    vectors = np.ascontiguousarray(U)
    basis.note(vectors)
    add_up(vectors, numbers.astype(np.float64), vertices, x)


def _written(spectrum: Spectrum, rounding: Rounding, choice: int) -> bytes:
    """Write one rounding."""
    x, near, max_error = spectrum.x, spectrum.near, spectrum.max_error
    d = x.shape[1]
    grid, numbers = rounding.grid, rounding.numbers
    found = grid.points(smoothed(rounding.x, near, choice))
    vertices, offsets, step = np.zeros(0, np.int64), np.zeros((0, d), np.int64), 0.0
    if max_error is not None:
        vertices, offsets, step = corrections_for(x, found, max_error)
        found[vertices] += step * offsets
    lengths = np.array([length_of(numbers[a:b]) for a, b in spectrum.blocks.each()], np.int64)
    terms = int(lengths.max(initial=0))
    bound = float(np.sqrt(((found - x) ** 2).sum(axis=1)).max(initial=0.0)) * (1 + 2.0**-40)
    digest = rounding.basis.digest()
    head = SpectralHead(grid, spectrum.effort, choice, bound, terms, len(vertices), step, digest)
    coded = _coded(numbers, spectrum.blocks, lengths, terms)
    data = head.to_bytes() + to_varints([len(coded)]) + coded
    return data + encode_corrections(vertices, offsets)


def _coded(numbers: Integers, blocks: Blocks, lengths: Integers, terms: int) -> bytes:
    """Code the numbers, frequency after frequency."""
    size, k = 4 * numbers.size + 1024, len(lengths)
    while True:
        state, buffer = new_encoder(), np.zeros(size, np.uint8)
        memory, known = new_memory(k, numbers.shape[1]), np.zeros(k, np.int64)
        code_coefficients(
            numbers.copy(), blocks.starts, lengths, terms, 0, memory, state, buffer, known
        )
        data = finished(state, buffer)
        if data is not None:
            return data
        size = int(state[POSITION]) + 1024
